# What the simulator does not have is a compile error that says so. Each test runs the compiler on one use.
get_filename_component(cudasim_include ${CMAKE_SOURCE_DIR}/common/cudasim/include ABSOLUTE)
set(copy ${COURSE_MIRROR}/tests/cudasim/unsupported/uses.cu.cpp)  # rewritten as part of the tree

function(add_unsupported use message)
    add_test(NAME "cudasim unsupported: ${use}" COMMAND ${CMAKE_CXX_COMPILER} -std=c++17 -fsyntax-only
        -I${cudasim_include} -D${use} ${copy})
    set_tests_properties("cudasim unsupported: ${use}" PROPERTIES LABELS cudasim PASS_REGULAR_EXPRESSION "${message}")
endfunction()

add_unsupported(COOPERATIVE_GROUPS "error: .*has no cooperative groups: use __syncthreads")
add_unsupported(MANAGED_VARIABLE "error: .*has no managed memory: use cudaMalloc and cudaMemcpy")
add_unsupported(MANAGED_MEMORY "error: .*has no cudaMallocManaged: use cudaMalloc and cudaMemcpy")
add_unsupported(ACTIVE_MASK "error: .*has no __activemask: .*__ballot_sync")
add_unsupported(GRAPHS "uses.cu:[0-9]+:[0-9]+: error: .*cudaGraph_t")
# Errors of the learner's own name the learner's file and line.
function(place_of_mark result mark)
    file(STRINGS ${CMAKE_CURRENT_SOURCE_DIR}/unsupported/uses.cu lines)
    set(number 0)
    foreach(line IN LISTS lines)
        math(EXPR number "${number} + 1")
        if(line MATCHES "mark: ${mark}$")
            set(${result} "uses.cu:${number}:" PARENT_SCOPE)
        endif()
    endforeach()
endfunction()
place_of_mark(wrong wrong)
place_of_mark(few few)
add_unsupported(WRONG_ARGUMENT "${wrong}[0-9]+: error: .*no known conversion for argument 1 from .*double.* to .*int")
add_unsupported(TOO_FEW_ARGUMENTS "${few}[0-9]+: error: no match for call")

add_test(NAME "cudasim unsupported: nothing" COMMAND ${CMAKE_CXX_COMPILER} -std=c++17 -fsyntax-only
    -I${cudasim_include} ${copy})
set_tests_properties("cudasim unsupported: nothing" PROPERTIES LABELS cudasim)
