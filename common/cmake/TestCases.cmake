# course_discover_tests(<target> PREFIX <text> LABELS <label...>): one CTest test for each TEST_CASE of a program, found by
# asking the program after it is built. (doctest_discover_tests does that too, but a case's name may hold no semicolon
# there, and a test only one label.)
set(COURSE_DISCOVER_SCRIPT ${CMAKE_CURRENT_LIST_DIR}/discover_test_cases.cmake)

function(course_discover_tests target)
    cmake_parse_arguments(arg "" "PREFIX" "LABELS" ${ARGN})
    set(tests_file ${CMAKE_CURRENT_BINARY_DIR}/${target}_tests.cmake)
    string(REPLACE ";" "," labels "${arg_LABELS}")
    add_custom_command(TARGET ${target} POST_BUILD BYPRODUCTS ${tests_file} VERBATIM
        COMMAND ${CMAKE_COMMAND} -D PROGRAM=$<TARGET_FILE:${target}> -D PREFIX=${arg_PREFIX} -D LABELS=${labels}
            -D TESTS_FILE=${tests_file} -P ${COURSE_DISCOVER_SCRIPT})
    # A program that is not built is a test that fails, not one that is forgotten.
    set(include_file ${CMAKE_CURRENT_BINARY_DIR}/${target}_include.cmake)
    file(WRITE ${include_file} "if(EXISTS \"${tests_file}\")\n    include(\"${tests_file}\")\nelse()\n"
        "    add_test(\"${arg_PREFIX}: is not built\" ${target}_is_not_built)\nendif()\n")
    set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${include_file})
endfunction()
