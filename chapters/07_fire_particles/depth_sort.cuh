/// @file
/// Particles from the farthest to the nearest, for what covers instead of shining: chapter 05's counting
/// sort, with slices of depth for cells.
#pragma once
#include "05_spatial_grid/counting_sort.cuh"
#include "07_fire_particles/shared_fire.cuh"

namespace fire {

constexpr int kDepthSlices = 1024;  // within a slice the order is any: see the study `sorting`

//! [depth_kernel]
/// One thread per particle: its place on a line that runs from far to near. Those that are not there (not
/// born, dead) go nowhere: chapter 05 keeps a limbo for positions that are not finite.
inline __global__ void depth_kernel(float4* place, const float4* position, const float4* velocity,
                                    std::uint32_t n, float4 depth_of) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const float4 x = position[i];
    const bool alive = x.w >= 0 && x.w < velocity[i].w;
    const float depth_m = depth_of.x * x.x + depth_of.y * x.y + depth_of.z * x.z + depth_of.w;
    place[i] = make_float4(alive ? -depth_m : NAN, 0, 0, 0);
}
//! [depth_kernel]

/// Sorted copies of up to `count` particles, in buffers that OpenGL draws.
class DepthSort {
  public:
    explicit DepthSort(std::uint32_t count, int slices = kDepthSlices)
        : slices_(slices),
          position_(count),
          velocity_(count),
          place_(count),
          sort_(count, std::uint32_t(slices)) {}

    //! [depth_sort]
    /// Sorts the `count` particles from number `first` on, as seen from `camera`. Depths beyond twice the
    /// distance to the camera's target share the last slice.
    void sort(SharedFire& fire, std::uint32_t first, std::uint32_t count, const course::Camera& camera) {
        const glm::mat4 view = camera.view();
        const float4 depth_of = make_float4(-view[0][2], -view[1][2], -view[2][2], -view[3][2]);
        const float far_m = 2 * glm::distance(camera.eye_m, camera.target_m);
        grid::CellGrid slices;
        slices.origin_m = glm::vec3(-far_m, 0, 0);
        slices.cells_per_m = float(slices_) / far_m;
        slices.size = glm::ivec3(slices_, 1, 1);

        const FlameArrays all = fire.map();
        const float4 *position = all.position + first, *velocity = all.velocity + first;
        constexpr std::uint32_t kThreads = grid::CountingSort::kThreads;
        const std::uint32_t blocks = grid::blocks_for(count, kThreads);
        depth_kernel<<<blocks, kThreads>>>(place_.data(), position, velocity, count, depth_of);
        CUDA_CHECK(cudaGetLastError());
        sort_.build(place_.data(), slices, count);
        grid::gather_kernel<float4><<<blocks, kThreads>>>(position_.map(), position, sort_.order(), count);
        grid::gather_kernel<float4><<<blocks, kThreads>>>(velocity_.map(), velocity, sort_.order(), count);
        CUDA_CHECK(cudaGetLastError());
        velocity_.unmap();
        position_.unmap();
        fire.unmap();
    }
    //! [depth_sort]

    const interop::InteropBuffer<float4>& position() const { return position_; }
    const interop::InteropBuffer<float4>& velocity() const { return velocity_; }

    /// Bytes of device memory for each particle, apart from the 32 in OpenGL's buffers.
    static constexpr std::size_t kDeviceBytes = sizeof(float4) + 2 * sizeof(std::uint32_t);

  private:
    int slices_;
    interop::InteropBuffer<float4> position_, velocity_;
    course::DeviceBuffer<float4> place_;
    grid::CountingSort sort_;
};

}  // namespace fire
