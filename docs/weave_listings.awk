# Fills the listings of one Markdown page from the source that each of them names.
#
#   awk -f docs/weave_listings.awk PAGE             the page with its listings renewed, on standard output
#   awk -v check=1 -f docs/weave_listings.awk PAGE  only compares: one message per listing that differs
#
# Run from the repository root; docs/weave.sh does that for all pages. In the page:
#
#   <!-- listing: grid.cuh cell_of -->
#   ```cpp
#   (replaced)
#   ```
#   <!-- /listing -->
#
# The text stands in the source between two lines "//! [cell_of]". The file is relative to the page's folder,
# or to the repository root if it contains a slash. Marker lines, also those of other listings, are left
# out, and so is the indentation that all lines share. Exit 1: something is wrong, said on standard error.

function wrong(line, message) {
    print FILENAME ":" line ": " message > "/dev/stderr"
    failed = 1
}

function folder_of(path) {
    return path ~ /\// ? substr(path, 1, match(path, /[^\/]*$/) - 1) : ""
}

# The fence that suits a source file, for a listing that has none yet.
function new_fence(path) {
    if (path ~ /\.(vert|frag|geom|glsl)$/) return "```glsl"
    return "```cpp"
}

# Reads the marked region into code[1..code_lines]. False, and the reason said, if that can't be done.
function read_region(path, marker, page_line,    text, name, inside, seen, status, indent, shared, i) {
    code_lines = 0
    shared = -1
    while ((status = (getline text < path)) > 0) {
        if (text ~ /^[ \t]*\/\/! \[[^]]*\][ \t]*$/) {
            name = text
            gsub(/^[^[]*\[|\][ \t]*$/, "", name)
            if (name == marker) {
                inside = !inside
                ++seen
            }
            continue
        }
        if (!inside || (code_lines == 0 && text ~ /^[ \t]*$/)) continue
        code[++code_lines] = text
        if (text ~ /[^ \t]/) {
            indent = match(text, /[^ ]/) - 1
            if (shared < 0 || indent < shared) shared = indent
        }
    }
    close(path)
    while (code_lines > 0 && code[code_lines] ~ /^[ \t]*$/) --code_lines
    for (i = 1; i <= code_lines; ++i) code[i] = substr(code[i], shared + 1)

    if (status < 0) wrong(page_line, "listing " marker ": there is no file " path)
    else if (seen != 2) wrong(page_line, "listing " marker ": " path " has " seen + 0 " lines \"//! [" marker "]\", expected 2")
    else if (code_lines == 0) wrong(page_line, "listing " marker ": nothing stands between its markers in " path)
    else return 1
    return 0
}

# Says where the page's listing, old[1..old_lines], leaves the source.
function compare(path, marker,    i) {
    for (i = 1; i <= code_lines || i + 2 <= old_lines; ++i) {
        if (i <= code_lines && i + 2 <= old_lines && old[i + 1] == code[i]) continue
        wrong(start + i + 1, "listing " marker " differs from " path " (renew it with docs/weave.sh)")
        print "    text: " (i + 2 <= old_lines ? old[i + 1] : "(ends)") > "/dev/stderr"
        print "    code: " (i <= code_lines ? code[i] : "(ends)") > "/dev/stderr"
        return
    }
}

# A whole listing has been read: old[] holds the lines between its two comments.
function weave(    path, i, fence) {
    path = source_file ~ /\// ? source_file : folder_of(FILENAME) source_file
    if (!read_region(path, marker, start)) return
    fence = old_lines > 0 && old[1] ~ /^```/ ? old[1] : new_fence(path)
    if (check && (old_lines < 2 || old[1] !~ /^```/ || old[old_lines] != "```"))
        wrong(start, "listing " marker ": no fenced block stands here yet (fill it with docs/weave.sh)")
    else if (check) compare(path, marker)
    else {
        print fence
        for (i = 1; i <= code_lines; ++i) print code[i]
        print "```"
    }
}

!in_listing && /^ *```/ { in_fence = !in_fence }

!in_listing && !in_fence && /^<!-- listing:/ && (NF != 5 || $5 != "-->") {
    wrong(FNR, "expected <!-- listing: FILE MARKER -->")
}

!in_listing && !in_fence && /^<!-- listing:/ && NF == 5 {
    start = FNR
    in_listing = 1
    old_lines = 0
    source_file = $3
    marker = $4
    if (!check) print
    next
}

in_listing && /^<!-- \/listing -->/ {
    weave()
    in_listing = 0
    if (!check) print
    next
}

in_listing { old[++old_lines] = $0; next }

# What a chapter shows of code must come from code. Other languages (sh, text, ...) are free.
check && in_fence && FILENAME ~ /^chapters\// && /^ *``` *(c|cc|cpp|c\+\+|cu|cuda|glsl)[ \t]*$/ {
    wrong(FNR, "code that is not a listing; pull it from its source by marker (or use ```text for what is no code of ours)")
}

!check { print }

END {
    if (in_listing) wrong(start, "listing " marker " has no <!-- /listing -->")
    exit failed
}
