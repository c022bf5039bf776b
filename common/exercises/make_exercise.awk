# Makes an exercise from its solution, the only source. Regions of the solution are marked
#
#     // TODO(5.2): what to write here, and about how many lines it takes.
#     // <solution>
#     ...                   left out of the exercise
#     // <stub>
#     //| return kTodo;     becomes "return kTodo;" in the exercise
#     // </solution>
#
# Use: awk -f make_exercise.awk -v id=5.2 -v out=EXERCISE SOLUTION
# A mistake in the markers is reported with file and line, and nothing is written.

function fail(what) {
    printf "%s:%d: %s\n", FILENAME, FNR, what > "/dev/stderr"
    failed = 1
    exit 1
}

BEGIN { todo = "// TODO(" id "):" }

index($0, todo) { todo_seen = 1 }

/^[ \t]*\/\/ <solution>$/ {
    if (part != "") fail("<solution> inside another region")
    if (!todo_seen) fail("no '" todo " ...' above this region")
    part = "solution"
    regions++
    next
}
/^[ \t]*\/\/ <stub>$/ {
    if (part != "solution") fail("<stub> outside a <solution> region")
    part = "stub"
    next
}
/^[ \t]*\/\/ <\/solution>$/ {
    if (part == "") fail("</solution> without <solution>")
    part = ""
    todo_seen = 0
    next
}
/\/\/ *<\/?(solution|stub)>/ { fail("a marker stands alone on its line, as '// <solution>'") }

part == "solution" {
    if ($0 ~ /^[ \t]*\/\/\|/) fail("a stub's line, but no '// <stub>' above it")
    next
}
part == "stub" {
    if ($0 !~ /^[ \t]*\/\/\|/) fail("a stub's line begins with '//|'")
    sub(/\/\/\| ?/, "")
    sub(/[ \t]+$/, "")
}
{ lines[++n] = $0 }

END {
    if (failed) exit 1
    if (part != "") fail("the last region is not closed by '// </solution>'")
    if (!regions) fail("no '// <solution>' region")
    for (i = 1; i <= n; i++) print lines[i] > out
}
