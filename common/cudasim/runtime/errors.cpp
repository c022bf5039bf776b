// Error codes and their texts, and the error that waits to be asked for.
#include <cuda_runtime.h>

#include "runtime/errors.h"
#include "runtime/report.h"

namespace {

struct ErrorText {
    cudaError_t code;
    const char *name, *text;
};

// CUDA's names and texts.
constexpr ErrorText kErrorTexts[] = {
    {cudaSuccess, "cudaSuccess", "no error"},
    {cudaErrorInvalidValue, "cudaErrorInvalidValue", "invalid argument"},
    {cudaErrorMemoryAllocation, "cudaErrorMemoryAllocation", "out of memory"},
    {cudaErrorInvalidConfiguration, "cudaErrorInvalidConfiguration", "invalid configuration argument"},
    {cudaErrorInvalidSymbol, "cudaErrorInvalidSymbol", "invalid device symbol"},
    {cudaErrorInvalidMemcpyDirection, "cudaErrorInvalidMemcpyDirection", "invalid copy direction for memcpy"},
    {cudaErrorInsufficientDriver, "cudaErrorInsufficientDriver",
     "CUDA driver version is insufficient for CUDA runtime version"},
    {cudaErrorNoDevice, "cudaErrorNoDevice", "no CUDA-capable device is detected"},
    {cudaErrorInvalidDevice, "cudaErrorInvalidDevice", "invalid device ordinal"},
    {cudaErrorInvalidGraphicsContext, "cudaErrorInvalidGraphicsContext", "invalid OpenGL or DirectX context"},
    {cudaErrorInvalidResourceHandle, "cudaErrorInvalidResourceHandle", "invalid resource handle"},
    {cudaErrorNotReady, "cudaErrorNotReady", "device not ready"},
    {cudaErrorIllegalAddress, "cudaErrorIllegalAddress", "an illegal memory access was encountered"},
    {cudaErrorLaunchFailure, "cudaErrorLaunchFailure", "unspecified launch failure"},
    {cudaErrorNotSupported, "cudaErrorNotSupported", "operation not supported"},
    {cudaErrorUnknown, "cudaErrorUnknown", "unknown error"},
};

const ErrorText* find(cudaError_t code) {
    for (const ErrorText& error : kErrorTexts)
        if (error.code == code) return &error;
    return nullptr;
}

// One for each host thread, as in CUDA.
thread_local cudaError_t last_error = cudaSuccess;
thread_local cudaError_t kernel_fault = cudaSuccess;

// Launches that failed while nobody has asked for the error. (Plain data: it is read when statics are gone.)
unsigned unseen_launches = 0;
cudasim::LaunchRequest first_unseen{};
cudaError_t first_unseen_error = cudaSuccess;

void see_launch_errors() {
    unseen_launches = 0;
}

__attribute__((destructor)) void report_unseen_launches() {
    if (unseen_launches == 0) return;
    const std::string more =
        unseen_launches > 1 ? "\nand of " + std::to_string(unseen_launches - 1) + " more launches" : "";
    cudasim::say("nobody asked for the error of " + cudasim::text_of(first_unseen) + ": " +
                 cudaGetErrorName(first_unseen_error) + " (" + cudaGetErrorString(first_unseen_error) + ")" +
                 more + "\na launch returns nothing: call cudaGetLastError() after it");
}

}  // namespace

namespace cudasim {

cudaError_t set_last_error(cudaError_t error) {
    if (error != cudaSuccess) last_error = error;
    return error;
}

void set_launch_error(const LaunchRequest& request, cudaError_t error) {
    last_error = error;
    if (error == cudaErrorLaunchFailure || error == cudaErrorIllegalAddress) kernel_fault = error;
    if (unseen_launches++ > 0) return;
    first_unseen = request;
    first_unseen_error = error;
}

cudaError_t take_kernel_fault() {
    const cudaError_t fault = kernel_fault;
    if (fault != cudaSuccess) see_launch_errors();
    kernel_fault = cudaSuccess;
    return fault;
}

cudaError_t refuse(cudaError_t error, const char* call, const char* file, int line, const std::string& why) {
    say(std::string(call) + " at " + text_of(file, line) + ": " + why);
    return set_last_error(error);
}

}  // namespace cudasim

const char* cudaGetErrorName(cudaError_t error) {
    const ErrorText* found = find(error);
    return found ? found->name : "unrecognized error code";
}

const char* cudaGetErrorString(cudaError_t error) {
    const ErrorText* found = find(error);
    return found ? found->text : "unrecognized error code";
}

cudaError_t cudaPeekAtLastError() {
    see_launch_errors();
    return last_error;
}

cudaError_t cudaGetLastError() {
    const cudaError_t error = cudaPeekAtLastError();
    last_error = kernel_fault = cudaSuccess;
    return error;
}
