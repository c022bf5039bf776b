/// @file
/// The fountain's state in device memory, in each of the three layouts, and its way back to the host.
#pragma once
#include <vector>

#include "03_first_kernels/first_kernels.cuh"
#include "common/device_buffer.h"

namespace first_kernels {

/// Array of structs: 24 bytes a droplet.
struct StructsOnDevice {
    course::DeviceBuffer<Particle> particles;

    explicit StructsOnDevice(const std::vector<Particle>& start) : particles(start) {}
    void step(const Fountain& fountain, std::uint32_t step_index) {
        launch_fountain_step(particles.data(), std::uint32_t(particles.size()), fountain, step_index);
    }
    std::vector<Particle> download() const { return particles.download(); }
};

/// Struct of arrays: 6 * 4 bytes a droplet.
struct ArraysOnDevice {
    course::DeviceBuffer<float> x, y, z, vx, vy, vz;

    explicit ArraysOnDevice(const std::vector<Particle>& start) {
        particle_loop::ParticleArrays a(start.size());
        for (std::size_t i = 0; i < start.size(); ++i) a.store(i, start[i]);
        x = course::DeviceBuffer<float>(a.x_m), y = course::DeviceBuffer<float>(a.y_m);
        z = course::DeviceBuffer<float>(a.z_m), vx = course::DeviceBuffer<float>(a.vx_m_per_s);
        vy = course::DeviceBuffer<float>(a.vy_m_per_s), vz = course::DeviceBuffer<float>(a.vz_m_per_s);
    }
    ArrayPointers pointers() { return {x.data(), y.data(), z.data(), vx.data(), vy.data(), vz.data()}; }
    void step(const Fountain& fountain, std::uint32_t step_index) {
        launch_fountain_step(pointers(), std::uint32_t(x.size()), fountain, step_index);
    }
    std::vector<Particle> download() const {
        particle_loop::ParticleArrays a;
        a.x_m = x.download(), a.y_m = y.download(), a.z_m = z.download();
        a.vx_m_per_s = vx.download(), a.vy_m_per_s = vy.download(), a.vz_m_per_s = vz.download();
        std::vector<Particle> particles(a.size());
        for (std::size_t i = 0; i < a.size(); ++i) particles[i] = a.load(i);
        return particles;
    }
};

//! [float4_on_device]
/// Two float4 arrays: 32 bytes a droplet, the age included.
struct Float4OnDevice {
    course::DeviceBuffer<float4> position, velocity;

    /// n droplets, none of them born yet.
    explicit Float4OnDevice(std::uint32_t n) : position(n), velocity(n) {
        launch_fountain_clear(position.data(), velocity.data(), n);
    }
    /// Droplets in flight.
    explicit Float4OnDevice(const std::vector<Particle>& start)
        : Float4OnDevice(std::uint32_t(start.size())) {
        std::vector<float4> x, v;
        for (const Particle& p : start) {
            x.push_back(make_float4(p.position_m.x, p.position_m.y, p.position_m.z, 0.0f));
            v.push_back(make_float4(p.velocity_m_per_s.x, p.velocity_m_per_s.y, p.velocity_m_per_s.z, 0.0f));
        }
        position.upload(x);
        velocity.upload(v);
    }
    void step(const Fountain& fountain, std::uint32_t step_index,
              unsigned threads_per_block = kThreadsPerBlock) {
        launch_fountain_step(position.data(), velocity.data(), std::uint32_t(position.size()), fountain,
                             step_index, threads_per_block);
    }
    std::vector<Particle> download() const {
        const std::vector<float4> x = position.download(), v = velocity.download();
        std::vector<Particle> particles;
        particles.reserve(x.size());
        for (std::size_t i = 0; i < x.size(); ++i)
            particles.push_back({{x[i].x, x[i].y, x[i].z}, {v[i].x, v[i].y, v[i].z}});
        return particles;
    }
};
//! [float4_on_device]

}  // namespace first_kernels
