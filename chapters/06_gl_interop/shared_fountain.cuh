/// @file
/// The fountain of chapter 03, its state in buffers that OpenGL draws.
#pragma once
#include "03_first_kernels/first_kernels.cuh"
#include "06_gl_interop/interop_buffer.cuh"

namespace interop {

/// Positions (float4: xyz in metres, age in seconds) and velocities (float4: m/s) of n droplets, stepped by
/// chapter 03's kernels.
class SharedFountain {
  public:
    SharedFountain(std::uint32_t n, const particle_loop::Fountain& fountain,
                   Handover wanted = Handover::shared)
        : fountain_(fountain), position_(n, wanted), velocity_(n, wanted) {
        reset();
    }

    //! [step]
    /// One time step: CUDA takes the two buffers, a kernel works on them, OpenGL gets them back.
    void step() {
        float4* position = position_.map();
        float4* velocity = velocity_.map();
        first_kernels::launch_fountain_step(position, velocity, size(), fountain_, steps_done_);
        velocity_.unmap();
        position_.unmap();
        ++steps_done_;
    }
    //! [step]

    /// Back to the start: no droplet is born.
    void reset() {
        steps_done_ = 0;
        first_kernels::launch_fountain_clear(position_.map(), velocity_.map(), size());
        velocity_.unmap();
        position_.unmap();
    }

    std::uint32_t size() const { return std::uint32_t(position_.size()); }
    /// Droplets 0 ... born() - 1 have left the nozzle: those are to be drawn.
    std::uint32_t born() const { return particle_loop::born_after(fountain_, size(), steps_done_); }
    std::uint32_t steps_done() const { return steps_done_; }
    const InteropBuffer<float4>& position() const { return position_; }
    const InteropBuffer<float4>& velocity() const { return velocity_; }

  private:
    particle_loop::Fountain fountain_;
    std::uint32_t steps_done_ = 0;
    InteropBuffer<float4> position_, velocity_;
};

}  // namespace interop
