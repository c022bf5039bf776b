# Checks what the pages point at: awk -f docs/markdown.awk -f docs/check_pages.awk PAGE...   (from the root)
#
#   - every relative link and every picture exists;
#   - every picture and data file has the command that makes it, on its line or on the next one:
#         ![The column after 2 s](column.png)
#         <!-- made by: ./course run 10 --scene drop -->
#   - no @PLACEHOLDER@ is left on a line of its own;
#   - every picture in the tree is shown by some page;
#   - every chapter's page is linked from README.md.
#
# Exit 1: something is wrong, said on standard error with page and line.

function wrong(line, message) {
    print page ":" line ": " message > "/dev/stderr"
    failed = 1
}

function exists(path) {
    if (!(path in known)) known[path] = path ~ /^[A-Za-z0-9_.\/+-]+$/ && system("test -e " path) == 0
    return known[path]
}

function is_result(path) { return is_picture(path) || path ~ /\.(csv|json)$/ }

function no_command() {
    if (owed != "") wrong(owed_line, owed " has no command beside it: <!-- made by: ./course ... -->")
    owed = ""
}

FNR == 1 {
    no_command()
    page = FILENAME
    in_fence = 0
    if (page ~ /^chapters\//) chapters[page] = 1
}

/^[ \t]*$/ { next }

/<!-- made by: / {
    if ($0 ~ /<!-- made by: \.\/course [^>]* -->/) owed = ""
    else wrong(FNR, "expected <!-- made by: ./course ... -->")
    has_command = 1
}

!/<!-- made by: / { no_command(); has_command = 0 }

/^ *```/ { in_fence = !in_fence; next }

/^@[A-Z_]+@ *$/ { wrong(FNR, $1 " is not filled in") }

in_fence { next }

{
    rest = $0
    gsub(/`[^`]*`/, "", rest)
    while (match(rest, /\]\([^)]*\)|src="[^"]*"/)) {
        target = substr(rest, RSTART, RLENGTH)
        rest = substr(rest, RSTART + RLENGTH)
        if (target ~ /^src/) target = substr(target, 6, length(target) - 6)
        else target = target_in("[" target)
        if (target == "") wrong(FNR, "a link to nowhere")
        if (target == "" || target ~ /^#/ || is_external(target)) continue
        path = resolve(page, target)
        if (!exists(path)) wrong(FNR, "there is no " path)
        if (is_result(path) && !has_command) { owed = path; owed_line = FNR }
        shown[path] = 1
        if (page == "README.md") linked[path] = linked[path "/README.md"] = 1
    }
}

END {
    no_command()
    find = "find chapters common docs -name '*.png' -o -name '*.jpg' -o -name '*.svg'"
    while ((find | getline page) > 0)
        if (!(page in shown)) wrong(1, "no page shows this picture")
    page = "README.md"
    for (chapter in chapters)
        if (!(chapter in linked)) wrong(1, "no link to " chapter)
    exit failed
}
