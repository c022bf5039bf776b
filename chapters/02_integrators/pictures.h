/// @file
/// What methods do to an orbit and to a handful of oscillators, drawn with chapter 01's spots of light.
#pragma once
#include <string>

#include "01_particle_loop/splat.h"
#include "02_integrators/methods.h"
#include "02_integrators/problems.h"
#include "common/letters.h"

namespace integrators {

/// A dark canvas that shows the plane around `centre`, `height` units high.
inline particle_loop::Canvas make_panel(int width, int height, glm::vec2 centre, float view_height) {
    particle_loop::Camera camera;
    camera.target_m = glm::vec3(centre, 0);
    camera.eye_m = glm::vec3(centre, 100);
    camera.view_height_m = view_height;
    particle_loop::Canvas canvas(width, height, camera);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) canvas.at(x, y) = glm::vec3(0.004f, 0.005f, 0.010f);
    return canvas;
}

/// A word in the upper left corner, in letters 7 x `scale` pixels high.
inline void write(course::Image& image, const std::string& words, int scale) {
    course::for_each_stroke(words, [&](glm::vec2 low, glm::vec2 high) {
        for (int y = (int(low.y) + 4) * scale; y < (int(high.y) + 4) * scale; ++y)
            for (int x = (int(low.x) + 4) * scale; x < (int(high.x) + 4) * scale; ++x)
                if (x < image.width && y < image.height)
                    for (int c = 0; c < 3; ++c) image.pixel(x, y)[c] = 225;
    });
}

/// A line of light. Spots are set closer than they are large, so that no gap is seen; together they give the
/// same light for each pixel of length.
inline void glow(particle_loop::Canvas& canvas, glm::vec2 from, glm::vec2 to, float radius, glm::vec3 light) {
    const float length = glm::length(to - from) / (0.7f * radius);
    const int spots = length < 400 ? 1 + int(length) : 400;  // a comet that was thrown out jumps far
    light *= length / float(spots);
    for (int k = 0; k < spots; ++k)
        canvas.spot(glm::vec3(glm::mix(from, to, (k + 0.5f) / float(spots)), 0), radius, light);
}

/// Blue at first, then green, then gold: colours told apart by most eyes, and their brightness grows too.
inline glm::vec3 colour_of_age(float age) {
    const glm::vec3 young(0.10f, 0.30f, 1.0f), middle(0.10f, 0.75f, 0.55f), old(1.0f, 0.62f, 0.12f);
    return age < 0.5f ? glm::mix(young, middle, 2 * age) : glm::mix(middle, old, 2 * age - 1);
}

/// The truth, as a method: where the comet is a step later is asked of Kepler's equation.
struct ExactComet {
    static constexpr const char* kName = "exact";

    static State<double, 2> step(const Kepler& comet, const State<double, 2>&, double t, double dt) {
        return comet.exact(0, t + dt);
    }
};

/// The comet for some orbits. Over it, faint, the ellipse on which it should stay.
template <class Method>
course::Image orbit_panel(int width, int height, int steps_per_orbit, int orbits) {
    const float view = 2.2f, pixel = view / float(height);
    particle_loop::Canvas canvas = make_panel(width, height, {-1.0f, 0.1f}, view);
    const Kepler comet;
    const double dt = 2 * kPi / steps_per_orbit;
    State<double, 2> s = comet.exact(0, 0);
    for (int k = 0; k < orbits * steps_per_orbit; ++k) {
        const State<double, 2> next = Method::step(comet, s, k * dt, dt);
        const float age = float(k) / float(orbits * steps_per_orbit);
        glow(canvas, glm::vec2(s.x), glm::vec2(next.x), 0.8f * pixel, 0.25f * colour_of_age(age));
        s = next;
    }
    for (int k = 0; k < 720; ++k)
        canvas.spot(glm::vec3(glm::vec2(comet.exact(0, 2 * kPi * k / 720).x), 0), 0.6f * pixel,
                    glm::vec3(0.10f));
    for (float glow_px = 2; glow_px < 12;
         glow_px *= 1.5f)  // the sun: soft spots in each other, so that no rim is seen
        canvas.spot(glm::vec3(0), glow_px * pixel, 4 / (glow_px * glow_px) * glm::vec3(2.0f, 1.4f, 0.6f));
    course::Image image = canvas.develop();
    write(image, Method::kName, std::max(1, height / 150));
    return image;
}

/// A disc of starts in the plane of x and v, and what becomes of it step after step. The true motion turns
/// the disc about the middle, and changes neither its size nor its shape.
template <class Method>
course::Image phase_panel(int width, int height, double dt_s, int steps) {
    const float view = 5.2f, pixel = view / float(height);
    particle_loop::Canvas canvas = make_panel(width, height, {0, 0}, view);
    for (int k = 0; k < 400; ++k) {
        const float a = float(2 * kPi) * float(k) / 400;
        canvas.spot({1.4f * std::cos(a), 1.4f * std::sin(a), 0}, 0.7f * pixel, glm::vec3(0.12f));
    }
    const Oscillator system;
    constexpr int kRings = 24;
    for (int ring = 0; ring < kRings; ++ring)
        for (int k = 0; k < 6 * ring + 1; ++k) {
            const double r = 0.38 * ring / (kRings - 1), a = 2 * kPi * k / (6 * ring + 1);
            State<double, 1> s =
                begin(system, 0.0, Vec<double, 1>(1.4 + r * std::cos(a)), Vec<double, 1>(r * std::sin(a)));
            const bool rim = ring == kRings - 1;
            for (int n = 0; n <= steps; ++n) {
                const glm::vec3 light = colour_of_age(float(n) / float(steps));
                canvas.spot({float(s.x.x), float(s.v.x), 0}, 1.6f * pixel, (rim ? 0.45f : 0.09f) * light);
                s = Method::step(system, s, 0.0, dt_s);
            }
        }
    course::Image image = canvas.develop();
    write(image, Method::kName, std::max(1, height / 200));
    return image;
}

/// Six panels of three to a row, together about `width` pixels wide.
template <class Panel>
course::Image six_panels(int width, Panel&& panel) {
    constexpr int kGap = 4;
    const int each = std::max(16, (width - 4 * kGap) / 3);
    return course::contact_sheet(panel(each), 3, kGap);
}

/// Each method pays for the same number of force evaluations an orbit.
inline course::Image draw_orbits(int width, int evaluations_per_orbit, int orbits) {
    return six_panels(width, [&](int each) {
        std::vector<course::Image> panels;
        for_each_method([&](auto method) {
            using Method = decltype(method);
            panels.push_back(orbit_panel<Method>(each, each * 3 / 4,
                                                 evaluations_per_orbit / Method::kEvaluations, orbits));
        });
        panels.push_back(orbit_panel<ExactComet>(each, each * 3 / 4, evaluations_per_orbit, orbits));
        return panels;
    });
}

inline course::Image draw_phase(int width, double dt_s, int steps) {
    return six_panels(width, [&](int each) {
        std::vector<course::Image> panels;
        for_each_method(
            [&](auto method) { panels.push_back(phase_panel<decltype(method)>(each, each, dt_s, steps)); });
        panels.push_back(phase_panel<ImplicitEuler>(each, each, dt_s, steps));
        return panels;
    });
}

}  // namespace integrators
