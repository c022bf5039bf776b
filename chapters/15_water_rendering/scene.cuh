/// @file
/// The scenes of this chapter: a tank, water in it, what moves the water, and from where it is seen.
#pragma once
#include <Random123/philox.h>

#include <cmath>
#include <string>
#include <vector>

#include "12_obstacles/scene.cuh"
#include "15_water_rendering/look.h"
#include "common/camera.h"

namespace water {

/// Water at the start: a box, or the ball in it.
struct Body {
    glm::vec3 low_m, size_m;
    bool round = false;
    float falls_m_per_s = 0;

    bool holds(glm::vec3 x) const {
        const glm::vec3 off = (x - low_m) / size_m - 0.5f;  // -1/2 to 1/2
        if (round) return glm::dot(off, off) <= 0.25f;
        return glm::all(glm::greaterThanEqual(off, glm::vec3(-0.5f))) &&
               glm::all(glm::lessThan(off, glm::vec3(0.5f)));
    }
};

/// A pump on the floor of the pool: whatever comes into its throat goes up at least that fast.
struct Pump {
    glm::vec3 middle_m{0};  ///< of the throat's lower end
    float radius_m = 0, height_m = 0, speed_m_per_s = 0;
};

struct WaterScene {
    std::string name;
    Stage stage;  ///< its ball stands in the way of the water
    std::vector<Body> bodies;
    Pump pump;
    course::OrbitCamera view;
    float field_of_view_rad = 0.5f;

    course::Camera camera() const {
        course::Camera lens;
        lens.field_of_view_rad = field_of_view_rad;
        return view.camera(lens);
    }
};

//! [scenes]
inline std::vector<WaterScene> all_scenes() {
    const auto view = [](glm::vec3 target_m, float distance_m, float yaw_rad, float pitch_rad) {
        course::OrbitCamera orbit;
        orbit.target_m = target_m;
        orbit.distance_m = distance_m;
        orbit.yaw_rad = yaw_rad;
        orbit.pitch_rad = pitch_rad;
        return orbit;
    };
    const glm::vec3 origin(0);
    // A cube of water along the left wall, held by a gate that is gone at t = 0.
    WaterScene dam{"dam_break", {origin, {0.9f, 0.8f, 0.4f}, {}}, {{origin, {0.4f, 0.4f, 0.4f}}}, {}, {}};
    dam.view = view({0.45f, 0.24f, 0.2f}, 1.8f, 0.5f, 0.2f);
    // A ball of water, as it falls into a pool.
    WaterScene drop{"drop", {origin, {0.6f, 0.5f, 0.6f}, {}}, {{origin, {0.6f, 0.1f, 0.6f}}}, {}, {}};
    drop.bodies.push_back({{0.2f, 0.2f, 0.2f}, {0.2f, 0.2f, 0.2f}, true, 1.5f});
    drop.view = view({0.3f, 0.1f, 0.3f}, 1.35f, 0.45f, 0.26f);
    // A pump throws water up from the floor of a pool.
    WaterScene fountain{
        "fountain_into_pool", {origin, {0.6f, 0.6f, 0.6f}, {}}, {{origin, {0.6f, 0.16f, 0.6f}}}, {}, {}};
    fountain.pump = {{0.3f, 0.03f, 0.3f}, 0.032f, 0.11f, 2.8f};
    fountain.view = view({0.3f, 0.2f, 0.3f}, 1.6f, 0.45f, 0.22f);
    // Chapter 12's wave, and the ball that stands in its way.
    WaterScene wave{
        "wave_around_sphere", {origin, {0.9f, 0.6f, 0.4f}, {}}, {{origin, {0.4f, 0.4f, 0.4f}}}, {}, {}};
    wave.stage.ball = {{0.62f, 0.09f, 0.2f}, 0.09f};
    wave.view = view({0.48f, 0.22f, 0.2f}, 1.72f, 0.5f, 0.22f);
    return {dam, drop, fountain, wave};
}
//! [scenes]

inline const WaterScene& find_scene(const std::vector<WaterScene>& scenes, const std::string& name) {
    for (const WaterScene& scene : scenes)
        if (scene.name == name) return scene;
    throw course::BadInput("there is no scene '" + name + "'");
}

/// Particles of a scene at the start.
struct Start {
    std::vector<float4> position, velocity;
    float spacing_m = 0;
};

//! [fill]
/// Calls add(place, body) for each point of a cubic lattice that lies in a body: layer by layer from the
/// body's floor, what does not fit left free at its sides.
template <class Add>
void for_each_point(const WaterScene& scene, float spacing_m, Add add) {
    for (const Body& body : scene.bodies) {
        const glm::ivec3 n = glm::max(glm::ivec3(1), glm::ivec3(body.size_m / spacing_m + 1e-3f));
        glm::vec3 first = 0.5f * (body.size_m - spacing_m * glm::vec3(n - 1));
        first.y = 0.5f * spacing_m;
        for (int y = 0; y < n.y; ++y)
            for (int z = 0; z < n.z; ++z)
                for (int x = 0; x < n.x; ++x) {
                    const glm::vec3 place = body.low_m + first + spacing_m * glm::vec3(x, y, z);
                    if (body.holds(place)) add(place, body);
                }
    }
}

/// Exactly `particles` of them: of the finest lattice that has so many or more, the last ones are left out.
/// Each is moved by up to a twentieth of the spacing, as in chapter 10.
inline Start fill(const WaterScene& scene, std::uint32_t particles, std::uint64_t seed) {
    Start start;
    double volume_m3 = 0;
    for (const Body& body : scene.bodies)
        volume_m3 += (body.round ? 0.5235988 : 1.0) * body.size_m.x * body.size_m.y * body.size_m.z;
    start.spacing_m = float(1.03 * std::cbrt(volume_m3 / particles));
    for (std::uint32_t count = 0; count < particles; start.spacing_m *= 0.998f) {
        count = 0;
        for_each_point(scene, start.spacing_m, [&](glm::vec3, const Body&) { ++count; });
        if (count >= particles) break;
    }
    const auto low = scene.stage.tank_low_m, high = scene.stage.tank_high_m;
    for_each_point(scene, start.spacing_m, [&](glm::vec3 place, const Body& body) {
        const std::uint32_t i = std::uint32_t(start.position.size());
        if (i == particles) return;
        const auto random =
            r123::Philox4x32()({{i, 0, 0, 0}}, {{std::uint32_t(seed), std::uint32_t(seed >> 32)}});
        const glm::vec3 turn(random[0], random[1], random[2]);  // 0 to 2^32
        place += 0.05f * start.spacing_m * (turn * 0x1p-31f - 1.0f);
        place = glm::clamp(place, low, high);
        start.position.push_back(make_float4(place.x, place.y, place.z, 0));
        start.velocity.push_back(make_float4(0, -body.falls_m_per_s, 0, 0));
    });
    return start;
}
//! [fill]

}  // namespace water
