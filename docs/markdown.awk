# What the awk programs of this folder know about Markdown pages: paths, links, anchors.

# "chapters/05_grid/README.md" -> "chapters/05_grid/"
function folder_of(path) {
    return path ~ /\// ? substr(path, 1, match(path, /[^\/]*$/) - 1) : ""
}

# A relative link of the page at `page`, as a path from the repository root.
function resolve(page, target,    parts, kept, n, i, path) {
    sub(/#.*/, "", target)
    n = split(folder_of(page) target, parts, "/")
    kept = 0
    for (i = 1; i <= n; ++i) {
        if (parts[i] == "" || parts[i] == ".") continue
        if (parts[i] == ".." && kept > 0) --kept
        else parts[++kept] = parts[i]
    }
    for (i = 1; i <= kept; ++i) path = path (i > 1 ? "/" : "") parts[i]
    return path
}

# The name that GitHub gives a heading's anchor, reduced to ASCII.
function anchor_of(heading) {
    heading = tolower(heading)
    gsub(/[^a-z0-9 _-]/, "", heading)
    gsub(/ /, "-", heading)
    return heading
}

function is_picture(path) { return path ~ /\.(png|jpg|jpeg|gif|svg|webp)$/ }

function is_external(target) { return target ~ /^[a-z]+:/ }

# The target in "[text](target)" or "![alt](target "title")", given the matched text.
function target_in(link) {
    sub(/^!?\[.*\]\(/, "", link)
    sub(/\)$/, "", link)
    sub(/[ \t]+".*"$/, "", link)
    return link
}
