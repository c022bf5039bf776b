# add_diagnosis(<test> [PROGRAM name] [SANITIZE address|thread] EXIT <code>|fail [ENVIRONMENT NAME=value]
#               [ARGUMENT value] EXPECT <text...>)
# A program that does something wrong, and what it must print (see expect.cmake).
function(add_diagnosis name)
    cmake_parse_arguments(arg "" "PROGRAM;SANITIZE;EXIT;ENVIRONMENT;ARGUMENT" "EXPECT" ${ARGN})
    if(NOT arg_PROGRAM)
        set(arg_PROGRAM ${name})
    endif()
    if(COURSE_SANITIZE AND NOT arg_SANITIZE STREQUAL COURSE_SANITIZE)
        return()  # the whole build has a sanitizer, which changes what this program prints
    endif()
    set(source ${CMAKE_CURRENT_SOURCE_DIR}/diagnoses/${arg_PROGRAM}.cu)
    string(REGEX REPLACE "_$" "" target diagnosis_${arg_PROGRAM}_${arg_SANITIZE})
    if(NOT TARGET ${target})
        add_executable(${target})
        course_target(${target} SOURCES ${source} SANITIZE "${arg_SANITIZE}")
        set_target_properties(${target} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR})
    endif()
    string(REPLACE ";" "|" expected "${arg_EXPECT}")
    add_test(NAME "cudasim diagnosis: ${name}" COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:${target}>
        -DSOURCE=${source} -DARGUMENT=${arg_ARGUMENT} -DENVIRONMENT=${arg_ENVIRONMENT} -DEXIT=${arg_EXIT}
        -DEXPECT=${expected} -P ${CMAKE_CURRENT_SOURCE_DIR}/diagnoses/expect.cmake)
    set_tests_properties("cudasim diagnosis: ${name}" PROPERTIES LABELS cudasim TIMEOUT 120)
endfunction()

# Threads that do not meet.
add_diagnosis(barrier_divergence EXIT 0 EXPECT
    "cudasim: barrier divergence in kernel early_return_kernel (launched at " "@launch@), block (0,0,0): its 64 threads"
    "54 wait in __syncthreads() at " "@barrier@, first thread (10,0,0)" "10 have ended, first thread (0,0,0)")
add_diagnosis(different_barriers EXIT 0 EXPECT
    "barrier divergence in kernel branches_kernel (launched at " "block (0,0,0)"
    "32 wait in __syncthreads() at " "@even@, first thread (0,0,0)"
    "32 wait in __syncthreads() at " "@odd@, first thread (1,0,0)")
add_diagnosis(warp_divergence EXIT 0 EXPECT
    "barrier divergence in kernel half_warp_kernel (launched at "
    "16 wait in __syncthreads() at " "@barrier@, first thread (16,0,0)"
    "16 wait in __shfl_sync() with mask 0xffffffff at " "@shuffle@, first thread (0,0,0)")
add_diagnosis(wrong_mask EXIT 0 EXPECT
    "wrong mask: __shfl_sync() at " "@shuffle@: the mask does not contain the calling thread's own lane 16"
    "in kernel wrong_mask_kernel (launched at " "block (0,0,0), thread (16,0,0)")

# Memory that is not theirs: the sanitizer names the line, the simulator the thread.
add_diagnosis(out_of_bounds SANITIZE address EXIT fail EXPECT
    "AddressSanitizer: heap-buffer-overflow" "no_bounds_check_kernel" "@write@"
    "cudasim: the error above happened in kernel no_bounds_check_kernel (launched at "
    "@launch@), block (3,0,0), thread (232,0,0)")
add_diagnosis(out_of_bounds_after_barrier SANITIZE address EXIT fail EXPECT
    "AddressSanitizer: heap-buffer-overflow" "@write@" "kernel write_after_barrier_kernel (launched at "
    "block (3,0,0), thread (232,0,0)")
add_diagnosis(shared_out_of_bounds SANITIZE address EXIT fail EXPECT
    "AddressSanitizer: use-after-poison" "@read@" "kernel shared_overrun_kernel (launched at "
    "block (0,0,0), thread (63,0,0)")
add_diagnosis(shared_index SANITIZE address EXIT fail EXPECT
    "undefined behaviour in kernel shared_index_kernel (launched at " "block (0,0,0), thread (63,0,0)"
    "@read@" "index 64 out of bounds for type 'float [64]'")
add_diagnosis(dynamic_shared_out_of_bounds SANITIZE address EXIT fail EXPECT
    "AddressSanitizer: use-after-poison" "@write@" "kernel dynamic_overrun_kernel (launched at "
    "block (0,0,0), thread (32,0,0)")
