/// @file
/// CUDA and OpenGL on the same buffer. Mapping a resource maps the real buffer object into memory, where
/// simulated kernels write to it. The calling thread must have a current context whose functions GLEW has
/// loaded. Codes are those that CUDA's documentation names; a line on stderr says more.
#pragma once
#include <GL/glew.h>
#include <cuda_runtime.h>

#include "cudasim/graphics_memory.h"

enum cudaGraphicsRegisterFlags {
    cudaGraphicsRegisterFlagsNone = 0,
    cudaGraphicsRegisterFlagsReadOnly = 1,
    cudaGraphicsRegisterFlagsWriteDiscard = 2,
};
enum cudaGraphicsMapFlags {
    cudaGraphicsMapFlagsNone = 0,
    cudaGraphicsMapFlagsReadOnly = 1,
    cudaGraphicsMapFlagsWriteDiscard = 2,
};

struct cudaGraphicsResource {
    GLuint buffer;
    unsigned flags;
    std::size_t bytes;
    void* mapped;  ///< nullptr: not mapped
};
using cudaGraphicsResource_t = cudaGraphicsResource*;

namespace cudasim {

inline bool has_gl_context() {
    return __glewMapBufferRange && glGetString(GL_VERSION);
}

/// Binds a buffer for a moment, where it disturbs nobody.
class BoundBuffer {
  public:
    explicit BoundBuffer(GLuint buffer) {
        glGetIntegerv(GL_COPY_WRITE_BUFFER_BINDING, &before_);
        glBindBuffer(GL_COPY_WRITE_BUFFER, buffer);
    }
    ~BoundBuffer() { glBindBuffer(GL_COPY_WRITE_BUFFER, static_cast<GLuint>(before_)); }
    BoundBuffer(const BoundBuffer&) = delete;
    BoundBuffer& operator=(const BoundBuffer&) = delete;

    std::size_t bytes() const {
        GLint64 size = 0;
        glGetBufferParameteri64v(GL_COPY_WRITE_BUFFER, GL_BUFFER_SIZE, &size);
        return static_cast<std::size_t>(size);
    }
    void* map(std::size_t bytes, bool read_only) const {
        const GLbitfield access = read_only ? GL_MAP_READ_BIT : GL_MAP_READ_BIT | GL_MAP_WRITE_BIT;
        return glMapBufferRange(GL_COPY_WRITE_BUFFER, 0, static_cast<GLsizeiptr>(bytes), access);
    }
    bool unmap() const { return glUnmapBuffer(GL_COPY_WRITE_BUFFER) == GL_TRUE; }

  private:
    GLint before_ = 0;
};

inline cudaError_t map_resource(cudaGraphicsResource& resource) {
    constexpr const char* kCall = "cudaGraphicsMapResources";
    if (!has_gl_context())
        return refuse_graphics(cudaErrorInvalidGraphicsContext, kCall, "no OpenGL context");
    if (resource.mapped) return refuse_graphics(cudaErrorUnknown, kCall, "the resource is mapped already");
    const BoundBuffer bound(resource.buffer);
    // It may have got another size since it was registered.
    resource.bytes = bound.bytes();
    resource.mapped = bound.map(resource.bytes, resource.flags == cudaGraphicsMapFlagsReadOnly);
    if (!resource.mapped) return refuse_graphics(cudaErrorUnknown, kCall, "OpenGL cannot map the buffer");
    add_graphics_memory(resource.mapped, resource.bytes, resource.flags == cudaGraphicsMapFlagsWriteDiscard);
    return cudaSuccess;
}

inline cudaError_t unmap_resource(cudaGraphicsResource& resource) {
    constexpr const char* kCall = "cudaGraphicsUnmapResources";
    if (!has_gl_context())
        return refuse_graphics(cudaErrorInvalidGraphicsContext, kCall, "no OpenGL context");
    if (!resource.mapped) return refuse_graphics(cudaErrorUnknown, kCall, "the resource is not mapped");
    remove_graphics_memory(resource.mapped);
    resource.mapped = nullptr;
    if (!BoundBuffer(resource.buffer).unmap())
        return refuse_graphics(cudaErrorUnknown, kCall, "OpenGL lost the buffer's contents");
    return cudaSuccess;
}

}  // namespace cudasim

inline cudaError_t cudaGraphicsGLRegisterBuffer(cudaGraphicsResource** resource, GLuint buffer,
                                                unsigned flags) {
    constexpr const char* kCall = "cudaGraphicsGLRegisterBuffer";
    if (!resource)
        return cudasim::refuse_graphics(cudaErrorInvalidValue, kCall, "nowhere to put the resource");
    *resource = nullptr;
    if (!cudasim::has_gl_context())
        return cudasim::refuse_graphics(
            cudaErrorInvalidGraphicsContext, kCall,
            "the calling thread has no OpenGL context, or glewInit() was not called");
    if (!glIsBuffer(buffer))
        return cudasim::refuse_graphics(cudaErrorInvalidValue, kCall, "there is no such OpenGL buffer");
    if (flags > cudaGraphicsRegisterFlagsWriteDiscard)
        return cudasim::refuse_graphics(cudaErrorInvalidValue, kCall, "unknown flags");
    *resource = new cudaGraphicsResource{buffer, flags, 0, nullptr};
    return cudaSuccess;
}

inline cudaError_t cudaGraphicsResourceSetMapFlags(cudaGraphicsResource_t resource, unsigned flags) {
    if (!resource) return cudasim::set_last_error(cudaErrorInvalidResourceHandle);
    if (flags > cudaGraphicsMapFlagsWriteDiscard) return cudasim::set_last_error(cudaErrorInvalidValue);
    resource->flags = flags;
    return cudaSuccess;
}

inline cudaError_t cudaGraphicsMapResources(int count, cudaGraphicsResource_t* resources,
                                            cudaStream_t = nullptr) {
    for (int i = 0; i < count; ++i) {
        if (!resources[i]) return cudasim::set_last_error(cudaErrorInvalidResourceHandle);
        if (const cudaError_t error = cudasim::map_resource(*resources[i])) return error;
    }
    return cudaSuccess;
}

inline cudaError_t cudaGraphicsUnmapResources(int count, cudaGraphicsResource_t* resources,
                                              cudaStream_t = nullptr) {
    for (int i = 0; i < count; ++i) {
        if (!resources[i]) return cudasim::set_last_error(cudaErrorInvalidResourceHandle);
        if (const cudaError_t error = cudasim::unmap_resource(*resources[i])) return error;
    }
    return cudaSuccess;
}

/// The address that kernels use while the resource is mapped, and how many bytes are there.
inline cudaError_t cudaGraphicsResourceGetMappedPointer(void** pointer, std::size_t* bytes,
                                                        cudaGraphicsResource_t resource) {
    constexpr const char* kCall = "cudaGraphicsResourceGetMappedPointer";
    if (!resource) return cudasim::set_last_error(cudaErrorInvalidResourceHandle);
    if (!resource->mapped)
        return cudasim::refuse_graphics(cudaErrorUnknown, kCall, "the resource is not mapped");
    if (pointer) *pointer = resource->mapped;
    if (bytes) *bytes = resource->bytes;
    return cudaSuccess;
}

inline cudaError_t cudaGraphicsUnregisterResource(cudaGraphicsResource_t resource) {
    if (!resource) return cudasim::set_last_error(cudaErrorInvalidResourceHandle);
    const cudaError_t error = resource->mapped ? cudasim::unmap_resource(*resource) : cudaSuccess;
    delete resource;
    return error;
}
