# add_exercise(NN_topic exE_name): the targets of one exercise, NN_E for short
#   solution_NN_E            the test built with the solution; part of the default build and test run (label solution)
#   exercise_NN_E            the test built with the learner's file; built by ./course check
#   mutant_NN_E_<mistake>    the test built with a patched copy of the solution
# and its proofs (label proof; see common/exercises/prove.sh). `exercise_proofs` builds what they run, and
# `exercises` makes all exercises anew from their solutions, which overwrites what a learner wrote there.
#
# Exercises and mutants are built with sanitizers where kernels run on the simulator, so that a crash names its line.
include(TestCases)

add_custom_target(exercise_proofs)
add_custom_target(exercises)
set(COURSE_EXERCISE_TOOLS ${CMAKE_SOURCE_DIR}/common/exercises)

# The test of an exercise as a program, with the header it tests taken from `folder`.
function(course_exercise_program target chapter test header folder)
    add_executable(${target} ${ARGN})
    set_target_properties(${target} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/exercises)
    get_target_property(libraries ch${chapter} LINK_LIBRARIES)  # an exercise may use what its chapter uses
    if(target MATCHES "^solution")
        course_target(${target} SOURCES ${test} INCLUDE_DIRS ${folder})
    else()
        course_target(${target} SOURCES ${test} INCLUDE_DIRS ${folder} HEADERS ${header} SANITIZE address)
    endif()
    target_link_libraries(${target} PRIVATE ${libraries} course_test_main)
endfunction()

function(add_course_proof name)
    add_test(NAME "proof: ${name}" COMMAND ${COURSE_EXERCISE_TOOLS}/prove.sh ${ARGN})
    set_tests_properties("proof: ${name}" PROPERTIES LABELS proof TIMEOUT 120)
endfunction()

# A copy of the solution with one mistake patched into it, and the proof that the test catches it.
function(add_mutant chapter name id test solution patch)
    get_filename_component(mistake ${patch} NAME_WE)
    get_filename_component(file ${solution} NAME)
    string(REPLACE "." "_" target "mutant_${id}_${mistake}")
    set(folder ${CMAKE_BINARY_DIR}/mutants/${chapter}/${name}/${mistake})
    file(MAKE_DIRECTORY ${folder})
    add_custom_command(OUTPUT ${folder}/${file}
        COMMAND patch --silent --reject-file=- --output=${folder}/${file} ${solution} ${patch}
        DEPENDS ${solution} ${patch} COMMENT "Patching ${id} ${mistake}" VERBATIM)
    course_exercise_program(${target} ${chapter} ${test} ${folder}/${file} ${folder}
        EXCLUDE_FROM_ALL ${folder}/${file})
    add_dependencies(exercise_proofs ${target})
    add_course_proof("${id} mutant ${mistake} is caught" mutant $<TARGET_FILE:${target}> ${id} ${folder}/${file})
endfunction()

function(add_exercise chapter name)
    if(NOT TARGET ch${chapter})
        return()  # the chapter is left out here, and the summary says why
    endif()
    string(REGEX MATCH "^[0-9]+" chapter_number ${chapter})
    string(REGEX REPLACE "^ex([0-9]+)_.*" "\\1" number ${name})
    set(id ${chapter_number}.${number})
    set(suffix ${chapter_number}_${number})
    file(GLOB solution ${CMAKE_SOURCE_DIR}/solutions/${chapter}/${name}.cuh ${CMAKE_SOURCE_DIR}/solutions/${chapter}/${name}.h)
    get_filename_component(file ${solution} NAME)
    set(exercise ${CMAKE_SOURCE_DIR}/exercises/${chapter}/${file})
    course_find_source(test ${CMAKE_SOURCE_DIR}/tests/exercises/${chapter}/${name})
    if(NOT test)
        message(FATAL_ERROR "Exercise ${id} has no test tests/exercises/${chapter}/${name}.cu or .cpp")
    endif()

    course_exercise_program(solution_${suffix} ${chapter} ${test} ${solution} ${CMAKE_SOURCE_DIR}/solutions/${chapter})
    course_discover_tests(solution_${suffix} PREFIX "solution ${id}" LABELS solution)

    course_exercise_program(exercise_${suffix} ${chapter} ${test} ${exercise} ${CMAKE_SOURCE_DIR}/exercises/${chapter}
        EXCLUDE_FROM_ALL)
    add_dependencies(exercise_proofs exercise_${suffix})
    string(REGEX REPLACE "^0" "" plain_id ${id})  # comments say 5.2, commands 05.2
    add_custom_target(make_exercise_${suffix} VERBATIM COMMENT "Making exercise ${id} from its solution"
        COMMAND ${CMAKE_COMMAND} -E make_directory ${CMAKE_SOURCE_DIR}/exercises/${chapter}
        COMMAND awk -f ${COURSE_EXERCISE_TOOLS}/make_exercise.awk -v id=${plain_id} -v out=${exercise} ${solution})
    add_dependencies(exercises make_exercise_${suffix})

    add_course_proof("${id} is in step with its solution" in-step ${id} ${solution} ${exercise}
        ${CMAKE_BINARY_DIR}/exercises/made_anew_${suffix})
    add_course_proof("${id} fails as shipped" as-shipped $<TARGET_FILE:exercise_${suffix}> ${id} ${exercise})
    add_course_proof("${id} has hints and mutants" rules ${id} ${solution})
    file(GLOB patches CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/tests/mutants/${chapter}/${name}/*.patch)
    foreach(patch IN LISTS patches)
        add_mutant(${chapter} ${name} ${id} ${test} ${solution} ${patch})
    endforeach()
endfunction()

# Every exercise of the tree, so that none is forgotten: a solution makes an exercise.
function(add_all_exercises)
    file(GLOB solutions CONFIGURE_DEPENDS RELATIVE ${CMAKE_SOURCE_DIR}/solutions
        ${CMAKE_SOURCE_DIR}/solutions/*/ex*.cuh ${CMAKE_SOURCE_DIR}/solutions/*/ex*.h)
    foreach(solution IN LISTS solutions)
        get_filename_component(chapter ${solution} DIRECTORY)
        get_filename_component(name ${solution} NAME_WE)
        add_exercise(${chapter} ${name})
    endforeach()
    foreach(chapter IN LISTS COURSE_CHAPTERS)
        if(chapter)
            add_course_proof("${chapter} has its exercises" chapter ${chapter})
        endif()
    endforeach()
endfunction()
