# Kernels on a GPU or on the CPU: one function for both.
#
#   COURSE_CUDA=AUTO|ON|OFF   AUTO: nvcc when a CUDA device answers, else the CUDA simulator (common/cudasim).
#                             ON: nvcc, device or not. OFF: the simulator; no CUDA file is looked for.
#   COURSE_SANITIZE=address|thread   simulator only: build everything with AddressSanitizer or ThreadSanitizer.
#   COURSE_USE_CUDA           the answer: TRUE for nvcc, FALSE for the simulator.
#
#   course_target(<target> SOURCES a.cu b.cpp ... [INCLUDE_DIRS dir...] [HEADERS file.cuh...]
#                 [SANITIZE address|thread] [COUNT_ACCESSES])
#
# takes an existing executable or library, adds the sources, the include roots (the repository and chapters/) and
# links `course_cuda`. .cu files are CUDA for nvcc, and for the simulator C++ that common/cudasim/rewrite.cpp
# makes from them. In a simulator build
#   INCLUDE_DIRS  are searched before everything else, and the .cuh files in them are rewritten too;
#   HEADERS       names the files to be rewritten in folders outside of the tree, where another command makes them;
#   SANITIZE      builds this one target, and the simulator it links, with a sanitizer (nvcc: no effect);
#   COUNT_ACCESSES builds this one target so that the simulator counts its kernels' loads, stores and atomics
#                 (cudasim::Counts; no effect with nvcc, Clang or a sanitizer). Slow: nothing is optimised, so that
#                 what is counted is what the source says.

set(COURSE_CUDA AUTO CACHE STRING "AUTO (nvcc when a CUDA device answers, else the simulator), ON or OFF")
set_property(CACHE COURSE_CUDA PROPERTY STRINGS AUTO ON OFF)
set(COURSE_SANITIZE "" CACHE STRING "Simulator only: address, thread or nothing")
set_property(CACHE COURSE_SANITIZE PROPERTY STRINGS "" address thread)

# ---- GPU or simulator? ------------------------------------------------------------------------------------------

# Does a CUDA device answer? nvcc alone says nothing: it is often installed on machines that have no GPU.
function(course_cuda_device_answers result)
    set(program ${CMAKE_BINARY_DIR}/CMakeFiles/course_device_count)
    execute_process(COMMAND ${CMAKE_CUDA_COMPILER} -o ${program}
            ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/device_count.cu OUTPUT_QUIET ERROR_QUIET RESULT_VARIABLE status)
    if(status EQUAL 0)
        execute_process(COMMAND ${program} OUTPUT_QUIET ERROR_QUIET RESULT_VARIABLE status)
    endif()
    if(status EQUAL 0)
        set(${result} TRUE PARENT_SCOPE)
    else()
        set(${result} FALSE PARENT_SCOPE)
    endif()
endfunction()

string(TOUPPER "${COURSE_CUDA}" course_cuda_wish)
if(NOT course_cuda_wish MATCHES "^(AUTO|ON|OFF)$")
    message(FATAL_ERROR "COURSE_CUDA is '${COURSE_CUDA}': it must be AUTO, ON or OFF")
endif()
if(NOT COURSE_SANITIZE MATCHES "^(|address|thread)$")
    message(FATAL_ERROR "COURSE_SANITIZE is '${COURSE_SANITIZE}': it must be address, thread or empty")
endif()

set(COURSE_USE_CUDA FALSE)
if(NOT course_cuda_wish STREQUAL "OFF")
    if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES)
        set(CMAKE_CUDA_ARCHITECTURES "75;90" CACHE STRING "GPUs to compile for (native: the one in this machine)")
    endif()
    include(CheckLanguage)
    check_language(CUDA)
    if(course_cuda_wish STREQUAL "ON")
        if(NOT CMAKE_CUDA_COMPILER)
            message(FATAL_ERROR "COURSE_CUDA=ON, but no nvcc was found. Install the CUDA Toolkit or use COURSE_CUDA=OFF")
        endif()
        set(COURSE_USE_CUDA TRUE)
    elseif(CMAKE_CUDA_COMPILER)
        if(NOT DEFINED COURSE_DEVICE_ANSWERS)
            course_cuda_device_answers(answers)
            set(COURSE_DEVICE_ANSWERS ${answers} CACHE INTERNAL "a CUDA device answered when CMake first ran")
        endif()
        set(COURSE_USE_CUDA ${COURSE_DEVICE_ANSWERS})
    endif()
