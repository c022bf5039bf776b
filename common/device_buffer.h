/// @file
/// Device memory that frees itself.
#pragma once
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "common/cuda_check.h"
#include "common/errors.h"

namespace course {

/// An array of `size()` elements in device memory, uninitialised until written. Move-only; freed with its
/// owner.
template <class T>
class DeviceBuffer {
  public:
    DeviceBuffer() = default;

    /// @throws BadInput when the device has not that much memory, naming the bytes asked for.
    /// @param beyond  elements more, behind the last, that kernels may read but nobody counts as content
    explicit DeviceBuffer(std::size_t size, std::size_t beyond = 0) : size_(size) {
        if (size == 0) return;
        const cudaError_t error = cudaMalloc(&data_, (size + beyond) * sizeof(T));
        if (error == cudaErrorMemoryAllocation) {
            cudaGetLastError();  // reported here: don't leave it for the next check to trip over
            throw BadInput("the device has not the " + std::to_string(size * sizeof(T)) + " bytes for " +
                           std::to_string(size) + " elements: ask for fewer particles");
        }
        CUDA_CHECK(error);
    }
    explicit DeviceBuffer(const std::vector<T>& host) : DeviceBuffer(host.size()) { upload(host); }

    DeviceBuffer(DeviceBuffer&& other) noexcept
        : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}
    DeviceBuffer& operator=(DeviceBuffer&& other) noexcept {
        std::swap(data_, other.data_);
        std::swap(size_, other.size_);
        return *this;
    }
    ~DeviceBuffer() { cudaFree(data_); }  // nothing sensible can be done with an error here

    T* data() { return data_; }
    const T* data() const { return data_; }
    std::size_t size() const { return size_; }
    std::size_t bytes() const { return size_ * sizeof(T); }

    /// Copies `host` to the start of the buffer. @throws BadInput if it does not fit.
    void upload(const std::vector<T>& host) {
        if (host.size() > size_) throw BadInput("upload of more elements than the device buffer holds");
        if (!host.empty())
            CUDA_CHECK(cudaMemcpy(data_, host.data(), host.size() * sizeof(T), cudaMemcpyHostToDevice));
    }
    /// All elements, copied to the host. Waits for the kernels launched before.
    std::vector<T> download() const {
        std::vector<T> host(size_);
        if (size_) CUDA_CHECK(cudaMemcpy(host.data(), data_, bytes(), cudaMemcpyDeviceToHost));
        return host;
    }

  private:
    T* data_ = nullptr;
    std::size_t size_ = 0;
};

}  // namespace course
