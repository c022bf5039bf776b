/// @file
/// Calls that CUDA courses often use and the simulator does not have: using one is a compile error that says
/// what to do instead. What is not named here does not exist at all.
#pragma once
#include "cudasim/errors.h"
#include "cudasim/keywords.h"

#define CUDASIM_NOT_HERE(function, advice)                                  \
    template <class... Arguments>                                           \
    CUDASIM_UNSUPPORTED("the CUDA simulator has no " #function ": " advice) \
    cudaError_t function(Arguments...)

CUDASIM_NOT_HERE(cudaMallocManaged, "use cudaMalloc and cudaMemcpy");
CUDASIM_NOT_HERE(cudaMemPrefetchAsync, "it belongs to managed memory; use cudaMalloc and cudaMemcpy");
CUDASIM_NOT_HERE(cudaMallocAsync, "use cudaMalloc");
CUDASIM_NOT_HERE(cudaFreeAsync, "use cudaFree");
CUDASIM_NOT_HERE(cudaMallocPitch, "use cudaMalloc and compute row * width + column");
CUDASIM_NOT_HERE(cudaMemcpy2D, "use cudaMemcpy, one row at a time or all in one piece");
CUDASIM_NOT_HERE(cudaMalloc3D, "use cudaMalloc and compute the index");
CUDASIM_NOT_HERE(cudaMallocArray, "it belongs to textures; use cudaMalloc");
CUDASIM_NOT_HERE(cudaCreateTextureObject, "read from an array instead");
CUDASIM_NOT_HERE(cudaHostAlloc, "use cudaMallocHost");
CUDASIM_NOT_HERE(cudaHostRegister, "use cudaMallocHost");
CUDASIM_NOT_HERE(cudaMemcpyPeer, "there is one device");
CUDASIM_NOT_HERE(cudaStreamBeginCapture, "it has no graphs; launch the kernels one by one");
CUDASIM_NOT_HERE(cudaGraphCreate, "it has no graphs; launch the kernels one by one");
CUDASIM_NOT_HERE(cudaGraphLaunch, "it has no graphs; launch the kernels one by one");
CUDASIM_NOT_HERE(cudaStreamAddCallback, "streams end with the call; call the function after it");
CUDASIM_NOT_HERE(cudaLaunchHostFunc, "streams end with the call; call the function after it");
CUDASIM_NOT_HERE(cudaLaunchKernel, "use kernel<<<grid, block>>>(arguments)");
CUDASIM_NOT_HERE(cudaLaunchCooperativeKernel,
                 "end the kernel and launch the next: that is a barrier of the grid");
CUDASIM_NOT_HERE(cudaFuncSetAttribute, "a block has 48 KiB of shared memory");
CUDASIM_NOT_HERE(cudaFuncGetAttributes, "registers and occupancy exist on a GPU only");
CUDASIM_NOT_HERE(cudaOccupancyMaxPotentialBlockSize,
                 "occupancy exists on a GPU only; choose 128 or 256 threads");
CUDASIM_NOT_HERE(cudaOccupancyMaxActiveBlocksPerMultiprocessor, "occupancy exists on a GPU only");
CUDASIM_NOT_HERE(cudaDeviceGetAttribute, "use cudaGetDeviceProperties");
CUDASIM_NOT_HERE(cudaPointerGetAttributes, "remember what you allocated where");
CUDASIM_NOT_HERE(__activemask,
                 "it tells which lanes happen to run together; say which you mean, as __ballot_sync does");
CUDASIM_NOT_HERE(__match_any_sync, "use __ballot_sync and __shfl_sync");
CUDASIM_NOT_HERE(__match_all_sync, "use __ballot_sync and __shfl_sync");
CUDASIM_NOT_HERE(__shfl, "it was removed from CUDA; use __shfl_sync(mask, ...)");
CUDASIM_NOT_HERE(__shfl_down, "it was removed from CUDA; use __shfl_down_sync(mask, ...)");
CUDASIM_NOT_HERE(__shfl_up, "it was removed from CUDA; use __shfl_up_sync(mask, ...)");
CUDASIM_NOT_HERE(__shfl_xor, "it was removed from CUDA; use __shfl_xor_sync(mask, ...)");
CUDASIM_NOT_HERE(__ballot, "it was removed from CUDA; use __ballot_sync(mask, predicate)");
CUDASIM_NOT_HERE(clock64, "cycles of a CPU say nothing about a GPU; take events");
CUDASIM_NOT_HERE(__nanosleep, "threads of a block take turns, so waiting for another one never ends");

#undef CUDASIM_NOT_HERE
