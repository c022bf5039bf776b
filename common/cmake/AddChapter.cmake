# add_chapter(NN_topic [GL])
#   program  chNN_topic     from chapters/NN_topic/main.cu or main.cpp
#   tests    test_NN_topic  from tests/chapters/NN_topic.cu or .cpp and, if there, NN_topic_extremes.cu or .cpp and
#                           NN_topic_incompressible.cu; one ctest per TEST_CASE
#            test_NN_topic_counts  from tests/chapters/NN_topic_counts.cu, if it is there: the same, built so that the
#                           simulator counts accesses to memory (course_target)
# GL: needs OpenGL. Without it the chapter is left out, and the summary says which package mends that.
include(TestCases)

set(COURSE_CHAPTERS "" CACHE INTERNAL "chapters that are built")
set(COURSE_LEFT_OUT "" CACHE INTERNAL "what is not built, and why")

function(course_leave_out what why)
    set(COURSE_LEFT_OUT "${COURSE_LEFT_OUT};${what}: ${why}" CACHE INTERNAL "")
endfunction()

# The one source named `stem` that exists: CUDA (.cu) or plain C++ (.cpp).
function(course_find_source out stem)
    foreach(extension cu cpp)
        if(EXISTS ${stem}.${extension})
            set(${out} ${stem}.${extension} PARENT_SCOPE)
            return()
        endif()
    endforeach()
    set(${out} "" PARENT_SCOPE)
endfunction()

function(add_chapter chapter)
    cmake_parse_arguments(arg "GL" "" "" ${ARGN})
    if(arg_GL AND NOT TARGET course_gl)
        course_leave_out(${chapter} "OpenGL, EGL or GLEW is missing (Debian: libegl-dev libglew-dev)")
        return()
    endif()
    set(libraries course_common)
    set(labels chapter)
    if(arg_GL)
        list(APPEND libraries course_gl)
        list(APPEND labels gl)
    endif()

    course_find_source(main ${CMAKE_SOURCE_DIR}/chapters/${chapter}/main)
    add_executable(ch${chapter})
    course_target(ch${chapter} SOURCES ${main})
    target_link_libraries(ch${chapter} PRIVATE ${libraries})

    course_find_source(test ${CMAKE_SOURCE_DIR}/tests/chapters/${chapter})
    if(test)
        course_find_source(extremes ${CMAKE_SOURCE_DIR}/tests/chapters/${chapter}_extremes)
        course_find_source(incompressible ${CMAKE_SOURCE_DIR}/tests/chapters/${chapter}_incompressible)
        add_executable(test_${chapter})
        course_target(test_${chapter} SOURCES ${test} ${extremes} ${incompressible})
        target_link_libraries(test_${chapter} PRIVATE ${libraries} course_test_main)
        target_compile_definitions(test_${chapter} PRIVATE COURSE_BIN_DIR="${CMAKE_RUNTIME_OUTPUT_DIRECTORY}"
            COURSE_DATA_DIR="${CMAKE_SOURCE_DIR}/tests/data")
        add_dependencies(test_${chapter} ch${chapter})  # tests of bad input start the program itself
        course_discover_tests(test_${chapter} PREFIX ${chapter} LABELS ${labels})
    endif()
    course_find_source(counts ${CMAKE_SOURCE_DIR}/tests/chapters/${chapter}_counts)
    if(counts)
        add_executable(test_${chapter}_counts)
        course_target(test_${chapter}_counts SOURCES ${counts} COUNT_ACCESSES)
        target_link_libraries(test_${chapter}_counts PRIVATE ${libraries} course_test_main)
        course_discover_tests(test_${chapter}_counts PREFIX ${chapter} LABELS ${labels})
    endif()
    set(COURSE_CHAPTERS "${COURSE_CHAPTERS};${chapter}" CACHE INTERNAL "")
endfunction()
