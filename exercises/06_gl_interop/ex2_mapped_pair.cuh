// Exercise 06.2: two buffers, one map, and no way to forget the unmap.
//
// Each map and each unmap makes CUDA and OpenGL wait for each other. Positions and velocities are always
// wanted together, so map both with one call. And let the unmap be a destructor's work: it happens even if a
// launch throws.
#pragma once
#include <GL/glew.h>
#include <cuda_gl_interop.h>
#include <cuda_runtime.h>

#include "common/cuda_check.h"
#include "common/todo.h"

namespace interop {

// While it lives CUDA has both buffers; before and after, OpenGL has them.
class MappedPair {
  public:
    MappedPair(cudaGraphicsResource* positions, cudaGraphicsResource* velocities)
        : resources_{positions, velocities} {
        // TODO(6.2): map both resources with one call, then ask for the address of each and keep it in data_.
        // Check every call. About 5 lines.
    }
    MappedPair(const MappedPair&) = delete;
    MappedPair& operator=(const MappedPair&) = delete;
    ~MappedPair() {
        // TODO(6.2): give both back with one call. A destructor must not throw: no CUDA_CHECK here. 1 line.
    }

    float4* positions() { return data_[0]; }
    float4* velocities() { return data_[1]; }

  private:
    cudaGraphicsResource* resources_[2];
    float4* data_[2] = {nullptr, nullptr};
};

}  // namespace interop
