#!/usr/bin/env bash
# Tests the exercise machine itself: the judge with a program that does all a learner's file can do, the generator with
# good and bad markers, and each proof with something it must reject.
#
#   machine_test.sh MISBEHAVING_PROGRAM SCRATCH_FOLDER SANITIZED(TRUE|FALSE)
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../../.." && pwd)
tools=$root/common/exercises
program=$1 scratch=$2 sanitized=$3
source_file=$here/misbehaving.cpp
n_failed=0
export COURSE_TIME_LIMIT_S=1

expect() {  # WHAT EXPECTED_PATTERN TEXT
    grep -qE -- "$2" <<<"$3" && return
    n_failed=$((n_failed + 1))
    printf 'FAILED: %s\n  expected %s\n  got      %s\n' "$1" "$2" "$3"
}

expect_failure() {  # WHAT COMMAND...
    local what=$1
    shift
    "$@" >"$scratch/output" 2>&1 || return 0
    n_failed=$((n_failed + 1))
    printf 'FAILED: %s was accepted\n' "$what"
}

mkdir -p "$scratch"

code=0
"$program" --test-case=stub >/dev/null || code=$?
if [ $code = 77 ]; then
    echo "skipped: in a GPU build, test programs need a GPU"
    exit 77
fi

# --- the judge: every kind of end is told from the others
kinds=$("$tools/judge.sh" --kinds "$program" 01.1 "$source_file" "$scratch/log")
crash=$([ "$sanitized" = TRUE ] && echo diagnosed || echo '(no-verdict|wrong|passed)')
while IFS=$'\t' read -r kind name; do
    expect "kind of '$name'" "^$kind	$name\$" "$kinds"
done <<KINDS
passed	right, with a comma
wrong	wrong
wrong	right in one order
wrong	stub
wrong	too few
wrong	checks nothing
wrong	exception
skipped	skips
$crash	null pointer
$crash	beyond the end
no-verdict	early exit
no-verdict	lying exit code
endless	endless
KINDS

# --- the report: the first failing case with its first wrong element, seed and hint, within a screen
report=$("$tools/judge.sh" "$program" 01.1 "$source_file" "$scratch/log" || true)
expect "report: case" '^01.1 FAILED in the case "wrong" \([12] of 13 cases passed\)$' "$report"
expect "report: element" 'density of particle 17: expected 1, got -?nan' "$report"
expect "report: count" '2 of 33 are wrong' "$report"
expect "report: place" 'checked at tests/exercises/machine/misbehaving.cpp:[0-9]+' "$report"
expect "report: seed" '^  seed 42$' "$report"
expect "report: hint" '^  hint: ./course hint 01.1 2$' "$report"
expect "report: at most a screen" '^([0-9]|1[0-9]|2[0-4])$' "$(wc -l <<<"$report")"

# --- the test program: a filter that matches nothing is a failure, nothing but skips is 77
expect_failure "a filter that matches nothing" "$program" --test-case=nonsense
code=0
"$program" --test-case=skips >/dev/null || code=$?
expect "exit code of a skip" '^77$' "$code"

# --- the generator
cat >"$scratch/solution.h" <<'SOLUTION'
int f() {
    // TODO(1.1): three. About 1 line.
    // <solution>
    return 3;
    // <stub>
    //| return kTodo;
    // </solution>
}
SOLUTION
make() { awk -f "$tools/make_exercise.awk" -v id=1.1 -v out="$scratch/exercise.h" "$1"; }
make "$scratch/solution.h"
expect "exercise" '^    return kTodo;$' "$(cat "$scratch/exercise.h")"
expect "exercise has four lines" '^4$' "$(wc -l <"$scratch/exercise.h")"
for marker in '<solution>' '<stub>' '</solution>' 'TODO(1.1)' '//| '; do
    grep -vF "$marker" "$scratch/solution.h" >"$scratch/bad.h"
    # Without <stub> and its line a region just vanishes, so there only the orphaned stub line is a mistake.
    [ "$marker" = '//| ' ] && echo '// <stub>' >>"$scratch/bad.h"
    expect_failure "a solution without $marker" make "$scratch/bad.h"
done

# --- the proofs reject what they are there to reject
prove=$tools/prove.sh
expect_failure "an exercise that crashes as shipped" "$prove" as-shipped "$program" 01.1 "$source_file"
expect_failure "an exercise that is not built" "$prove" as-shipped "$scratch/none" 01.1 "$source_file"
echo 'int f() { return 4; }' >"$scratch/edited.h"
expect_failure "an exercise out of step" "$prove" in-step 01.1 "$scratch/solution.h" "$scratch/edited.h" "$scratch/again.h"
expect_failure "an exercise without hints" "$prove" rules 01.1 "$root/solutions/none/ex1_none.h"
expect_failure "a chapter without exercises" "$prove" chapter 99_none

if [ $n_failed = 0 ]; then echo "the exercise machine works"; fi
[ $n_failed = 0 ]
