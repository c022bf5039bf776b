# Runs a program that does something wrong and checks what it prints and how it ends.
#   cmake -DPROGRAM=... -DSOURCE=x.cu -DARGUMENT=... -DENVIRONMENT=A=1 -DEXIT=0|fail|... -DEXPECT="a|b" -P expect.cmake
# All texts between the bars must occur, in this order. @name@ in a text is the place of the comment
# "mark: name" in the source: x.cu:12.
file(READ ${SOURCE} text)
get_filename_component(source_name ${SOURCE} NAME)

function(resolve_marks result expected)
    while(expected MATCHES "@([a-z]+)@")
        set(mark ${CMAKE_MATCH_1})
        string(FIND "${text}" "mark: ${mark}\n" position)
        if(position EQUAL -1)
            message(FATAL_ERROR "${SOURCE} has no comment 'mark: ${mark}'")
        endif()
        string(SUBSTRING "${text}" 0 ${position} before)
        string(REGEX MATCHALL "\n" newlines "${before}")
        list(LENGTH newlines count)
        math(EXPR line "${count} + 1")
        string(REPLACE "@${mark}@" "${source_name}:${line}" expected "${expected}")
    endwhile()
    set(${result} "${expected}" PARENT_SCOPE)
endfunction()

execute_process(COMMAND ${CMAKE_COMMAND} -E env ${ENVIRONMENT} ${PROGRAM} ${ARGUMENT}
    RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
message("${output}")

set(rest "${output}")
string(REPLACE "|" ";" EXPECT "${EXPECT}")
foreach(expected IN LISTS EXPECT)
    resolve_marks(expected "${expected}")
    string(FIND "${rest}" "${expected}" position)
    if(position EQUAL -1)
        message(FATAL_ERROR "Expected (in this order), but not printed: ${expected}")
    endif()
    string(SUBSTRING "${rest}" ${position} -1 rest)
endforeach()

if(EXIT STREQUAL "fail")
    if(status EQUAL 0)
        message(FATAL_ERROR "The program ended with exit code 0, but should have failed")
    endif()
elseif(NOT status STREQUAL EXIT)
    message(FATAL_ERROR "The program ended with '${status}', expected ${EXIT}")
endif()
if(NOT EXPECT AND NOT output STREQUAL "")
    message(FATAL_ERROR "The program should have printed nothing")
endif()
