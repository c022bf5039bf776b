/// @file
/// A fire whose state lies in buffers that OpenGL draws.
#pragma once
#include "06_gl_interop/interop_buffer.cuh"
#include "07_fire_particles/fire_renderer.h"
#include "07_fire_particles/fire_scene.cuh"

namespace fire {

/// The state of a scene's particles. What is drawn lies in OpenGL's memory, the rest in CUDA's.
class SharedFire {
  public:
    explicit SharedFire(const FireScene& scene)
        : scene_(scene),
          position_(particle_count(scene.fire)),
          velocity_(position_.size()),
          generation_(position_.size()) {
        reset();
    }

    //! [step]
    /// One time step: CUDA takes the two buffers, one kernel works on them, OpenGL gets them back.
    void step() {
        const float time_s = float(steps_done_ * double(scene_.dt_s));  // counted, never summed
        launch_flame_step(map(), scene_.fire, scene_.curl, time_s, scene_.dt_s);
        unmap();
        ++steps_done_;
    }
    //! [step]

    /// Back to the start: nobody is born.
    void reset() {
        steps_done_ = 0;
        launch_flame_clear(map(), scene_.fire);
        unmap();
    }

    std::uint32_t size() const { return std::uint32_t(position_.size()); }
    std::uint32_t steps_done() const { return steps_done_; }
    float time_s() const { return float(steps_done_ * double(scene_.dt_s)); }
    const FireScene& scene() const { return scene_; }
    const interop::InteropBuffer<float4>& position() const { return position_; }
    const interop::InteropBuffer<float4>& velocity() const { return velocity_; }

    /// The state for other kernels; unmap() before drawing.
    FlameArrays map() { return {position_.map(), velocity_.map(), generation_.data()}; }
    void unmap() {
        velocity_.unmap();
        position_.unmap();
    }

  private:
    FireScene scene_;
    std::uint32_t steps_done_ = 0;
    interop::InteropBuffer<float4> position_, velocity_;
    course::DeviceBuffer<std::uint32_t> generation_;
};

}  // namespace fire
