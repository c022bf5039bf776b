#!/usr/bin/env bash
# Proves that the exercises can be trusted; CTest runs these with the label `proof`.
#
#   prove.sh as-shipped PROGRAM ID FILE   the exercise as committed fails, by wrong answers and nothing else. They are the
#                                         stub's: all else is the solution's, which passes the same test
#   prove.sh mutant PROGRAM ID FILE       a typical mistake is caught, by a wrong answer or a diagnosis
#   prove.sh in-step ID SOLUTION EXERCISE SCRATCH   the committed exercise is what its solution makes
#   prove.sh rules ID SOLUTION            hints and at least three mutants are there
#   prove.sh chapter FOLDER               a chapter has at least two exercises
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)

fail() {
    echo "not proven: $*"
    exit 1
}

judged() {  # PROGRAM ID FILE -> kinds, one line a case
    [ -x "$1" ] || fail "$1 is not built (cmake --build --preset proofs)"
    kinds=$("$here/judge.sh" --kinds "$1" "$2" "$3" "$1.log")
    echo "$kinds"
}

what=$1
shift
case $what in
    as-shipped)
        judged "$@"
        other=$(grep -vE '^(wrong|passed)' <<<"$kinds" || true)
        [ -z "$other" ] || fail "as shipped, a case ends otherwise than by a wrong answer: $other"
        grep -q '^wrong' <<<"$kinds" || fail "the exercise passes as shipped"
        ;;
    mutant)
        judged "$@"
        grep -qE '^(wrong|diagnosed)' <<<"$kinds" || fail "no case catches this mistake"
        ;;
    in-step)
        awk -f "$here/make_exercise.awk" -v id="${1#0}" -v out="$4" "$2"
        diff -u "$3" "$4" || fail "${3#"$root"/} differs from what its solution makes (cmake --build --preset default --target exercises)"
        ;;
    rules)
        stem=${2%.*}
        name=${stem#"$root/solutions/"}
        grep -q '^## Hint 1' "$stem.hints.md" || fail "solutions/$name.hints.md has no section '## Hint 1'"
        n_mutants=$(find "$root/tests/mutants/$name" -name '*.patch' 2>/dev/null | wc -l || true)
        [ "$n_mutants" -ge 3 ] || fail "tests/mutants/$name holds $n_mutants patches; an exercise has at least 3"
        ;;
    chapter)
        n=$(find "$root/solutions/$1" -name 'ex*.h' -o -name 'ex*.cuh' 2>/dev/null | wc -l || true)
        [ "$n" -ge 2 ] || fail "chapter $1 has $n exercises; a chapter has at least 2"
        ;;
esac
