/// @file
/// The chapter's measurements: how to step a particle through the air, how many sprites a fire needs, what
/// sorting buys, and where Euler's method gives up.
#pragma once
#include <complex>

#include "07_fire_particles/measure.cuh"
#include "common/gl_context.h"
#include "common/gpu_timer.h"
#include "common/study.h"

namespace fire {

// --------------------------------------------------------------------------------------------- time steps

/// A particle in a whirl: the air turns like a record, W = Omega x r, and buoyancy falls off. Solved exactly:
/// w = x + i z obeys w'' = -(w' - i Omega w) / tau, a linear equation with two complex exponents.
struct Whirl {
    double tau_s = 0.08, omega_per_s = 4, buoyancy_m_per_s2 = 9, cooling_s = 0.5;

    glm::dvec3 wind(glm::dvec3 x) const { return {-omega_per_s * x.z, 0, omega_per_s * x.x}; }
    Forces<double> forces(glm::dvec3 x, double t_s) const {
        return {wind(x), buoyancy_m_per_s2 * std::exp(-t_s / cooling_s), tau_s, cooling_s};
    }
    glm::dvec3 exact(glm::dvec3 x, glm::dvec3 v, double t) const {
        using Complex = std::complex<double>;
        const Complex w0(x.x, x.z), u0(v.x, v.z), i(0, 1), half(-0.5 / tau_s);
        const Complex root = std::sqrt(half * half + i * omega_per_s / tau_s);
        const Complex a = half + root, b = half - root;  // exponents
        const Complex c = (u0 - b * w0) / (a - b);
        const Complex w = c * std::exp(a * t) + (w0 - c) * std::exp(b * t);
        const double k = buoyancy_m_per_s2 / (1 / tau_s - 1 / cooling_s);
        const double y =
            x.y + k * cooling_s * -std::expm1(-t / cooling_s) + (v.y - k) * tau_s * -std::expm1(-t / tau_s);
        return {w.real(), y, w.imag()};
    }
};

enum class Stepper { explicit_euler, semi_implicit_euler, exponential, exponential_ahead };

//! [steppers]
/// One step of a particle in the whirl, by four methods.
inline void whirl_step(const Whirl& whirl, Stepper stepper, double t_s, double dt_s, glm::dvec3& x,
                       glm::dvec3& v) {
    const Forces<double> f = whirl.forces(x, t_s);
    const glm::dvec3 a = (f.wind_m_per_s - v) / f.drag_time_s + glm::dvec3(0, f.buoyancy_m_per_s2, 0);
    switch (stepper) {
        case Stepper::explicit_euler:
            x += dt_s * v;
            v += dt_s * a;
            break;
        case Stepper::semi_implicit_euler:
            v += dt_s * a;
            x += dt_s * v;
            break;
        case Stepper::exponential:
            drag_step(f, dt_s, x, v);
            break;
        case Stepper::exponential_ahead: {
            Forces<double> ahead = f;  // the same, in the air that blows half a flight ahead
            ahead.wind_m_per_s = whirl.wind(x + 0.5 * dt_s * v);
            drag_step(ahead, dt_s, x, v);
            break;
        }
    }
}
//! [steppers]

inline void study_time_step(course::Study& study) {
    const std::vector<std::pair<std::string, Stepper>> methods = {
        {"explicit Euler", Stepper::explicit_euler},
        {"semi-implicit Euler", Stepper::semi_implicit_euler},
        {"exponential step", Stepper::exponential},
        {"exponential step, wind half a flight ahead", Stepper::exponential_ahead}};
    const int finest = study.quick ? 480 : 7680, count = study.quick ? 200 : 1000;
    constexpr double kTime_s = 1;
    const Whirl whirl;
    int rows = 0;
    for (int steps = 15; steps <= finest; steps *= 2) rows += int(methods.size());
    study.expect(rows);
    for (const auto& [name, stepper] : methods)
        for (int steps = 15; steps <= finest; steps *= 2) {
            const double dt_s = kTime_s / steps;
            double error_m = 0;
            const course::Timing timing = course::time_work(study.quick ? 3 : 5, [&, stepper = stepper] {
                error_m = 0;
                for (int k = 0; k < count; ++k) {
                    const glm::dvec3 x0(0.1 + 0.3 * k / count, 0, 0), v0(0, 0.5, 0.2);
                    glm::dvec3 x = x0, v = v0;
                    for (int step = 0; step < steps; ++step)
                        whirl_step(whirl, stepper, step * dt_s, dt_s, x, v);
                    error_m = std::max(error_m, glm::distance(x, whirl.exact(x0, v0, kTime_s)));
                }
            });
            study.add({name, dt_s, double(count), error_m, timing.per(steps), double(steps)});
        }
}

// ------------------------------------------------------------------------------------------------ sprites

/// Root mean square of the difference, relative to that of `reference`: in linear light.
inline double relative_error(const std::vector<glm::vec4>& light, const std::vector<glm::vec4>& reference) {
    double difference = 0, whole = 0;
    for (std::size_t k = 0; k < light.size(); ++k) {
        const glm::dvec3 a(light[k]), b(reference[k]);
        difference += glm::dot(a - b, a - b);
        whole += glm::dot(b, b);
    }
    return std::sqrt(difference / whole);
}

/// Only the flames of a campfire, after its warm-up. @param grow factor on the sprites' size
inline FireScene flames_alone(std::uint32_t particles, float grow) {
    FireScene scene = make_scene("campfire", particles, 1);
    const ParticleKind flames = scene.fire.kind[0];
    SpriteLook look = scene.looks[0];
    scene.fire.kind_count = 0;
    scene.looks.clear();
    look.radius_start_m *= grow, look.radius_end_m *= grow;
    look.light /= grow * grow;  // the same light over a larger spot
    ParticleKind& kind = add_kind(scene, particles, look);
    const std::uint32_t first = kind.first;
    kind = flames;
    kind.first = first, kind.count = particles;
    scene.looks[0].light *= float(flames.count) / float(particles);
    scene.warm_up_steps = 120;
    return scene;
}

inline void study_sprites(course::Study& study) {
    course::on_device(study);
    const auto context = course::make_headless_context();
    const int width = study.quick ? 320 : 640, height = study.quick ? 180 : 360;
    const std::uint32_t most = study.quick ? 8192 : 65536;
    const auto render = [&](std::uint32_t particles, float grow, course::Timing* timing) {
        const FireScene scene = flames_alone(particles, grow);
        SharedFire fire(scene);
        FireView view(scene, width, height);
        const course::Camera camera = camera_of(scene);
        for (int step = 0; step < scene.warm_up_steps; ++step) fire.step();
        const auto draw = [&] {
            view.renderer().begin(camera, {});
            view.draw_kinds(fire, Blend::additive, camera);
            glFinish();
        };
        if (timing) {
            const course::Timing stage = course::time_work(5, [&] {
                view.renderer().begin(camera, {});
                glFinish();
            });
            *timing = course::time_work(study.quick ? 3 : 5, draw);
            for (double* s : {&timing->median_s, &timing->low_s, &timing->high_s})
                *s = std::max(1e-6, *s - stage.median_s);
        } else {
            draw();
        }
        return view.renderer().light();
    };
    const std::vector<glm::vec4> reference = render(4 * most, 1, nullptr);
    constexpr std::uint32_t kEnough = 16384;  // from here on, larger sprites would only blur
    const auto measure = [&](const std::string& method, std::uint32_t n, float grow) {
        course::Timing timing;
        const auto light = render(n, grow, &timing);
        study.add({method, double(n), double(n), relative_error(light, reference), timing, 1});
    };
    for (std::uint32_t n = 512; n <= most; n *= 2) measure("sprites of one size", n, 1);
    for (std::uint32_t n = 512; n < std::min(most, kEnough); n *= 2)
        measure("fewer are larger: size as count^-1/4", n, std::pow(float(kEnough) / float(n), 0.25f));
}

// ------------------------------------------------------------------------------------------------ sorting

inline void study_sorting(course::Study& study) {
    course::on_device(study);
    const auto context = course::make_headless_context();
    const int width = study.quick ? 320 : 640, height = study.quick ? 180 : 360;
    std::vector<std::uint32_t> counts = {16384, 131072};
    if (study.quick) counts = {4096, 16384};
    const std::vector<int> slices = {1, 4, 16, 64, 256, 1024, 4096};
    study.expect(int(counts.size() * slices.size()));
    for (const std::uint32_t particles : counts) {
        FireScene scene = make_scene("campfire", particles, 1);
        const ParticleKind puffs = scene.fire.kind[1];
        const SpriteLook look = scene.looks[1];
        scene.stage.rods.clear();
        scene.stage.ground = false;
        scene.fire.kind_count = 0;
        scene.looks.clear();
        ParticleKind& kind = add_kind(scene, puffs.count, look);
        const std::uint32_t first = kind.first;
        kind = puffs;
        kind.first = first;
        SharedFire fire(scene);
        for (int step = 0; step < scene.warm_up_steps; ++step) fire.step();
        const course::Camera camera = camera_of(scene);
        const auto render = [&](int slice_count, course::Timing* timing) {
            FireView view(scene, width, height, slice_count > 1 ? SmokeOrder::sorted : SmokeOrder::unsorted,
                          slice_count);
            const auto draw = [&] {
                view.renderer().begin(camera, lights_at(scene, 0));
                view.draw_kinds(fire, Blend::alpha, camera);
                CUDA_CHECK(cudaDeviceSynchronize());
                glFinish();
            };
            if (timing)
                *timing = course::time_work(study.quick ? 3 : 5, draw);
            else
                draw();
            return view.renderer().light();
        };
        const std::vector<glm::vec4> reference = render(1 << 20, nullptr);
        for (const int slice_count : slices) {
            course::Timing timing;
            const auto light = render(slice_count, &timing);
            study.add({std::to_string(puffs.count) + " puffs", double(slice_count), double(puffs.count),
                       relative_error(light, reference), timing, 1});
        }
    }
}

// ---------------------------------------------------------------------------------------------- stability

//! [stability]
/// Does a particle's speed in still air stay bounded over 400 steps?
inline bool drag_is_stable(Stepper stepper, double drag_per_s, double dt_s) {
    Whirl still;
    still.omega_per_s = 0, still.buoyancy_m_per_s2 = 0, still.tau_s = 1 / drag_per_s;
    glm::dvec3 x(0), v(1, 1, 1);
    for (int step = 0; step < 400; ++step) whirl_step(still, stepper, step * dt_s, dt_s, x, v);
    return glm::length(v) <= 2;  // false for NaN, too
}
//! [stability]

inline void stability_drag(course::StabilityMap& map) {
    const std::vector<std::pair<std::string, Stepper>> methods = {
        {"explicit Euler", Stepper::explicit_euler},
        {"semi-implicit Euler", Stepper::semi_implicit_euler},
        {"exponential step", Stepper::exponential}};
    const std::vector<double> drags_per_s = {1, 10, 100, 1e3, 1e4};
    map.expect(int(methods.size() * drags_per_s.size()));
    for (const auto& [name, stepper] : methods)
        for (const double drag_per_s : drags_per_s)
            map.column(name, drag_per_s, 2 / drag_per_s, {0.25, 0.5, 0.9, 0.99, 1.01, 1.1, 2, 10, 1000},
                       map.quick ? 6 : 12, [&, stepper = stepper](double dt_s) {
                           return drag_is_stable(stepper, drag_per_s, dt_s);
                       });
}

}  // namespace fire
