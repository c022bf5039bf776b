# Doxygen's input filter: turns a page written for GitHub into what Doxygen 1.9 understands.
#
#   awk -f docs/markdown.awk -f docs/page_filter.awk PAGE
#
#   $x$, $`x`$, $$x$$, ```math     -> formulas (\f$, \f[)
#   [text](../other/README.md#part) -> a link to that page of the site; files that are not in the site: plain text
#   ![alt](picture.png)            -> the copy of the picture under pictures/
#   <!-- made by: COMMAND -->      -> the command, shown under its picture
#   headings                       -> the anchors that GitHub gives them
#   **, *, <details>, alerts, "    -> their HTML
#
# Code spans and code blocks stay as they are, and line numbers are kept for Doxygen's warnings.
# From the environment: COURSE_PAGES and COURSE_SOURCES, the files of the site as paths from the root.

BEGIN {
    page_count = split(ENVIRON["COURSE_PAGES"], pages, " ")
    for (i = 1; i <= page_count; ++i) is_page[pages[i]] = i
    count = split(ENVIRON["COURSE_SOURCES"], sources, " ")
    for (i = 1; i <= count; ++i) is_source[sources[i]] = 1
}

FNR == 1 {
    page = FILENAME
    if (index(page, ENVIRON["PWD"] "/") == 1) page = substr(page, length(ENVIRON["PWD"]) + 2)
}

# The name of a page in Doxygen: its folder, since most pages are a folder's README.
function label_of(path) {
    if (path == "README.md") return "index"
    sub(/(\/README)?\.md$/, "", path)
    gsub(/[^A-Za-z0-9_]/, "_", path)
    return path
}

function html(text) { return "\\htmlonly " text " \\endhtmlonly" }

function formula(tex) {
    if (in_table) gsub(/\\\|/, "\\vert ", tex)
    return "\\f$" tex "\\f$"
}

