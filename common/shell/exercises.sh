# Sourced by ./course: check, hint, reset and list. Expects setup.sh.
# shellcheck shell=bash

progress=$root/build/progress  # one file an exercise: passed or failed, as of its last check

# "05.2 solutions/05_spatial_grid/ex2_name.cuh" of every exercise, in course order. The solutions are the list.
all_exercises() {
    local path name
    (cd "$root" && find solutions -name 'ex[0-9]*_*.h' -o -name 'ex[0-9]*_*.cuh') | sort | while read -r path; do
        name=${path##*/ex}
        path=${path#solutions/}
        echo "${path%%_*}.${name%%_*} $path"
    done
}

# The lines of all_exercises that a learner means by 05.2, 5.2, 05, 5 or nothing; exit code 2 if there are none.
find_exercises() {
    local wanted=$1 found
    if [[ $wanted =~ ^[0-9]([.]|$) ]]; then wanted=0$wanted; fi
    case $wanted in
        '') found=$(all_exercises) ;;
        *.*) found=$(all_exercises | grep "^${wanted//./[.]} " || true) ;;
        *) found=$(all_exercises | grep "^${wanted}[.]" || true) ;;
    esac
    [ -n "$found" ] || stop 2 "there is no exercise '$1'; there are: $(all_exercises | cut -d ' ' -f 1 | tr '\n' ' ')"
    echo "$found"
}

one_exercise() {  # sets id and path
    [[ ${1:-} =~ ^[0-9]+[.][0-9]+$ ]] || stop 2 "which exercise? for instance: ./course $command 05.2"
    local found
    found=$(find_exercises "$1")
    read -r id path <<<"$found"
}

# Ninja goes by time. A file that was moved back (a kept version, git stash) may be older than what was built of
# another one; it must not be judged by that.
refresh() {  # ID PATH
    local file=$root/exercises/$2 built=$build/exercises/exercise_${1/./_} seen=$build/check/$1.sum sum
    sum=$(cksum <"$file")
    if [ "$file" -ot "$built" ] && [ "$sum" != "$(cat "$seen" 2>/dev/null)" ]; then touch "$file"; fi
    mkdir -p "$build/check"
    echo "$sum" >"$seen"
}

check_one() {
    local code=0
    refresh "$1" "$2"
    "$root/common/exercises/check.sh" "$build" "$1" "$root/exercises/$2" || code=$?
    mkdir -p "$progress"
    if [ $code = 0 ]; then echo passed; else echo failed; fi >"$progress/$1"
    return $code
}

check() {
    local found id path n_failed=0 targets=()
    found=$(find_exercises "${1:-}")
    if [ ! -f "$build/build.ninja" ]; then
        configure
        say "building what exercises need; that happens once"
    fi
    if [[ ${1:-} == *.* ]]; then
        read -r id path <<<"$found"
        check_one "$id" "$path"
        return
    fi
    # All at once, so that every core has work; what does not compile is told by its own check below.
    while read -r id path; do
        refresh "$id" "$path"
        targets+=("exercise_${id/./_}")
    done <<<"$found"
    (cd "$root" && quietly build_exercises cmake --build --preset default --target "${targets[@]}" -- -k 0) || true
    while read -r id path; do
        # The first lines say it: what failed, what was expected, what came. All of it: ./course check of that one.
        check_one "$id" "$path" >"$logs/check.txt" || n_failed=$((n_failed + 1))
        head -n 2 "$logs/check.txt"
    done <<<"$found"
    echo
    if [ $n_failed = 0 ]; then
        echo "all ${#targets[@]} exercises pass"
    else
        echo "$n_failed of ${#targets[@]} exercises fail; ./course check NN.E tells more of one"
        return 1
    fi
}

hint() {  # NN.E [n]; without n the next one
    local id path hints n count given
    one_exercise "${1:-}"
    hints=$root/solutions/${path%.*}.hints.md
    count=$(grep -c '^## Hint ' "$hints")
    given=$progress/$id.hints
    if [ -n "${2:-}" ]; then
        n=$2
        [[ $n =~ ^[1-9][0-9]?$ && $n -le $count ]] || stop 2 "exercise $id has hints 1 to $count, not '$n'"
    else
        n=$(cat "$given" 2>/dev/null || echo 0)
        [[ $n =~ ^[1-9][0-9]?$ ]] || n=0  # none yet, or a file that somebody else wrote
        n=$((n + 1))
    fi
    if [ "$n" -gt "$count" ]; then
        echo "Those were all $count hints. The solution is in solutions/$path"
        return
    fi
    mkdir -p "$progress"
    echo "$n" >"$given"
    echo "Exercise $id, hint $n of $count"
    awk -v n="$n" '/^## Hint / { shown = ($3 + 0 == n); next } shown' "$hints"
}

reset() {
    local id path file kept made number
    one_exercise "${1:-}"
    file=$root/exercises/$path
    made=$(mktemp)
    awk -f "$root/common/exercises/make_exercise.awk" -v id="${id#0}" -v out="$made" "$root/solutions/$path"
    if cmp -s "$made" "$file"; then
        rm "$made"
        echo "exercises/$path is as it was at the start"
        return
    fi
    if [ -f "$file" ]; then
        kept=$file.mine
        number=2
        while [ -e "$kept" ]; do kept=$file.mine.$((number++)); done
        mv "$file" "$kept"
        echo "your version is kept as ${kept#"$root"/}"
    fi
    mkdir -p "$(dirname "$file")"
    cat "$made" >"$file"
    rm "$made"
    rm -f "$progress/$id" "$progress/$id.hints"
    echo "exercises/$path is as it was at the start again"
}

list() {
    local folder title id path state
    for folder in "$root"/chapters/[0-9]*/; do
        folder=$(basename "$folder")
        title=$(sed -n 's/^# //p;T;q' "$root/chapters/$folder/README.md" 2>/dev/null || true)
        echo "$folder  $title"
        all_exercises | while read -r id path; do
            [ "${path%/*}" = "$folder" ] || continue
            state=$(cat "$progress/$id" 2>/dev/null || echo 'not tried')
            printf '    %s  %-10s exercises/%s\n' "$id" "$state" "$path"
        done
    done
}
