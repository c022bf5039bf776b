/// @file
/// What this chapter measures: three layouts on the device against the host's loop, the price of copies, and
/// the largest time step that is stable.
#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "01_particle_loop/scenes.h"
#include "01_particle_loop/stopwatch.h"
#include "03_first_kernels/device_fountain.cuh"
#include "03_first_kernels/parity.h"
#include "common/gpu_timer.h"
#include "common/study.h"

namespace first_kernels {

/// n droplets as they leave the nozzle.
inline std::vector<Particle> at_the_nozzle(const Fountain& fountain, std::uint32_t n) {
    std::vector<Particle> particles(n);
    for (std::uint32_t i = 0; i < n; ++i)
        emit(fountain, particle_loop::random_start(fountain.seed, i, 0), particles[i].position_m,
             particles[i].velocity_m_per_s);
    return particles;
}

/// Steps timed at once: one alone is over too soon to be measured well.
inline int batch_for(std::uint32_t n) {
    return int(std::max(1u, (1u << 18) / n));
}

/// A batch of steps, until the device is done with them: kernels run on after their launch.
template <class Step>
std::function<void()> batch_of(std::uint32_t n, Step step) {
    return [n, step]() mutable {
        for (int k = 0; k < batch_for(n); ++k) step();
        CUDA_CHECK(cudaDeviceSynchronize());
    };
}

// -------------------------------------------------------------------------------------------------- layout

/// Largest distance from the host's droplets that rounding explains; if more of them bounced in another step
/// than rounding can bring about, the largest distance of all.
inline double parity_error_m(const std::vector<Particle>& host, const std::vector<Particle>& device) {
    const auto n = std::uint32_t(host.size());
    const Parity parity = compare_positions(host, device, n);
    return parity.other_bounce <= 1 + n / 200 ? parity.largest_m : parity.largest_other_m;
}

/// All layouts at one size: a life of the droplets on the device and on the host, then the time of a step.
inline void add_layouts(course::Study& study, const Fountain& fountain, std::uint32_t n) {
    const std::vector<Particle> start = at_the_nozzle(fountain, n);
    std::vector<Particle> host = start;
    StructsOnDevice structs(start);
    ArraysOnDevice arrays(start);
    Float4OnDevice float4s(start);
    std::uint32_t s = life_steps(fountain);  // from here on, all droplets are in flight
    for (; s < 2 * life_steps(fountain); ++s) {
        step(host, fountain, s);
        structs.step(fountain, s);
        arrays.step(fountain, s);
        float4s.step(fountain, s);
    }
    const double errors_m[] = {0.0,  // the host is the reference
                               parity_error_m(host, structs.download()),
                               parity_error_m(host, arrays.download()),
                               parity_error_m(host, float4s.download())};
    const char* methods[] = {"host loop, array of structs", "kernel, array of structs",
                             "kernel, struct of arrays", "kernel, float4"};
    const std::vector<course::Timing> timings = particle_loop::by_turns(
        study.quick ? 5 : 9, {batch_of(n, [&, s]() mutable { step(host, fountain, s++); }),
                              batch_of(n, [&, s]() mutable { structs.step(fountain, s++); }),
                              batch_of(n, [&, s]() mutable { arrays.step(fountain, s++); }),
                              batch_of(n, [&, s]() mutable { float4s.step(fountain, s++); })});
    for (int k = 0; k < 4; ++k)
        study.add({methods[k], double(n), double(n), errors_m[k], timings[k].per(batch_for(n))});
}

inline void study_layout(course::Study& study) {
    course::on_device(study);
    std::vector<std::uint32_t> sizes{1u << 10, 1u << 12, 1u << 14, 1u << 16};
    if (!study.quick) sizes.insert(sizes.end(), {1u << 18, 1u << 20});
    study.expect(4 * int(sizes.size()));
    for (const std::uint32_t n : sizes) add_layouts(study, particle_loop::make_scene("crown"), n);
}

// -------------------------------------------------------------------------------------------------- copies

/// Elements (float4) that differ between two states.
inline int different_elements(const Float4OnDevice& a, const Float4OnDevice& b) {
    int different = 0;
    const auto compare = [&](const course::DeviceBuffer<float4>& one,
                             const course::DeviceBuffer<float4>& other) {
        const std::vector<float4> p = one.download(), q = other.download();
        for (std::size_t i = 0; i < p.size(); ++i)
            different += !(p[i].x == q[i].x && p[i].y == q[i].y && p[i].z == q[i].z && p[i].w == q[i].w);
    };
    compare(a.position, b.position);
    compare(a.velocity, b.velocity);
    return different;
}

//! [copies]
/// What is done with the state around each step.
enum class Copies { none, to_host, there_and_back };

/// A step, and the copies around it. `host` has room for the state: allocating it each time would be
/// measured, too.
inline void step_with_copies(Float4OnDevice& state, std::vector<std::vector<float4>>& host, Copies copies,
                             const Fountain& fountain, std::uint32_t step_index) {
    course::DeviceBuffer<float4>* arrays[] = {&state.position, &state.velocity};
    if (copies == Copies::there_and_back)
        for (int k = 0; k < 2; ++k) arrays[k]->upload(host[k]);
    state.step(fountain, step_index);
    if (copies == Copies::none) return;
    for (int k = 0; k < 2; ++k)
        CUDA_CHECK(cudaMemcpy(host[k].data(), arrays[k]->data(), arrays[k]->bytes(), cudaMemcpyDeviceToHost));
}
//! [copies]

/// A state that stays on the device, one that is looked at after each step, one that moves in each step.
inline void add_copies(course::Study& study, const Fountain& fountain, std::uint32_t n) {
    constexpr Copies kCopies[] = {Copies::none, Copies::to_host, Copies::there_and_back};
    const char* methods[] = {"state stays", "state to the host", "state there and back"};
    const std::vector<Particle> start = at_the_nozzle(fountain, n);
    std::vector<Float4OnDevice> states;
    std::vector<std::vector<float4>> hosts[3];
    std::vector<std::function<void()>> works;
    std::uint32_t s[3];
    for (int k = 0; k < 3; ++k) {
        states.emplace_back(start);
        hosts[k] = {states[k].position.download(), states[k].velocity.download()};
        s[k] = life_steps(fountain);  // from here on, all droplets are in flight
        works.push_back(
            batch_of(n, [&, k] { step_with_copies(states[k], hosts[k], kCopies[k], fountain, s[k]++); }));
    }
    const std::vector<course::Timing> timings = particle_loop::by_turns(study.quick ? 5 : 9, works);
    for (int k = 0; k < 3; ++k)
        study.add({methods[k], double(n), double(n), double(different_elements(states[k], states[0])),
                   timings[k].per(batch_for(n))});
}

inline void study_copies(course::Study& study) {
    course::on_device(study);
    std::vector<std::uint32_t> sizes{1u << 10, 1u << 12, 1u << 14, 1u << 16, 1u << 18};
    if (!study.quick) sizes.insert(sizes.end(), {1u << 20, 1u << 22});
    study.expect(3 * int(sizes.size()));
    for (const std::uint32_t n : sizes) add_copies(study, particle_loop::make_scene("crown"), n);
}

// ----------------------------------------------------------------------------------------------- stability

/// Is the fastest of 64 droplets, on which only drag acts, slower after 200 steps on the device than it was?
inline bool drag_is_stable_on_device(float drag_per_s, float dt_s) {
    constexpr std::uint32_t kDroplets = 64, kSteps = 200;
    Fountain fountain = particle_loop::make_scene("crown");
    fountain.gravity_m_per_s2 = 0;
    fountain.drag_per_s = drag_per_s;
    fountain.dt_s = dt_s;
    fountain.lifetime_s = 1e6f * dt_s;  // a million steps: nobody starts again in the first 200 of them
    Float4OnDevice state(std::vector<Particle>(kDroplets, {{0, 1, 0}, {1, 0, 0}}));
    for (std::uint32_t s = 0; s < kSteps; ++s) state.step(fountain, life_steps(fountain) + s);
    for (const Particle& p : state.download())
        if (!(std::abs(p.velocity_m_per_s.x) < 1.0f)) return false;  // NaN, too
    return true;
}

inline void map_drag(course::StabilityMap& map) {
    course::on_device(map);
    const std::vector<double> drags{0.35, 3.5, 35, 350, 3500, 35000};
    map.expect(int(drags.size()));
    for (const double drag_per_s : drags)
        map.column("fountain kernel, float4", drag_per_s, 2 / drag_per_s,
                   {0.1, 0.25, 0.5, 0.75, 0.9, 0.99, 1.01, 1.1, 1.5, 2, 4}, map.quick ? 2 : 6,
                   [&](double dt_s) { return drag_is_stable_on_device(float(drag_per_s), float(dt_s)); });
}

}  // namespace first_kernels
