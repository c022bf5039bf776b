#!/usr/bin/env bash
# Runs the test program of one exercise, each case in a process of its own, and says in a few lines how it went.
#
#   judge.sh PROGRAM ID LEARNER_FILE LOG            a report for people; exit code 0 only if every case passes
#   judge.sh --kinds PROGRAM ID LEARNER_FILE LOG    one line a case for prove.sh: its kind, a tab, its name
#
# Kinds: passed, skipped, wrong (a check failed), diagnosed (a sanitizer or the CUDA simulator stopped it), endless,
# no-verdict (it ended without its last line: a bare crash, or an exit).
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
kinds_only=false
if [ "$1" = --kinds ]; then
    kinds_only=true
    shift
fi
program=$1 id=$2 learner_file=$3 log=$4
time_limit_s=${COURSE_TIME_LIMIT_S:-8}  # with the build before it, a verdict is there within 10 s

# What a case does beyond its checks is for the sanitizers to say. Leaks are the simulator's business.
export ASAN_OPTIONS=handle_abort=1:handle_sigill=1:detect_leaks=0:color=never UBSAN_OPTIONS=print_stacktrace=1:color=never
export COURSE_EXERCISE=$id COURSE_TIME_LIMIT_S=$time_limit_s

simulator='^cudasim: '  # how a diagnosis of the CUDA simulator begins
# What it says when a program ends. The rest is an error of a call, which the test itself may have provoked.
left_over='^cudasim: (.* of device memory leaked|nobody asked for the error)'

run() {  # the time limit is the program's own affair (it knows the line); the outer one is for when that fails
    timeout -s KILL $((time_limit_s + 5)) "$program" "$@" </dev/null
}

# Begin and end of what a program prints (an endless loop may print without end), with paths as seen from the root.
shorten() { { head -c 200000; tail -c 100000; } | awk -v root="$root/" '{
    while (at = index($0, root)) $0 = substr($0, 1, at - 1) substr($0, at + length(root))
    print
}'; }

kind_of() {  # exit code of the case whose output is in $case_log
    local verdict
    verdict=$(grep -o 'verdict: 1 case, .*' "$case_log" | tail -n 1 || true)
    if grep -q 'time limit of .* is over' "$case_log" || [ "$1" = 137 ]; then
        echo endless
    elif [ "$1$verdict" = "1verdict: 1 case, 0 passed, 1 failed, 0 skipped" ]; then
        echo wrong
    elif [ "$1$verdict" = "77verdict: 1 case, 0 passed, 0 failed, 1 skipped" ]; then
        echo skipped
    elif [ "$1$verdict" = "0verdict: 1 case, 1 passed, 0 failed, 0 skipped" ] && ! grep -qE "$left_over" "$case_log"; then
        echo passed
    elif grep -qE "ERROR: AddressSanitizer|: runtime error: |$simulator" "$case_log"; then
        echo diagnosed
    else
        echo no-verdict
    fi
}

# The first place in the learner's file that a stack or a message names: "exercises/05_spatial_grid/ex2_x.cuh:31".
learner_line() {
    local place
    place=$(grep -oE "$(basename "$learner_file" | sed 's/[.]/[.]/g'):[0-9]+" "$case_log" | head -n 1 || true)
    if [ -n "$place" ]; then echo "${learner_file#"$root"/}:${place##*:}"; fi
}

report_wrong() {
    sed -n '/^FAILED: /,/^verdict: /p' "$case_log" | sed -e 1d -e '/verdict: /d' | cut -c 1-160 | head -n 14
    diagnosis | sed 's/^/  /' | head -n 3  # of the simulator, if the failed check is a launch that it stopped
    grep '^  right while threads' "$case_log" || true
}

# What a sanitizer or the simulator says, without addresses: "heap-buffer-overflow", "WRITE of size 4".
diagnosis() {
    grep -E "runtime error: |ERROR: AddressSanitizer: |^(READ|WRITE) of size|$simulator" "$case_log" | sed -E \
        -e '/AddressSanitizer: ABRT/d' -e 's/^.*(runtime error|ERROR: AddressSanitizer): //' -e 's/ at 0x.*| thread T[0-9]+$//' \
        -e 's/^SEGV on unknown address.*/an address that is no memory was read or written (a null pointer?)/' \
        -e 's/^ILL on unknown address.*/an instruction that cannot be carried out (__trap?)/' \
        -e 's/^stack-overflow.*/stack-overflow (a function that calls itself without end?)/' -e 's/ on (unknown )?address .*//' |
        cut -c 1-160 | head -n 6 || true
}

report_stopped() {  # what happened, and where, as far as that is known
    local place
    place=$(learner_line)
    echo "  $1${place:+ at $place}"
    diagnosis | sed 's/^/  /'
    echo "  hint: ./course hint $id"
}

report_early_end() {  # exit code
    local call
    call=$(grep -nE '\b(_?[eE]xit|quick_exit|abort|terminate)[[:space:]]*\(' "$learner_file" | head -n 1 | cut -d : -f 1 || true)
    if [ "$1" -gt 128 ]; then
        report_stopped "killed by signal $(kill -l "$1")"
    else
        report_stopped "ended with exit code $1 before its verdict${call:+; see the call at ${learner_file#"$root"/}:$call}"
    fi
}

report_case() {  # kind and exit code
    case $1 in
        wrong) report_wrong ;;
        endless) report_stopped "still running after $time_limit_s s: an endless loop" ;;
        diagnosed) report_stopped "stopped" ;;
        no-verdict) report_early_end "$2" ;;
        skipped) sed -n 's/^skipped: /  skipped: /p' "$case_log" ;;
    esac
}

case_log=$(mktemp)
trap 'rm -f "$case_log"' EXIT
mkdir -p "$(dirname "$log")"
: >"$log"

run_case() {  # NAME; sets kind, code
    local filter=${1//\\/\\\\}
    code=0
    run --test-case="${filter//,/\\,}" 2>&1 | shorten >"$case_log" || code=${PIPESTATUS[0]}
    { echo "== case: $1"; cat "$case_log"; } >>"$log"
    kind=$(kind_of "$code")
}

mapfile -t cases < <(run --list-test-cases 2>"$case_log")
[ ${#cases[@]} -gt 0 ] || cases=("(list of cases)")
n_passed=0 first_failed='' report='' also=()
for name in "${cases[@]}"; do
    run_case "$name"
    if [ "$kind" = passed ]; then  # Is it still right when threads run in another order, as they may on a GPU?
        CUDASIM_ORDER=shuffled run_case "$name"
        [ "$kind" = passed ] || echo '  right while threads run in order, wrong when they do not: do they race for something?' >>"$case_log"
    fi
    if $kinds_only; then
        printf '%s\t%s\n' "$kind" "$name"
    elif [ "$kind" = passed ]; then
        n_passed=$((n_passed + 1))
    elif [ -z "$first_failed" ]; then
        first_failed=$name
        report=$(report_case "$kind" "$code")
    else
        also+=("$name")
    fi
    [ "$kind" != endless ] || break  # the cases after it would take as long
done
$kinds_only && exit 0

if [ -z "$first_failed" ]; then
    echo "$id passed: $n_passed cases"
    exit 0
fi
echo "$id FAILED in the case \"$first_failed\" ($n_passed of ${#cases[@]} cases passed)"
echo "$report"
for name in "${also[@]:0:3}"; do echo "also failing: $name"; done
[ ${#also[@]} -le 3 ] || echo "and $((${#also[@]} - 3)) more"
echo "all output: ${log#"$root"/}"
exit 1
