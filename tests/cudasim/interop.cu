// CUDA and OpenGL on one buffer object: what a kernel writes is in the buffer, and misuse has its error
// codes.
#include <GL/glew.h>

#include <cuda_gl_interop.h>

#include <cmath>
#include <memory>
#include <vector>

#include "common/cuda_check.h"
#include "common/gl_context.h"
#include "tests/cudasim/simulator.h"
#include "tests/support/course_test.h"

namespace {

constexpr int kCount = 1000;

__global__ void ramp_kernel(float* values, int n, float slope) {
    const int i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i < n) values[i] = slope * i;
}
__global__ void add_one_kernel(float* values, int n) {
    const int i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i < n) values[i] += 1;
}

std::unique_ptr<course::GlContext> context_or_skip() {
    try {
        return course::make_headless_context();
    } catch (const course::NoOpenGl& why) {
        course::skip(why.what());
    }
}

/// A buffer object with `kCount` values of 7.
GLuint make_buffer() {
    const std::vector<float> sevens(kCount, 7.0f);
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, kCount * sizeof(float), sevens.data(), GL_DYNAMIC_DRAW);
    return buffer;
}

std::vector<float> contents(GLuint buffer) {
    std::vector<float> values(kCount);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glGetBufferSubData(GL_ARRAY_BUFFER, 0, kCount * sizeof(float), values.data());
    return values;
}

std::vector<float> ramp(float slope, float offset) {
    std::vector<float> values(kCount);
    for (int i = 0; i < kCount; ++i) values[i] = slope * i + offset;
    return values;
}

float* map(cudaGraphicsResource_t& resource) {
    CUDA_CHECK(cudaGraphicsMapResources(1, &resource));
    void* pointer = nullptr;
    std::size_t bytes = 0;
    CUDA_CHECK(cudaGraphicsResourceGetMappedPointer(&pointer, &bytes, resource));
    CHECK(bytes == kCount * sizeof(float));
    return static_cast<float*>(pointer);
}

}  // namespace

TEST_CASE("interop: a kernel writes a buffer object and reads what OpenGL put there") {
    const auto context = context_or_skip();
    const GLuint buffer = make_buffer();
    cudaGraphicsResource_t resource = nullptr;
    CUDA_CHECK(cudaGraphicsGLRegisterBuffer(&resource, buffer, cudaGraphicsRegisterFlagsNone));
    add_one_kernel<<<4, 256>>>(map(resource), kCount);
    CUDA_CHECK(cudaGraphicsUnmapResources(1, &resource));
    course::check_equal(contents(buffer), ramp(0, 8), "value", "element");

    CUDA_CHECK(cudaGraphicsResourceSetMapFlags(resource, cudaGraphicsMapFlagsWriteDiscard));
    ramp_kernel<<<4, 256>>>(map(resource), kCount, 0.5f);
    CUDA_CHECK(cudaGetLastError());
    CUDA_CHECK(cudaGraphicsUnmapResources(1, &resource));
    course::check_equal(contents(buffer), ramp(0.5f, 0), "value", "element");

    CUDA_CHECK(cudaGraphicsUnregisterResource(resource));
    glDeleteBuffers(1, &buffer);
}

TEST_CASE("interop: copies to and from a mapped buffer are checked") {
    const auto context = context_or_skip();
    const GLuint buffer = make_buffer();
    cudaGraphicsResource_t resource = nullptr;
    CUDA_CHECK(cudaGraphicsGLRegisterBuffer(&resource, buffer, cudaGraphicsRegisterFlagsNone));
    float* const mapped = map(resource);
    std::vector<float> host(kCount + 1);
    CUDA_CHECK(cudaMemcpy(host.data(), mapped, kCount * sizeof(float), cudaMemcpyDeviceToHost));
    CHECK(host[kCount - 1] == 7.0f);
    CHECK(cudaMemcpy(mapped, host.data(), (kCount + 1) * sizeof(float), cudaMemcpyHostToDevice) ==
          cudaErrorInvalidValue);
    CUDA_CHECK(cudaGraphicsUnmapResources(1, &resource));
    CUDA_CHECK(cudaGraphicsUnregisterResource(resource));
    cudaGetLastError();
    glDeleteBuffers(1, &buffer);
}

TEST_CASE("interop: misuse is an error") {
    const auto context = context_or_skip();
    const GLuint buffer = make_buffer();
    cudaGraphicsResource_t resource = nullptr;
    void* pointer = nullptr;
    std::size_t bytes = 0;
    CHECK(cudaGraphicsGLRegisterBuffer(&resource, buffer + 1000, cudaGraphicsRegisterFlagsNone) !=
          cudaSuccess);
    CUDA_CHECK(cudaGraphicsGLRegisterBuffer(&resource, buffer, cudaGraphicsRegisterFlagsNone));
    CHECK(cudaGraphicsResourceGetMappedPointer(&pointer, &bytes, resource) != cudaSuccess);  // not mapped
    CHECK(cudaGraphicsUnmapResources(1, &resource) != cudaSuccess);                          // not mapped
    CUDA_CHECK(cudaGraphicsMapResources(1, &resource));
    CHECK(cudaGraphicsMapResources(1, &resource) != cudaSuccess);  // mapped already
    CUDA_CHECK(cudaGraphicsUnmapResources(1, &resource));
    CUDA_CHECK(cudaGraphicsUnregisterResource(resource));
    cudaGetLastError();
    glDeleteBuffers(1, &buffer);
}

#ifdef __CUDASIM__
TEST_CASE("interop: without a context there is nothing to register") {
    cudaGraphicsResource_t resource = nullptr;
    CHECK(cudaGraphicsGLRegisterBuffer(&resource, 1, cudaGraphicsRegisterFlagsNone) ==
          cudaErrorInvalidGraphicsContext);
    CHECK(resource == nullptr);
    {
        const auto context = context_or_skip();
        const GLuint buffer = make_buffer();
        CUDA_CHECK(cudaGraphicsGLRegisterBuffer(&resource, buffer, cudaGraphicsRegisterFlagsNone));
    }  // the functions are loaded now, but the context is gone
    CHECK(cudaGraphicsMapResources(1, &resource) == cudaErrorInvalidGraphicsContext);
    CUDA_CHECK(cudaGraphicsUnregisterResource(resource));
    cudaGetLastError();
}

TEST_CASE("interop: a buffer mapped to be overwritten holds no numbers before") {
    const auto context = context_or_skip();
    const GLuint buffer = make_buffer();
    cudaGraphicsResource_t resource = nullptr;
    CUDA_CHECK(cudaGraphicsGLRegisterBuffer(&resource, buffer, cudaGraphicsRegisterFlagsWriteDiscard));
    const float* const mapped = map(resource);
    CHECK(std::isnan(mapped[0]));
    CHECK(std::isnan(mapped[kCount - 1]));
    CUDA_CHECK(cudaGraphicsUnmapResources(1, &resource));
    CUDA_CHECK(cudaGraphicsUnregisterResource(resource));
    glDeleteBuffers(1, &buffer);
}
#endif
