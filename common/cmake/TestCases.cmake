# course_discover_tests(<target> PREFIX <text> LABELS <label...>): one CTest test for each TEST_CASE of a program, skipped
# where the program ends with 77.
include(doctest)

function(course_discover_tests target)
    cmake_parse_arguments(arg "" "PREFIX" "LABELS" ${ARGN})
    doctest_discover_tests(${target} TEST_PREFIX "${arg_PREFIX}: " PROPERTIES SKIP_RETURN_CODE 77)
    # doctest_discover_tests cannot pass a list on as a property; it leaves the names of its tests in <target>_TESTS.
    set(labels_file ${CMAKE_CURRENT_BINARY_DIR}/${target}_labels.cmake)
    file(WRITE ${labels_file} "if(DEFINED ${target}_TESTS)\n"
        "    set_tests_properties(\${${target}_TESTS} PROPERTIES LABELS \"${arg_LABELS}\")\n"
        "endif()\n")
    set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${labels_file})
endfunction()