function link(text, target,    path, anchor) {
    gsub(/`/, "", text) # Doxygen takes link text literally
    if (is_external(target)) return "[" text "](" target ")"
    path = target ~ /^#/ ? page : resolve(page, target)
    if ((path "/README.md") in is_page) path = path "/README.md"
    if (path in is_page) {
        anchor = target ~ /#/ && path != "README.md" ? substr(target, index(target, "#") + 1) : ""
        return "[" text "](@ref " label_of(path) (anchor == "" ? "" : "-" anchor_of(anchor)) ")"
    }
    return path in is_source ? "[" text "](@ref " path ")" : text
}

function picture(alt, target) {
    return "<img src=\"" (is_external(target) ? target : "pictures/" resolve(page, target)) "\" alt=\"" alt "\">"
}

# The span that opens with `quote` at the head of text, its inside in `inside`; its length, 0 if never closed.
function span(text, quote,    n, at) {
    n = length(quote)
    at = index(substr(text, n + 1), quote)
    inside = at > 1 ? substr(text, n + 1, at - 1) : ""
    return at > 1 ? at - 1 + 2 * n : 0
}

# How long the piece of syntax at the head of `text` is; `piece` becomes what Doxygen gets in its place.
function convert_head(text, before,    n, head) {
    if (match(text, /^`+/)) {
        head = substr(text, 1, RLENGTH)
        n = span(text, head)
        if (n == 0) return 0
        if (inside ~ /'/ && head == "`") head = "``" # else Doxygen sees a quotation, `so'
        piece = head inside head
        if (in_table && inside ~ /\\\|/) {
            gsub(/</, "\\&lt;", inside)
            gsub(/\\\|/, "\\&#124;", inside)
            piece = html("<code>" inside "</code>")
        }
        return n
    }
    if (text ~ /^\$\$/ && (n = span(text, "$$"))) {
        piece = "\\f[" inside "\\f]"
        return n
    }
    if (text ~ /^\$`/ && match(text, /^\$`[^`]+`\$/)) {
        n = RLENGTH
        piece = formula(substr(text, 3, n - 4))
        return n
    }
    if (text ~ /^\$[^ \t\n$]/ && before !~ /[A-Za-z0-9]$/ && (n = span(text, "$"))) {
        if (inside ~ /[ \t\n]$/ || substr(text, n + 1) ~ /^[A-Za-z0-9]/) return 0
        piece = formula(inside)
        return n
    }
    if (text ~ /^\\[^A-Za-z0-9 \n]/) { # an escaped sign; Doxygen knows all of Markdown's but \$
        piece = text ~ /^\\\$/ ? "$" : substr(text, 1, 2)
        return 2
    }
    if (match(text, /^\[!\[[^]]*\]\([^)]*\)\]\([^)]*\)/)) { # a picture that is a link: the picture
        n = RLENGTH
        match(text, /!\[[^]]*\]\([^)]*\)/)
        head = substr(text, RSTART, RLENGTH)
        piece = picture(substr(head, 3, index(head, "](") - 3), target_in(head))
        return n
    }
    if (match(text, /^!\[[^]]*\]\([^)]*\)/)) {
        n = RLENGTH
        head = substr(text, 1, n)
        piece = picture(substr(head, 3, index(head, "](") - 3), target_in(head))
        return n
    }
    if (match(text, /^\[[^]\[]*\]\([^)]*\)/)) {
        n = RLENGTH
        head = substr(text, 1, n)
        piece = link(substr(head, 2, index(head, "](") - 2), target_in(head))
        return n
    }
    if (match(text, /^<img [^>]*src="[^"]*"/)) {
        n = RLENGTH
        head = substr(text, 1, n)
        match(head, /src="[^"]*"/)
        target = substr(head, RSTART + 5, RLENGTH - 6)
        piece = substr(head, 1, RSTART + 4) "pictures/" resolve(page, target) "\""
        return n
    }
    if (match(text, /^<!-- made by: [^\n]* -->/)) {
        n = RLENGTH
        head = substr(text, 15, n - 18)
        gsub(/</, "\\&lt;", head)
        piece = html("<span class=\"made-by\">" head "</span>")
        return n
    }
    if (match(text, /^<\/?details>|^<summary>[^\n]*<\/summary>/)) {
        n = RLENGTH
        piece = "\\htmlonly[block] " substr(text, 1, n) " \\endhtmlonly"
        return n
    }
    if (match(text, /^<\/?[A-Za-z][^>]*>|^<!--/)) { # other HTML stays as it is, quotation marks included
        piece = substr(text, 1, RLENGTH)
        return RLENGTH
    }
    if (text ~ /^\*/ && (n = emphasis(text, before))) return n
    if (match(text, /^["@]/)) { # Doxygen looks for commands and quotations; here are none
        piece = text ~ /^@/ ? "\\@" : "&quot;"
        return 1
    }
    return 0
}

# **strong** and *emphasis* as HTML, since Doxygen misses those with code or formulas inside.
function emphasis(text, before,    mark, tag) {
    mark = text ~ /^\*\*/ ? "**" : "*"
    tag = mark == "**" ? "strong" : "em"
    if (opened[mark] ? before ~ /[ \t\n]$/ : substr(text, length(mark) + 1) !~ /^[^ \t\n*]/) return 0
    if (!opened[mark] && (before ~ /[A-Za-z0-9*]$/ || !index(substr(text, length(mark) + 1), mark))) return 0
    opened[mark] = !opened[mark]
    piece = "<" (opened[mark] ? "" : "/") tag ">"
    return length(mark)
}

# A paragraph, its lines joined by newlines, with every piece of GitHub's syntax converted.
function convert(text,    out, n) {
    in_table = text ~ /^ *\|/
    opened["*"] = opened["**"] = 0
    while (match(text, /[`$[!<@\\"*]/)) {
        out = out substr(text, 1, RSTART - 1)
        text = substr(text, RSTART)
        n = convert_head(text, out)
        if (n == 0) { # nothing of ours: literal; a run of backticks as a whole
            n = match(text, /^`+/) ? RLENGTH : 1
            piece = substr(text, 1, n)
        }
        out = out piece
        text = substr(text, n + 1)
    }
    return out text (opened["*"] ? "</em>" : "") (opened["**"] ? "</strong>" : "")
}

function flush_paragraph() {
    if (paragraph != "") print convert(paragraph)
    paragraph = ""
}

function heading(line,    level, text, label) {
    match(line, /^#+/)
    level = substr(line, 1, RLENGTH)
    text = substr(line, RLENGTH + 2)
    gsub(/`/, "", text)
    label = label_of(page) (level == "#" ? "" : "-" anchor_of(text))
    if (label in used) label = label "-" used[label]++
    else used[label] = 1
    # The front page's parts have no names, or they would fill the side bar before the chapters.
    print level " " text (page == "README.md" ? "" : " {#" label "}")
}

# The title of another page, for the links to the neighbours.
function title_of(path,    line) {
    while ((getline line < path) > 0)
        if (line ~ /^# /) break
    close(path)
    return substr(line, 3)
}

in_fence && math && /^ *``` *$/ { print "\\f]"; skipped = skipped "\n"; in_fence = math = 0; next }
in_fence && math { printf "%s ", $0; skipped = skipped "\n"; next }
in_fence { print; if ($0 ~ /^ *``` *$/) in_fence = 0; next }

/^ *```/ {
    flush_paragraph()
    in_fence = 1
    math = $0 ~ /^ *``` *math *$/
    sub(/glsl/, "cpp") # near enough to be coloured
    if (math) printf "\\f["
    else print
    next
}

/^#+ / { flush_paragraph(); heading($0); next }

/^[ \t]*$/ { flush_paragraph(); printf "%s", skipped; skipped = ""; print; next }

{
    sub(/^> \[!NOTE\] *$/, "> **Note**")
    sub(/^> \[!TIP\] *$/, "> **Tip**")
    sub(/^> \[!(IMPORTANT|WARNING|CAUTION)\] *$/, "> **Mind**")
    if (match($0, /^ *[-*] \[[ x]\] /)) $0 = substr($0, 1, RLENGTH - 4) ($0 ~ /\[x\]/ ? "☑ " : "☐ ") substr($0, RLENGTH + 1)
    paragraph = paragraph == "" ? $0 : paragraph "\n" $0
}

END {
    flush_paragraph()
    here = is_page[page]
    before = here > 1 ? pages[here - 1] : ""
    after = here > 0 && here < page_count ? pages[here + 1] : ""
    if (page !~ /^chapters\//) exit
    print "\n" html("<hr>") "\n"
    print (before ~ /^chapters\// ? "Before: [" title_of(before) "](@ref " label_of(before) ")" : "[All chapters](@ref index)") \
        (after ~ /^chapters\// ? " · next: [" title_of(after) "](@ref " label_of(after) ")" : "")
}