endif()
if(COURSE_USE_CUDA AND COURSE_SANITIZE)
    message(FATAL_ERROR "COURSE_SANITIZE works in the simulator only: add -DCOURSE_CUDA=OFF")
endif()

# ---- nvcc -------------------------------------------------------------------------------------------------------

if(COURSE_USE_CUDA)
    enable_language(CUDA)
    set(CMAKE_CUDA_STANDARD 17)
    set(CMAKE_CUDA_STANDARD_REQUIRED ON)
    find_package(CUDAToolkit REQUIRED)
    add_library(course_cuda INTERFACE)
    target_link_libraries(course_cuda INTERFACE CUDA::cudart_static)
    # Two remarks of nvcc on what is meant: 20012, GLM marks defaulted functions __host__ __device__; 20050, kernels
    # in headers are inline, so that a program may include them in several files.
    # Relaxed constexpr: kernels call the constexpr functions of plain C++ headers (chapter 01's physics).
    target_compile_options(course_cuda INTERFACE
        $<$<COMPILE_LANGUAGE:CUDA>:-diag-suppress=20012 --expt-relaxed-constexpr>)

    function(course_target target)
        cmake_parse_arguments(arg "COUNT_ACCESSES" "SANITIZE" "SOURCES;INCLUDE_DIRS;HEADERS" ${ARGN})
        target_sources(${target} PRIVATE ${arg_SOURCES})
        target_include_directories(${target} PRIVATE ${arg_INCLUDE_DIRS} ${CMAKE_SOURCE_DIR}
            ${CMAKE_SOURCE_DIR}/chapters)
        target_link_libraries(${target} PRIVATE course_cuda)
    endfunction()
    return()
endif()

# ---- the simulator ----------------------------------------------------------------------------------------------
# All .cu and .cuh files of the tree are rewritten into a mirror of the tree. The mirror comes first in the include
# path, so `#include "05_spatial_grid/grid.cuh"` finds the rewritten copy. One command a file: an edited header
# is rewritten alone, and the compiler's dependency files rebuild what includes it.

# COUNT_ACCESSES leans on how GCC compiles; Clang copies structures in ways that its hooks don't see.
set(COURSE_CAN_COUNT FALSE)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND NOT COURSE_SANITIZE)
    set(COURSE_CAN_COUNT TRUE)
endif()

set(COURSE_MIRROR ${CMAKE_BINARY_DIR}/cudasim_src)

# Rewrites `source` to `copy`. Call once for each copy.
function(course_rewrite source copy)
    file(RELATIVE_PATH name ${CMAKE_SOURCE_DIR} ${source})
    add_custom_command(OUTPUT ${copy} COMMAND cudasim_rewrite ${source} ${copy} DEPENDS ${source} cudasim_rewrite
        COMMENT "Rewriting ${name}" VERBATIM)
endfunction()

