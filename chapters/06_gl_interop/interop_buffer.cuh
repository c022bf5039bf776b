/// @file
/// An array that CUDA writes and OpenGL draws: one piece of memory where the machine allows it, else two and
/// a copy through the host.
#pragma once
#include <cuda_runtime.h>
// GLEW comes before every other OpenGL header.
#include <GL/glew.h>

#include <cuda_gl_interop.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/cuda_check.h"
#include "common/device_buffer.h"
#include "common/gl_objects.h"

namespace interop {

/// How what CUDA wrote comes to OpenGL.
enum class Handover {
    shared,  ///< the OpenGL buffer is registered with CUDA: kernels write into it
    copied   ///< device memory, then host memory, then the OpenGL buffer
};

/// The CUDA call that registers an OpenGL buffer. A parameter, so that a test can pass one that fails.
using RegisterCall = cudaError_t (*)(cudaGraphicsResource**, GLuint, unsigned);
inline cudaError_t register_gl_buffer(cudaGraphicsResource** resource, GLuint buffer, unsigned flags) {
    return cudaGraphicsGLRegisterBuffer(resource, buffer, flags);
}

/// `size()` elements that belong either to CUDA (between map() and unmap()) or to OpenGL (the rest of the
/// time). Contents are kept from one to the other. Move is not needed, so it is not there.
template <class T>
class InteropBuffer {
  public:
    //! [register]
    /// Tries to share; if CUDA refuses, copies. handover() and why() tell what came of it.
    /// @throws BadInput if it is empty: neither CUDA nor OpenGL maps nothing
    explicit InteropBuffer(std::size_t size, Handover wanted = Handover::shared,
                           RegisterCall register_call = register_gl_buffer)
        : size_(size), buffer_(size * sizeof(T)) {
        if (size == 0) throw course::BadInput("a buffer of no elements can't be handed over");
        if (wanted == Handover::copied) {
            why_ = "asked for";
        } else {
            // FlagsNone: kernels read and write. (WriteDiscard: they write all and read nothing.)
            const cudaError_t error = register_call(&resource_, buffer_.id(), cudaGraphicsRegisterFlagsNone);
            if (error == cudaSuccess) return;
            cudaGetLastError();  // dealt with here: the next check is not to trip over it
            resource_ = nullptr;
            why_ = std::string("CUDA can't use this OpenGL's buffers: ") + cudaGetErrorName(error);
        }
        device_.emplace(size);
        host_.resize(size);
    }
    //! [register]
    InteropBuffer(const InteropBuffer&) = delete;
    InteropBuffer& operator=(const InteropBuffer&) = delete;
    ~InteropBuffer() {
        if (!resource_) return;
        if (mapped_) cudaGraphicsUnmapResources(1, &resource_);
        cudaGraphicsUnregisterResource(resource_);  // before the OpenGL buffer goes
    }

    //! [map]
    /// Hands the buffer to CUDA. @return device memory of size() elements, valid until unmap(): the address
    /// may differ from one map() to the next. @throws std::logic_error if it is mapped already
    T* map() {
        if (mapped_) throw std::logic_error("map(): CUDA has this buffer already");
        if (resource_) CUDA_CHECK(cudaGraphicsMapResources(1, &resource_));
        mapped_ = true;
        if (!resource_) return device_->data();
        void* data = nullptr;
        std::size_t bytes = 0;
        CUDA_CHECK(cudaGraphicsResourceGetMappedPointer(&data, &bytes, resource_));
        return static_cast<T*>(data);
    }

    /// Hands the buffer back to OpenGL, once the kernels launched so far are done with it.
    /// @throws std::logic_error if it is not mapped
    void unmap() {
        if (!mapped_) throw std::logic_error("unmap(): OpenGL has this buffer already");
        mapped_ = false;
        if (resource_) {
            CUDA_CHECK(cudaGraphicsUnmapResources(1, &resource_));
            return;
        }
        CUDA_CHECK(cudaMemcpy(host_.data(), device_->data(), size_ * sizeof(T), cudaMemcpyDeviceToHost));
        glBindBuffer(GL_ARRAY_BUFFER, buffer_.id());
        glBufferSubData(GL_ARRAY_BUFFER, 0, GLsizeiptr(size_ * sizeof(T)), host_.data());
    }
    //! [map]

    /// The buffer to draw from. @throws std::logic_error while CUDA has it: a GPU would draw whatever it
    /// finds
    const course::GlBuffer& gl_buffer() const {
        if (mapped_) throw std::logic_error("gl_buffer(): CUDA has this buffer; unmap() it before drawing");
        return buffer_;
    }

    std::size_t size() const { return size_; }
    Handover handover() const { return resource_ ? Handover::shared : Handover::copied; }
    /// One line for the user: which way, and why.
    std::string why() const {
        return resource_ ? "CUDA writes into the OpenGL buffer: no copy"
                         : "through a copy in host memory (" + why_ + ")";
    }

  private:
    std::size_t size_;
    course::GlBuffer buffer_;
    cudaGraphicsResource* resource_ = nullptr;
    bool mapped_ = false;
    // For the copy alone:
    std::string why_;
    std::optional<course::DeviceBuffer<T>> device_;
    std::vector<T> host_;
};

}  // namespace interop
