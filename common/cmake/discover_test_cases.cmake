# Run by course_discover_tests after PROGRAM is built: writes TESTS_FILE, which CTest reads.
execute_process(COMMAND ${PROGRAM} --list-test-cases OUTPUT_VARIABLE names RESULT_VARIABLE result)
if(NOT result EQUAL 0)
    message(FATAL_ERROR "${PROGRAM} cannot list its test cases: ${result}\n${names}")
endif()
string(REPLACE "," ";" labels "${LABELS}")

# Line by line and not as a CMake list, since a name may hold anything but a line's end.
set(script "")
string(FIND "${names}" "\n" line_end)
while(NOT line_end EQUAL -1)
    string(SUBSTRING "${names}" 0 ${line_end} name)
    math(EXPR next "${line_end} + 1")
    string(SUBSTRING "${names}" ${next} -1 names)
    string(FIND "${names}" "\n" line_end)
    string(REPLACE "\\" "\\\\" filter "${name}")  # in doctest's filters a comma separates
    string(REPLACE "," "\\," filter "${filter}")
    string(APPEND script "add_test([==[${PREFIX}: ${name}]==] [==[${PROGRAM}]==] [==[--test-case=${filter}]==])\n"
        "set_tests_properties([==[${PREFIX}: ${name}]==] PROPERTIES SKIP_RETURN_CODE 77 LABELS \"${labels}\")\n")
endwhile()
file(WRITE ${TESTS_FILE} "${script}")