file(GLOB_RECURSE course_cuda_files CONFIGURE_DEPENDS RELATIVE ${CMAKE_SOURCE_DIR}
    chapters/*.cu chapters/*.cuh common/*.cu common/*.cuh solutions/*.cuh exercises/*.cuh tests/*.cu tests/*.cuh)
list(FILTER course_cuda_files EXCLUDE REGEX "^common/cmake/")  # a program for CMake alone
set(course_mirrored "")
foreach(file IN LISTS course_cuda_files)
    string(REGEX REPLACE "[.]cu$" ".cu.cpp" copy ${COURSE_MIRROR}/${file})
    course_rewrite(${CMAKE_SOURCE_DIR}/${file} ${copy})
    list(APPEND course_mirrored ${copy})
endforeach()
add_custom_target(course_mirror DEPENDS ${course_mirrored})

# Copies of files that are gone: an #include must not find them any longer.
file(GLOB_RECURSE course_copies ${COURSE_MIRROR}/*)
foreach(copy IN LISTS course_copies)
    if(NOT copy MATCHES "/cudasim_src/elsewhere/" AND NOT copy IN_LIST course_mirrored)
        file(REMOVE ${copy})
    endif()
endforeach()

# Where the rewritten copy of a file or folder goes: the mirror, or for files from elsewhere a folder of the target's.
function(course_mirror_path result path target)
    file(RELATIVE_PATH relative ${CMAKE_SOURCE_DIR} ${path})
    if(relative MATCHES "^(chapters|common|solutions|exercises|tests)/")
        set(${result} ${COURSE_MIRROR}/${relative} PARENT_SCOPE)
    else()
        string(MD5 key ${path})
        string(SUBSTRING ${key} 0 8 key)
        get_filename_component(name ${path} NAME)
        set(${result} ${COURSE_MIRROR}/elsewhere/${target}/${key}/${name} PARENT_SCOPE)
    endif()
endfunction()

function(course_target target)
    cmake_parse_arguments(arg "COUNT_ACCESSES" "SANITIZE" "SOURCES;INCLUDE_DIRS;HEADERS" ${ARGN})
    set(include_dirs "")
    set(copies "")
    foreach(dir IN LISTS arg_INCLUDE_DIRS)
        get_filename_component(dir ${dir} ABSOLUTE)
        course_mirror_path(mirror ${dir} ${target})
        list(APPEND include_dirs ${mirror} ${dir})
        if(NOT mirror MATCHES "/cudasim_src/elsewhere/")
            continue()  # part of the tree: its mirror exists already
        endif()
        set(headers ${arg_HEADERS})
        if(NOT headers)
            file(GLOB headers CONFIGURE_DEPENDS ${dir}/*.cuh)
        endif()
        foreach(header IN LISTS headers)
            get_filename_component(header ${header} ABSOLUTE)
            get_filename_component(folder ${header} DIRECTORY)
            get_filename_component(name ${header} NAME)
            if(folder STREQUAL dir)
                course_rewrite(${header} ${mirror}/${name})
                list(APPEND copies ${mirror}/${name})
            endif()
        endforeach()
    endforeach()

    foreach(source IN LISTS arg_SOURCES)
        get_filename_component(source ${source} ABSOLUTE)
        if(source MATCHES "[.]cu$")
            course_mirror_path(copy ${source} ${target})
            set(copy ${copy}.cpp)
            if(copy MATCHES "/cudasim_src/elsewhere/")
                course_rewrite(${source} ${copy})
            endif()
            # GENERATED: the command that makes it may belong to another directory.
            set_source_files_properties(${copy} PROPERTIES GENERATED TRUE)
            target_sources(${target} PRIVATE ${copy})
        else()
            target_sources(${target} PRIVATE ${source})
        endif()
    endforeach()
    target_sources(${target} PRIVATE ${copies})
    add_dependencies(${target} course_mirror)

    target_include_directories(${target} BEFORE PRIVATE ${include_dirs} ${COURSE_MIRROR} ${COURSE_MIRROR}/chapters
        ${CMAKE_SOURCE_DIR} ${CMAKE_SOURCE_DIR}/chapters)

    if(NOT arg_SANITIZE)
        set(arg_SANITIZE "${COURSE_SANITIZE}")
    endif()
    set_target_properties(${target} PROPERTIES COURSE_SANITIZE "${arg_SANITIZE}")
    if(arg_COUNT_ACCESSES AND NOT arg_SANITIZE AND COURSE_CAN_COUNT)
        # ThreadSanitizer's compiler half calls a function at each access; its library half is not linked, since the
        # simulator has these functions itself (runtime/access_hooks.cpp).
        set_target_properties(${target} PROPERTIES COURSE_COUNT_ACCESSES ON)
        target_compile_options(${target} PRIVATE -O0 -fsanitize=thread -Wno-tsan)
        target_compile_definitions(${target} PRIVATE CUDASIM_COUNT_ACCESSES)
    endif()
    target_link_libraries(${target} PRIVATE course_cuda)
endfunction()