add_diagnosis(device_pointer_on_host SANITIZE address EXIT fail EXPECT
    "AddressSanitizer: use-after-poison" "@read@"
    "cudasim: the error above: host code touched device memory, the 256 bytes allocated at " "@allocation@"
    "copy with cudaMemcpy")

# The same in the default build: no line, and the thread only where it is known.
add_diagnosis(dynamic_shared_out_of_bounds_by_default PROGRAM dynamic_shared_out_of_bounds EXIT fail EXPECT
    "cudasim: crash in kernel dynamic_overrun_kernel (launched at " "@launch@), block (0,0,0)\n"
    "behind the end of its dynamic shared memory, 128 bytes as given in the launch")
add_diagnosis(null_pointer PROGRAM crash ARGUMENT 0 EXIT fail EXPECT
    "cudasim: crash in kernel null_kernel (launched at " "@null@), block (1,0,0)\n"
    "a null pointer" "the asan preset names the thread and the line")
add_diagnosis(far_out_of_bounds PROGRAM crash ARGUMENT 1 EXIT fail EXPECT
    "crash in kernel far_out_kernel (launched at " "block (4,0,0)\n"
    "0 bytes behind the end of the 4096 bytes allocated at " "@allocation@")
add_diagnosis(deep_recursion PROGRAM crash ARGUMENT 2 EXIT fail EXPECT
    "crash in kernel deep_kernel (launched at " "block (0,0,0)\n" "stack is full")
add_diagnosis(failed_assert PROGRAM crash ARGUMENT 3 EXIT fail EXPECT
    "threadIdx.x < 7" "crash in kernel assert_kernel (launched at " "thread (7,0,0)")
add_diagnosis(division_by_zero PROGRAM crash ARGUMENT 4 EXIT fail EXPECT
    "crash in kernel divide_kernel (launched at " "divided by zero")
add_diagnosis(use_after_free PROGRAM crash ARGUMENT 5 EXIT fail EXPECT
    "crash in kernel freed_kernel (launched at " "block (0,0,0)" "may not")
add_diagnosis(crash_after_barrier PROGRAM crash ARGUMENT 6 EXIT fail EXPECT
    "crash in kernel late_kernel (launched at " "block (0,0,0), thread (9,0,0)\n" "a null pointer")
add_diagnosis(host_pointer EXIT 0 EXPECT
    "cannot launch kernel host_pointer_kernel (launched at " "@launch@): argument 2 points to no device memory")

add_diagnosis(launch_in_kernel EXIT fail EXPECT
    "a kernel launch was called by a kernel; only host code may"
    "in kernel outer_kernel (launched at " "@launch@), block (2,0,0), thread (7,0,0)")

# Races.
add_diagnosis(race_between_blocks SANITIZE thread EXIT fail ENVIRONMENT CUDASIM_THREADS=4 EXPECT
    "WARNING: ThreadSanitizer: data race" "racing_count_kernel" "@race@"
    "the data race above was found in kernel racing_count_kernel (launched at " "@launch@), block (" "), thread (")
add_diagnosis(no_race SANITIZE thread EXIT 0 ENVIRONMENT CUDASIM_THREADS=4 EXPECT "counted 19200")
add_diagnosis(race_within_block EXIT 0 ENVIRONMENT CUDASIM_RACECHECK=1 EXPECT
    "the result of kernel no_barrier_kernel (launched at " "@launch@) depends on the order of its threads"
    "word 0 (4 bytes each) of the 256 bytes allocated at " "@allocation@ is" "in forward order" "in reverse order")

# What is left at the end.
add_diagnosis(leak EXIT 3 EXPECT
    "cudasim: 4024 bytes of device memory leaked, in 2 allocations that were never freed"
    "bytes allocated at ")
add_diagnosis(leak_exit PROGRAM leak ENVIRONMENT CUDASIM_LEAK_EXIT=23 EXIT 23 EXPECT "4024 bytes of device memory leaked")
add_diagnosis(unchecked_error EXIT 0 EXPECT
    "cannot launch kernel never_kernel (launched at " "@launch@): the block (1025,1,1) is larger than (1024,1024,64)"
    "nobody asked for the error of kernel never_kernel (launched at "
    "@launch@): cudaErrorInvalidConfiguration (invalid configuration argument)" "and of 1 more launches")
add_diagnosis(bad_order PROGRAM leak ENVIRONMENT CUDASIM_ORDER=backwards EXIT 2 EXPECT
    "CUDASIM_ORDER is 'backwards', but it must be forward, reverse, shuffled or shuffled:seed")
add_diagnosis(bad_threads PROGRAM unchecked_error ENVIRONMENT CUDASIM_THREADS=0 EXIT 2 EXPECT
    "CUDASIM_THREADS is '0', but it must be a number from 1 to 1024")
