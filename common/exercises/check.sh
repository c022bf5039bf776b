#!/usr/bin/env bash
# Builds one exercise and judges it: at most a screen of text, exit code 0 only if it passes.
#
#   check.sh BUILD_FOLDER ID LEARNER_FILE
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
build=$1 id=$2 learner_file=$3
target=exercise_${id/./_}
log=$build/check/$id.log
mkdir -p "$build/check"

# The compiler's own words about the first two errors, those in the learner's file first; gcc and nvcc differ in form.
report_errors() {
    awk -v file="$(basename "$learner_file")" -v root="$root/" '
        function mine() { return index($0, file ":") || index($0, file "(") }
        { at = index($0, root); if (at) $0 = substr($0, 1, at - 1) substr($0, at + length(root)) }
        /error[: ]|undefined reference/ { show = ++n[mine()] <= 2 ? 5 : 0 }
        /: (warning|note): / || /^\[[0-9]+\/[0-9]+\]|^ninja:|^(In file included|FAILED:)/ { show = 0 }
        show > 0 { text[mine_now = /error[: ]|undefined reference/ ? mine() : mine_now] = text[mine_now] "  " substr($0, 1, 160) "\n"; show-- }
        END { printf "%s", n[1] ? text[1] : text[0] }' "$log"
}

if ! cmake --build "$build" --target "$target" >"$log" 2>&1 </dev/null; then
    if grep -q "unknown target" "$log"; then
        echo "$id cannot be built on this machine; ./course doctor says what its chapter needs"
    else
        echo "$id does NOT COMPILE"
        report_errors
        echo "all output: ${log#"$root"/}"
    fi
    exit 1
fi
exec "$here/judge.sh" "$build/exercises/$target" "$id" "$learner_file" "$log"
