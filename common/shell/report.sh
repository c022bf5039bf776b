# Sourced by ./course: report, every study and every stability map, measured, drawn and concluded on one page.
# Expects setup.sh.
# shellcheck shell=bash

# What a chapter's program can measure: "study NAME" or "stability NAME", a line each.
measurements_of() {  # BUILD CHAPTER
    "$1/bin/ch$2" --list-studies 2>/dev/null | sed -n 's/^\(study\|stability\) \([a-z0-9_]*\):.*/\1 \2/p'
}

report() {
    local quick=() only='' chapter chapters kind name done=0 total start=$SECONDS failed=()
    while [ $# -gt 0 ]; do
        case $1 in
            --quick) quick=(--quick) ;;
            -*) stop 2 "report knows only --quick and a chapter, not '$1'" ;;
            *) only=$(chapter_folder "$1") ;; # its exit code 2 ends the script
        esac
        shift
    done
    ensure_packages build report
    configure
    chapters=$(built_chapters)
    if [ -n "$only" ]; then
        grep -qx "$only" <<<"$chapters" || stop 2 "chapter $only cannot be built on this machine: $(left_out | sed -n "s/^$only: //p")"
        chapters=$only
    fi
    # shellcheck disable=SC2046,SC2086  # lists of words
    build_targets $(printf 'ch%s ' $chapters) course_report
    left_out | while read -r line; do say "not measured: $line"; done

    # "chapter kind name", a line each. What is measured no more leaves the report.
    local measurements='' names json
    for chapter in $chapters; do
        names=$(measurements_of "$build" "$chapter")
        measurements+=$(sed "s/^/$chapter /" <<<"$names")$'\n'
        for json in "$root/out/report/$chapter"/{study,stability}_*.json; do
            kind=$(basename "$json" .json)
            grep -qx "${kind%%_*} ${kind#*_}" <<<"$names" || rm -f "${json%.json}".*
        done
    done
    measurements=$(grep . <<<"$measurements") || stop 1 "no chapter has a study"
    total=$(wc -l <<<"$measurements")
    mkdir -p "$logs"
    while read -r chapter kind name; do
        done=$((done + 1))
        say "[$done/$total] $chapter: $kind $name (after $((SECONDS - start)) s)"
        rm -f "$root/out/report/$chapter/${kind}_$name".* # an old result must not pass for a new one
        "$build/bin/ch$chapter" "--$kind" "$name" "${quick[@]}" --out "$root/out/report/$chapter" \
            >"$logs/report_${chapter}_$name.log" </dev/null || failed+=("$chapter $kind $name (exit code $?)")
    done <<<"$measurements"
    "$build/bin/course_report" "$root/out/report" "$root/out/report.html" || failed+=("the page")
    say "measured and drawn in $((SECONDS - start)) s"
    printf 'The report: %s\n' "$root/out/report.html"
    [ ${#failed[@]} = 0 ] || stop 1 "failed: ${failed[*]}"
}
