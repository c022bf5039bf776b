// Chapter 06: spheres are where they should be to the pixel, both handovers give the same bytes, and what
// goes wrong says so.
#include <unistd.h>

#include <fstream>
#include <random>

#include "01_particle_loop/scenes.h"
#include "06_gl_interop/studies.cuh"
#include "common/gl_window.h"
#include "tests/chapters/06_gl_interop_support.h"
#ifdef __CUDASIM__
#include "common/cudasim/cudasim.h"
#endif

using namespace gl_test;
using course::Camera;
using course::GlKind;
using interop::Drawing;
using interop::Handover;
using interop::InteropBuffer;
using interop::Look;
using interop::ParticleRenderer;
using interop::SharedFountain;

// ------------------------------------------------------------------------------------------------- camera

TEST_CASE("camera: look-at, projection and back") {
    Camera camera;
    camera.eye_m = {4, 3, 0};
    camera.target_m = {0, 3, 0};
    // Looking along -x: the world's x is depth, its -z is to the right, its y is up.
    const glm::vec4 seen = camera.view() * glm::vec4(1, 3.5f, -2, 1);
    CHECK(seen.x == doctest::Approx(2).epsilon(1e-6));
    CHECK(seen.y == doctest::Approx(0.5).epsilon(1e-6));
    CHECK(seen.z == doctest::Approx(-3).epsilon(1e-6));

    const glm::mat4 projection = camera.projection(1.6f);
    // The picture's upper edge is half the field of view above its middle.
    const glm::vec4 top = projection * glm::vec4(0, 5 * std::tan(camera.field_of_view_rad / 2), -5, 1);
    CHECK(top.y / top.w == doctest::Approx(1).epsilon(1e-5));
    CHECK(interop::window_depth(camera.near_m, projection) == doctest::Approx(0));
    CHECK(interop::window_depth(camera.far_m, projection) == doctest::Approx(1));

    const glm::mat4 to_clip = projection * camera.view(), back = glm::inverse(to_clip);
    for (const glm::vec3 x : {glm::vec3(0, 3, 0), glm::vec3(-2, 2, 1), glm::vec3(3, 3.2f, -0.1f)}) {
        const glm::vec4 clip = to_clip * glm::vec4(x, 1);
        const glm::vec4 world = back * glm::vec4(glm::vec3(clip) / clip.w, 1);
        // near : far is 1 : 5000, so that fp32 keeps about four digits of a depth on the way back
        CHECK(glm::distance(glm::vec3(world) / world.w, x) < 1e-3f);
    }
}

TEST_CASE("camera: orbit, zoom and pan") {
    course::OrbitCamera orbit;
    orbit.target_m = {1, 2, 3};
    orbit.distance_m = 5;
    orbit.orbit(1.5707963f, 0);
    CHECK(glm::distance(orbit.camera().eye_m, {6, 2, 3}) < 1e-5f);  // a quarter turn: from +z to +x
    orbit.orbit(0, 100);                                            // stops short of straight above
    CHECK(orbit.camera().eye_m.y < 7);
    CHECK(orbit.camera().eye_m.y > 6.99f);
    CHECK(std::isfinite(orbit.camera().view()[0][0]));
    orbit.zoom(1000);
    CHECK(orbit.distance_m >= 0);
    orbit = {};
    const Camera before = orbit.camera();
    orbit.pan(0.25f, 0);  // a quarter of the picture's height to the right
    CHECK(orbit.target_m.x == doctest::Approx(0.25 * 2 * 3 * std::tan(before.field_of_view_rad / 2)));
    CHECK(orbit.target_m.y == doctest::Approx(0));
}

// ------------------------------------------------------------------------------------------------ spheres

namespace {

struct Seen {
    int wrong_cover = 0, at_the_rim = 0, covered = 0;
    double worst_depth = 0, worst_normal = 0;  // metres over radius; length of the difference
};

/// Draws one sphere and compares each pixel with a ray cast on the CPU.
Seen compare_with_rays(glm::vec3 centre_m, float radius_m, Camera camera, int width = 160, int height = 120) {
    ParticleRenderer renderer(width, height, bare_spheres());
    renderer.draw(buffer_of({glm::vec4(centre_m, 0)}), nullptr, 1, radius_m, camera);
    const Surface surface(renderer.surface());
    const glm::dmat4 projection(camera.projection(float(width) / height));
    const glm::dvec3 centre(camera.view() * glm::vec4(centre_m, 1));
    Seen seen;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const glm::dvec3 ray = interop::pixel_ray(x, y, width, height, projection);
            const auto hit = interop::ray_sphere(ray, centre, radius_m, camera.near_m);
            if (surface.covered(x, y)) ++seen.covered;
            // Rays that pass within a thousandth of the radius from the rim, or hit within a millionth of the
            // near plane, may fall to either side: fp32 knows a position 10 m away to 1e-6 m.
            const double nearest = glm::length(glm::cross(ray, centre)) / glm::length(ray);
            const double b = glm::dot(ray, centre) / glm::dot(ray, ray);
            const double chord = std::sqrt(std::max(0.0, radius_m * radius_m - nearest * nearest));
            const double entry = b - chord / glm::length(ray);
            if (std::abs(nearest / radius_m - 1) < 1e-3 || std::abs(entry - camera.near_m) < 1e-6) {
                ++seen.at_the_rim;
                continue;
            }
            if (surface.covered(x, y) != hit.hit) {
                ++seen.wrong_cover;
                continue;
            }
            if (!hit.hit) continue;
            const std::size_t k = std::size_t(y) * width + x;
            const double depth = interop::depth_from_window(surface.depth[k], projection);
            seen.worst_depth = std::max(seen.worst_depth, std::abs(depth - hit.depth_m) / radius_m);
            seen.worst_normal =
                std::max(seen.worst_normal, glm::distance(glm::dvec3(surface.normal_speed[k]), hit.normal));
        }
    return seen;
}

Camera wide_camera() {
    Camera camera;
    camera.eye_m = {0, 0, 0};
    camera.target_m = {0, 0, -1};
    camera.field_of_view_rad = 1.6f;  // 92 degrees: off-centre spheres look like eggs
    camera.near_m = 0.1f;
    camera.far_m = 50;
    return camera;
}

}  // namespace

TEST_CASE("spheres: outline, depth and normal agree with a ray cast") {
    const auto context = context_or_skip();
    struct Case {
        const char* what;
        glm::vec3 centre_m;
        float radius_m;
        bool seen;
    };
    for (const Case& c : {
             Case{"in the middle", {0, 0, -3}, 0.8f, true},
             Case{"in a corner, an ellipse", {2.6f, 1.9f, -2.6f}, 0.5f, true},
             Case{"cut by the picture's edge", {-4.0f, 0.3f, -3}, 0.6f, true},
             Case{"centre outside the picture", {0.5f, 3.35f, -3}, 0.5f, true},
             Case{"reaches behind the eye's plane", {1.2f, 0.2f, -0.3f}, 0.9f, true},
             Case{"all of the picture", {0, 0, -1.2f}, 1.05f, true},
             Case{"the eye is inside", {0.1f, 0, 0.05f}, 1.0f, false},
             Case{"behind the eye", {0, 0, 3}, 1.0f, false},
             Case{"before the near plane", {0.02f, 0, -0.05f}, 0.02f, false},
             Case{"beside the picture", {6, 0, -2}, 0.5f, false},
         }) {
        CAPTURE(c.what);
        const Seen seen = compare_with_rays(c.centre_m, c.radius_m, wide_camera());
        CHECK(seen.wrong_cover == 0);
        CHECK(seen.at_the_rim < 40);  // else the comparison would mean little
        CHECK((seen.covered > 0) == c.seen);
        // Depth: fp32 in the shader and in the depth buffer, near the rim magnified by 1 / cos. Off by 1e-3
        // of the radius cannot be seen; a billboard's flat depth is off by 1.
        CHECK(!(seen.worst_depth > 1e-3));
        CHECK(!(seen.worst_normal > 2e-3));  // stored in half floats: 11 bits each
    }
}

TEST_CASE("spheres: a small one far away keeps its shape") {
    const auto context = context_or_skip();
    Camera camera = wide_camera();
    camera.field_of_view_rad = 0.002f;  // a telescope: 5 mm at 10 m fill half the picture
    camera.near_m = 1;
    const Seen seen = compare_with_rays({0.001f, 0.0005f, -10}, 0.005f, camera);
    CHECK(seen.covered > 1000);
    CHECK(seen.wrong_cover == 0);
    // fp32 knows a point 10 m away to 1e-6 m, which is 2e-4 of this radius; at the rim 1 / cos makes more of
    // it. The textbook's b*b - a*c loses all of it: c is known to 1e-5 m^2, and radius^2 is 2.5e-5 m^2.
    CHECK(!(seen.worst_normal > 0.02));
}

TEST_CASE("spheres: two that intersect meet on the circle they should") {
    const auto context = context_or_skip();
    const Camera camera = wide_camera();
    const glm::vec3 a(0.9f, 0.2f, -2.5f), b(1.5f, 0.5f, -2.2f);
    const float radius = 0.6f;
    const int width = 240, height = 180;
    ParticleRenderer renderer(width, height, bare_spheres());
    const course::GlBuffer position = buffer_of({glm::vec4(a, 0), glm::vec4(b, 0)});
    const course::GlBuffer velocity =
        buffer_of({{1, 0, 0, 0}, {0, 3, 0, 0}});  // the speed tells which is seen
    renderer.draw(position, &velocity, 2, radius, camera);
    const Surface surface(renderer.surface());
    const glm::dmat4 projection(camera.projection(float(width) / height));
    // Equal spheres meet in the plane half way between their centres: seen points on a's side belong to a.
    const glm::dvec3 middle(0.5f * (a + b)), towards_b(glm::normalize(b - a));
    int seen_a = 0, seen_b = 0, wrong = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const std::size_t k = std::size_t(y) * width + x;
            if (!surface.covered(x, y)) continue;
            const glm::dvec3 p = interop::depth_from_window(surface.depth[k], projection) *
                                 interop::pixel_ray(x, y, width, height, projection);
            const double side_m = glm::dot(p - middle, towards_b);
            const float speed = surface.normal_speed[k].w;
            CHECK((speed == 1 || speed == 3));
            (speed == 1 ? seen_a : seen_b) += 1;
            // 1e-4 m: what the depth buffer resolves at 2.5 m with near = 0.1 m, some ten times over
            if ((speed == 1 && side_m > 1e-4) || (speed == 3 && side_m < -1e-4)) ++wrong;
        }
    CHECK(seen_a > 1000);
    CHECK(seen_b > 1000);
    CHECK(wrong == 0);
}

TEST_CASE("spheres: a position that is not a number draws nothing") {
    const auto context = context_or_skip();
    ParticleRenderer renderer(64, 48, bare_spheres());
    const float nan = std::nanf("");
    renderer.draw(buffer_of({{nan, 0, -2, 0}, {0, 0, nan, 0}, {INFINITY, 0, -2, 0}}), nullptr, 3, 0.5f,
                  wide_camera());
    const Surface surface(renderer.surface());
    for (const float depth : surface.depth) REQUIRE(depth == 1);
}

TEST_CASE("spheres: many triangles come to the impostor, few do not") {
    const auto context = context_or_skip();
    const course::GlBuffer position = buffer_of({{0.4f, -0.2f, -3, 0}});
    const auto surface_of = [&](int rings) {
        Look look = bare_spheres();
        look.mesh_rings = rings;
        ParticleRenderer renderer(160, 120, look);
        renderer.draw(position, nullptr, 1, 0.9f, wide_camera());
        return Surface(renderer.surface());
    };
    const Surface exact = surface_of(0);
    const auto compare = [&](const Surface& mesh, int& other_cover, double& worst_normal) {
        other_cover = 0, worst_normal = 0;
        for (std::size_t k = 0; k < mesh.depth.size(); ++k) {
            if ((mesh.depth[k] < 1) != (exact.depth[k] < 1))
                ++other_cover;
            else if (mesh.depth[k] < 1)
                worst_normal = std::max<double>(
                    worst_normal,
                    glm::distance(glm::vec3(mesh.normal_speed[k]), glm::vec3(exact.normal_speed[k])));
        }
    };
    int other_cover = 0;
    double worst_normal = 0;
    // 64 rings: a corner every 2.8 degrees. The outline lies up to 1 - cos(1.4 degrees) = 3e-4 of the radius
    // inside, 0.01 pixels; a point of it is off by 2.5e-2 of a normal at most.
    compare(surface_of(64), other_cover, worst_normal);
    CHECK(other_cover <= 4);
    CHECK_FALSE(!(worst_normal <= 0.03));
    compare(surface_of(2), other_cover, worst_normal);
    CHECK(other_cover > 100);
}

// ----------------------------------------------------------------------------------------------- extremes

namespace {

/// Linear light of a pixel, all three colours together: 0 to 3.
double brightness(const course::Image& image, int x, int y) {
    double sum = 0;
    for (int c = 0; c < 3; ++c) {
        const double v = image.pixel(x, y)[c] / 255.0;
        sum += v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    }
    return sum;
}

/// The picture of some particles, as spheres with all that belongs to them, or as points.
course::Image extreme_picture(Drawing drawing, const std::vector<glm::vec4>& position,
                              const std::vector<glm::vec4>& velocity, float radius_m = 0.3f,
                              glm::vec3 origin_m = {0, 0, 0}) {
    Camera camera;
    camera.eye_m = origin_m + glm::vec3(0.5f, 1, 4);
    camera.target_m = origin_m;
    Look look = interop::fountain_look(drawing);
    look.region = {origin_m - glm::vec3(1), origin_m + glm::vec3(1)};
    ParticleRenderer renderer(120, 90, look);
    const course::GlBuffer positions = buffer_of(position), velocities = buffer_of(velocity);
    renderer.draw(positions, &velocities, position.size(), radius_m, camera);
    return renderer.image();
}

}  // namespace

TEST_CASE("extremes: a thousand particles at one point look like one") {
    const auto context = context_or_skip();
    const glm::vec4 x(0.1f, 0.2f, 0.3f, 0), v(1, 2, 3, 0);
    for (const Drawing drawing : {Drawing::spheres, Drawing::points}) {
        const course::Image one = extreme_picture(drawing, {x}, {v});
        CHECK(
            extreme_picture(drawing, std::vector<glm::vec4>(1000, x), std::vector<glm::vec4>(1000, v)).rgb ==
            one.rgb);
        CHECK(extreme_picture(drawing, {x, x}, {v, v}).rgb == one.rgb);
        CHECK(extreme_picture(drawing, {x}, {v}, 0.0f).rgb.size() == one.rgb.size());  // a point, or nothing
    }
}

TEST_CASE("extremes: a speed beyond all measure has the last colour, one that is no number the first") {
    const auto context = context_or_skip();
    const glm::vec4 x(0.1f, 0.2f, 0.3f, 0);
    const float nan = std::nanf("");
    for (const Drawing drawing : {Drawing::spheres, Drawing::points}) {
        const course::Image rest = extreme_picture(drawing, {x}, {{0, 0, 0, 0}});
        const course::Image fast = extreme_picture(drawing, {x}, {{100, 0, 0, 0}});  // the top is 7 m/s
        CHECK(rest.rgb != fast.rgb);
        CHECK(extreme_picture(drawing, {x}, {{1e6f, -1e6f, 1e6f, 0}}).rgb == fast.rgb);
        CHECK(extreme_picture(drawing, {x}, {{1e30f, 0, 0, 0}}).rgb == fast.rgb);  // its length: infinity
        CHECK(extreme_picture(drawing, {x}, {{nan, 0, 0, 0}}).rgb == rest.rgb);
    }
}

TEST_CASE("extremes: particles out of reach, or nowhere, leave the picture as it is without them") {
    const auto context = context_or_skip();
    const float nan = std::nanf("");
    const glm::vec4 v(1, 0, 0, 0);
    for (const Drawing drawing : {Drawing::spheres, Drawing::points}) {
        const course::Image none = extreme_picture(drawing, {{0, 0, 100, 0}}, {v});  // behind the eye
        for (const glm::vec4 x : {glm::vec4(nan, 0, 0, 0), glm::vec4(0, INFINITY, 0, 0),
                                  glm::vec4(0, 0, -INFINITY, 0), glm::vec4(1e30f, 0, 0, 0), glm::vec4(nan)})
            CHECK(extreme_picture(drawing, {x}, {v}).rgb == none.rgb);
    }
}

TEST_CASE("extremes: 10 km from the origin the picture is the same, but for a hundredth of a pixel") {
    const auto context = context_or_skip();
    // Floats there are 1 mm apart, and the camera multiplies them before it subtracts: some mm, of a pixel of
    // 4 cm at 4 m. Pixels through which an outline or a line of the floor goes may change, and only those.
    const glm::vec3 origin_m(1e4f, 0, 1e4f);
    const course::Image here = extreme_picture(Drawing::spheres, {{0, 0, 0, 0}}, {{1, 0, 0, 0}});
    const course::Image far =
        extreme_picture(Drawing::spheres, {glm::vec4(origin_m, 0)}, {{1, 0, 0, 0}}, 0.3f, origin_m);
    int changed = 0, sphere = 0;
    const course::Image empty = extreme_picture(Drawing::spheres, {{0, 0, 100, 0}}, {{1, 0, 0, 0}});
    for (int y = 0; y < here.height; ++y)
        for (int x = 0; x < here.width; ++x) {
            sphere += brightness(here, x, y) != brightness(empty, x, y);
            changed += std::abs(brightness(here, x, y) - brightness(far, x, y)) > 0.1;
        }
    CHECK(sphere > 200);
    CHECK(changed <= sphere / 10);
}

TEST_CASE("extremes: one droplet and two are handed over and drawn; none is an error that says so") {
    const auto context = context_or_skip();
    const particle_loop::Fountain scene = particle_loop::make_scene("crown");
    for (const Handover handover : {Handover::shared, Handover::copied}) {
        CHECK_THROWS_AS(SharedFountain(0, scene, handover), course::BadInput);
        for (const std::uint32_t n : {1u, 2u}) {
            CAPTURE(n);
            SharedFountain fountain(n, scene, handover);
            interop::grow(fountain, scene);
            CHECK(fountain.born() == n);
            ParticleRenderer renderer(32, 32, interop::fountain_look(Drawing::spheres));
            CHECK_NOTHROW(interop::draw(renderer, fountain, interop::first_view().camera()));
        }
    }
}

// ----------------------------------------------------------------------------------------------- pictures

namespace {

/// Pixel (x, y from the top) that shows world point p.
glm::ivec2 pixel_of(glm::vec3 p, const Camera& camera, int width, int height) {
    const glm::vec4 clip = camera.projection(float(width) / height) * camera.view() * glm::vec4(p, 1);
    return {int((0.5f + 0.5f * clip.x / clip.w) * width), int((0.5f - 0.5f * clip.y / clip.w) * height)};
}

}  // namespace

TEST_CASE("picture: linear light is written as sRGB") {
    const auto context = context_or_skip();
    Camera up = wide_camera();
    up.target_m = {0, 1, 0.001f};
    up.field_of_view_rad = 0.01f;
    for (const Drawing drawing : {Drawing::spheres, Drawing::points}) {
        Look look = bare_spheres();
        look.drawing = drawing;
        ParticleRenderer renderer(16, 16, look);
        renderer.draw(buffer_of({{0, 0, 0, 0}}), nullptr, 0, 0.1f, up);
        const course::Image image = renderer.image();
        for (int c = 0; c < 3; ++c)  // 1: the driver's rounding of the last bit
            CHECK(std::abs(image.pixel(8, 8)[c] - course::to_srgb(look.light.sky[c])) <= 1);
    }
}

TEST_CASE("picture: points are where they should be, in the colour of their speed") {
    const auto context = context_or_skip();
    Look look = bare_spheres();
    look.drawing = Drawing::points;
    look.palette.top_m_per_s = 6;
    Camera camera;
    camera.eye_m = {1, 2, 5};
    std::vector<glm::vec4> position, velocity;
    for (int k = 0; k < 6; ++k) {
        position.push_back({0.4f * k - 1, 0.3f * k - 0.5f, 0.2f * k, 0});
        velocity.push_back({0, -2.0f * k, 0, 0});  // 0, 1/3, 2/3, 3/3 of the palette's top speed, and beyond
    }
    ParticleRenderer renderer(320, 240, look);
    const course::GlBuffer positions = buffer_of(position), velocities = buffer_of(velocity);
    renderer.draw(positions, &velocities, 6, 0.05f, camera);
    const course::Image moving = renderer.image();
    renderer.draw(positions, nullptr, 6, 0.05f, camera);
    const course::Image resting = renderer.image();
    for (int k = 0; k < 6; ++k) {
        CAPTURE(k);
        const glm::ivec2 at = pixel_of(glm::vec3(position[k]), camera, 320, 240);
        for (int c = 0; c < 3; ++c) {
            CHECK(std::abs(moving.pixel(at.x, at.y)[c] -
                           course::to_srgb(look.palette.colours[std::min(k, 3)][c])) <= 1);
            CHECK(std::abs(resting.pixel(at.x, at.y)[c] - course::to_srgb(look.palette.colours[0][c])) <= 1);
        }
    }
}

TEST_CASE("picture: a sphere's shadow falls where the light sends it") {
    const auto context = context_or_skip();
    Camera camera;
    camera.eye_m = {0, 3, 4};
    camera.target_m = {0, 0, 0};
    Look look = bare_spheres();
    look.region = {{-1, 0, -1}, {1, 1, 1}};
    look.floor_tile_m = 100;  // no lines near
    look.light.towards = glm::normalize(glm::vec3(0.5f, 1, 0.2f));
    const glm::vec3 centre(0.3f, 0.7f, 0.1f);
    const glm::vec3 foot = centre - look.light.towards * (centre.y / look.light.towards.y);
    const course::GlBuffer position = buffer_of({glm::vec4(centre, 0)});
    const auto draw = [&](bool shadows) {
        look.shadows = shadows;
        ParticleRenderer renderer(200, 150, look);
        renderer.draw(position, nullptr, 1, 0.15f, camera);
        return renderer.image();
    };
    const course::Image with = draw(true), without = draw(false);
    const auto brightness_at = [&](const course::Image& image, glm::vec3 p) {
        const glm::ivec2 at = pixel_of(p, camera, 200, 150);
        return brightness(image, at.x, at.y);
    };
    CHECK(brightness_at(with, foot) < 0.7 * brightness_at(without, foot));
    for (const glm::vec3 off : {glm::vec3(0.35f, 0, 0), glm::vec3(-0.35f, 0, 0), glm::vec3(0, 0, 0.35f)})
        CHECK(brightness_at(with, foot + off) == brightness_at(without, foot + off));
    // A sphere alone puts no shadow on the side of it that faces the light.
    int compared = 0;
    for (int y = 0; y < 150; ++y)
        for (int x = 0; x < 200; ++x) {
            const glm::dmat4 projection(camera.projection(200.0f / 150));
            const auto hit = interop::ray_sphere(interop::pixel_ray(x, 149 - y, 200, 150, projection),
                                                 camera.view() * glm::vec4(centre, 1), 0.15, camera.near_m);
            const glm::vec3 to_light = glm::mat3(camera.view()) * look.light.towards;
            if (!hit.hit || !(glm::dot(glm::vec3(hit.normal), to_light) > 0)) continue;
            ++compared;
            CHECK(brightness(with, x, y) == brightness(without, x, y));
        }
    CHECK(compared > 50);
}

TEST_CASE("picture: near spheres take light from each other, far ones do not") {
    const auto context = context_or_skip();
    const auto draw = [&](float gap_m, float occlusion_radii) {
        Look look = bare_spheres();
        look.region.low_m.y = -50;  // no floor near
        look.occlusion_radii = occlusion_radii;
        ParticleRenderer renderer(120, 80, look);
        const float x = 0.3f + 0.5f * gap_m;
        renderer.draw(buffer_of({{-x, 0, -3, 0}, {x, 0, -3, 0}}), nullptr, 2, 0.3f, wide_camera());
        const course::Image image = renderer.image();
        long sum = 0;
        for (const std::uint8_t byte : image.rgb) sum += byte;
        return sum;
    };
    CHECK(draw(0, 3) < draw(0, 0));
    CHECK(draw(2.5f, 3) == draw(2.5f, 0));  // nearest points 2.5 m apart, reach 0.9 m
}

TEST_CASE("picture: tank edges lie on the box, and are faint behind spheres") {
    const auto context = context_or_skip();
    Camera camera;
    camera.eye_m = {1.5f, 1.2f, 3.5f};
    for (const Drawing drawing : {Drawing::spheres, Drawing::points}) {
        Look look = bare_spheres();
        look.drawing = drawing;
        look.region = {{-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}};
        const auto draw = [&](bool edges, std::size_t count) {
            look.region_edges = edges;
            ParticleRenderer renderer(320, 240, look);
            renderer.draw(buffer_of({{0, 0, 0, 0}}), nullptr, count, 0.3f, camera);
            return renderer.image();
        };
        const course::Image plain = draw(false, 0), box = draw(true, 0), box_with = draw(true, 1),
                            with = draw(false, 1);
        const auto gain = [&](const course::Image& a, const course::Image& b, glm::vec3 p) {
            const glm::ivec2 at = pixel_of(p, camera, 320, 240);
            return brightness(a, at.x, at.y) - brightness(b, at.x, at.y);
        };
        for (const glm::vec3 p :
             {glm::vec3(0.5f, 0, 0.5f), glm::vec3(0, 0.5f, 0.5f), glm::vec3(0.5f, 0.5f, 0)})
            CHECK(gain(box, plain, p) > 0.8);          // the line's colour sums to 2.77, 3/4 opaque
        const glm::vec3 hidden(-0.5f, -0.22f, -0.5f);  // seen through the sphere
        CHECK(gain(box, plain, hidden) > 0.8);
        CHECK(gain(box_with, with, hidden) > 0);
        CHECK(gain(box_with, with, hidden) < 0.4);
    }
}

TEST_CASE("picture: drawn twice, the same bytes") {
    const auto context = context_or_skip();
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(-1, 1);
    std::vector<glm::vec4> cloud(500), speeds(500);
    for (glm::vec4& x : cloud) x = {unit(random), unit(random), unit(random), 0};
    for (glm::vec4& v : speeds) v = {3 * unit(random), 0, 0, 0};
    Camera camera;
    camera.eye_m = {1, 2, 3};
    const course::GlBuffer position = buffer_of(cloud), velocity = buffer_of(speeds);
    Look look;
    look.region = {{-1, -1, -1}, {1, 1, 1}};
    const auto draw = [&] {
        ParticleRenderer renderer(160, 120, look);
        renderer.draw(position, &velocity, 500, 0.08f, camera);
        return renderer.image().rgb;
    };
    CHECK(draw() == draw());
}

TEST_CASE("renderer: makes only what the look needs, and leaves nothing behind") {
    const auto context = context_or_skip();
    const int live_before = course::gl_count().live;
    const auto made = [](GlKind kind) { return course::gl_count(kind).made; };
    struct Case {
        Drawing drawing;
        bool shadows, edges;
        int textures, framebuffers, programs;
    };
    // Picture: 2 textures in 1 framebuffer. Spheres: surface (2), and the shadow map (1) if there are
    // shadows.
    for (const Case& c :
         {Case{Drawing::points, true, false, 2, 1, 2}, Case{Drawing::points, true, true, 2, 1, 3},
          Case{Drawing::spheres, false, false, 4, 2, 2}, Case{Drawing::spheres, true, false, 5, 3, 3},
          Case{Drawing::spheres, true, true, 5, 3, 4}}) {
        Look look;
        look.drawing = c.drawing;
        look.shadows = c.shadows;
        look.region_edges = c.edges;
        const int textures = made(GlKind::texture), framebuffers = made(GlKind::framebuffer),
                  programs = made(GlKind::program), buffers = made(GlKind::buffer);
        {
            ParticleRenderer renderer(32, 32, look);
            CHECK(made(GlKind::texture) - textures == c.textures);
            CHECK(made(GlKind::framebuffer) - framebuffers == c.framebuffers);
            CHECK(made(GlKind::program) - programs == c.programs);
            CHECK(made(GlKind::buffer) == buffers);  // no colours, no corners of quads
        }
        CHECK(course::gl_count().live == live_before);
    }
}

TEST_CASE("renderer: refuses more particles than the buffer holds, takes none at all") {
    const auto context = context_or_skip();
    ParticleRenderer renderer(32, 32, Look{});
    const course::GlBuffer two = buffer_of({{0, 0, 0, 0}, {1, 0, 0, 0}}), one = buffer_of({{0, 0, 0, 0}});
    CHECK_THROWS_AS(renderer.draw(two, nullptr, 3, 0.1f, Camera{}), std::logic_error);
    CHECK_THROWS_AS(renderer.draw(two, &one, 2, 0.1f, Camera{}), std::logic_error);
    CHECK_NOTHROW(renderer.draw(two, nullptr, 0, 0.1f, Camera{}));
    CHECK_NOTHROW(renderer.draw(two, nullptr, 2, 0.1f, Camera{}));
}

// ------------------------------------------------------------------------------------------------ handover

namespace {

std::vector<float4> bytes_in_gl(const course::GlBuffer& buffer) {
    std::vector<float4> values(buffer.bytes() / sizeof(float4));
    glBindBuffer(GL_ARRAY_BUFFER, buffer.id());
    glGetBufferSubData(GL_ARRAY_BUFFER, 0, GLsizeiptr(buffer.bytes()), values.data());
    course::check_gl("reading a buffer");
    return values;
}

__global__ void count_up_kernel(int* values, int n) {
    const int i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i < n) values[i] += i;
}

// Stands for a driver whose OpenGL and CUDA are not on the same device.
cudaError_t refuse(cudaGraphicsResource**, GLuint, unsigned) {
    return cudaErrorInvalidValue;
}

}  // namespace

TEST_CASE("handover: what a kernel writes arrives, and is still there the next time") {
    const auto context = context_or_skip();
    for (const Handover handover : {Handover::shared, Handover::copied}) {
        const int n = 1000;
        InteropBuffer<int> buffer(n, handover);
        CHECK(buffer.handover() == handover);  // shared works here, or this machine's GL and CUDA do not fit
        CUDA_CHECK(cudaMemset(buffer.map(), 0, n * sizeof(int)));
        buffer.unmap();
        for (int k = 0; k < 3; ++k) {
            count_up_kernel<<<4, 256>>>(buffer.map(), n);
            CUDA_CHECK(cudaGetLastError());
            buffer.unmap();
        }
        std::vector<int> got(n), expected(n);
        glBindBuffer(GL_ARRAY_BUFFER, buffer.gl_buffer().id());
        glGetBufferSubData(GL_ARRAY_BUFFER, 0, n * sizeof(int), got.data());
        for (int i = 0; i < n; ++i) expected[i] = 3 * i;
        course::check_equal(got, expected, "value", "element");
    }
}

TEST_CASE("handover: shared and copied give the same bytes and the same pixels, and chapter 03's numbers") {
    const auto context = context_or_skip();
    const std::uint32_t n = 5000;  // no multiple of the block
    const particle_loop::Fountain scene = particle_loop::make_scene("crown");
    SharedFountain shared(n, scene, Handover::shared), copied(n, scene, Handover::copied);
    course::DeviceBuffer<float4> position(n), velocity(n);
    first_kernels::launch_fountain_clear(position.data(), velocity.data(), n);
    for (std::uint32_t step = 0; step < 200; ++step) {
        shared.step();
        copied.step();
        first_kernels::launch_fountain_step(position.data(), velocity.data(), n, scene, step);
    }
    course::check_equal(bytes_in_gl(shared.position().gl_buffer()), position.download(), "position",
                        "droplet");
    course::check_equal(bytes_in_gl(copied.position().gl_buffer()), position.download(), "position",
                        "droplet");
    course::check_equal(bytes_in_gl(shared.velocity().gl_buffer()), velocity.download(), "velocity",
                        "droplet");
    course::check_equal(bytes_in_gl(copied.velocity().gl_buffer()), velocity.download(), "velocity",
                        "droplet");

    Camera camera;
    camera.eye_m = {0, 2, 7};
    camera.target_m = {0, 1, 0};
    for (const Drawing drawing : {Drawing::points, Drawing::spheres}) {
        ParticleRenderer renderer(160, 120, interop::fountain_look(drawing));
        interop::draw(renderer, shared, camera);
        const course::Image a = renderer.image();
        interop::draw(renderer, copied, camera);
        const course::Image b = renderer.image();
        CHECK(a.rgb == b.rgb);
        renderer.draw(shared.position().gl_buffer(), nullptr, 0, 0.01f, camera);
        CHECK(a.rgb != renderer.image().rgb);  // the fountain is in the picture at all
    }
}

TEST_CASE("handover: where CUDA refuses OpenGL's buffer, a copy is made, and the reason is told") {
    const auto context = context_or_skip();
    InteropBuffer<float4> refused(100, Handover::shared, refuse);
    CHECK(refused.handover() == Handover::copied);
    CHECK(refused.why().find("cudaErrorInvalidValue") != std::string::npos);
    CHECK(cudaGetLastError() == cudaSuccess);  // no error is left for the next check to trip over
    CUDA_CHECK(cudaMemset(refused.map(), 0, 100 * sizeof(float4)));
    refused.unmap();
    CHECK(bytes_in_gl(refused.gl_buffer())[99].w == 0);
    CHECK(InteropBuffer<float4>(100, Handover::copied).why().find("asked for") != std::string::npos);
    CHECK(InteropBuffer<float4>(100).why().find("no copy") != std::string::npos);
}

TEST_CASE("handover: a buffer belongs to one side at a time") {
    const auto context = context_or_skip();
    for (const Handover handover : {Handover::shared, Handover::copied}) {
        const int live = course::gl_count().live;
        {
            InteropBuffer<float4> buffer(10, handover);
            CHECK_THROWS_WITH_AS(buffer.unmap(), "unmap(): OpenGL has this buffer already", std::logic_error);
            buffer.map();
            CHECK_THROWS_WITH_AS(buffer.map(), "map(): CUDA has this buffer already", std::logic_error);
            CHECK_THROWS_WITH_AS(buffer.gl_buffer(),
                                 "gl_buffer(): CUDA has this buffer; unmap() it before drawing",
                                 std::logic_error);
            buffer.unmap();
            CHECK_NOTHROW(buffer.gl_buffer());
            buffer.map();  // destroyed while mapped: unmaps by itself
        }
        CHECK(course::gl_count().live == live);
        course::check_gl("giving a mapped buffer back");
    }
}

TEST_CASE("handover: the renderer refuses a buffer that OpenGL knows to be mapped") {
    const auto context = context_or_skip();
    course::require_simulator();  // it maps as OpenGL does; what a GPU's driver maps, OpenGL does not know
    ParticleRenderer renderer(32, 32, Look{});
    InteropBuffer<float4> buffer(10);
    const course::GlBuffer& around_the_check = buffer.gl_buffer();
    buffer.map();
    CHECK_THROWS_WITH_AS(renderer.draw(around_the_check, nullptr, 10, 0.1f, Camera{}),
                         "a buffer to draw from is mapped: unmap it first", std::logic_error);
    buffer.unmap();
    CHECK_NOTHROW(renderer.draw(around_the_check, nullptr, 10, 0.1f, Camera{}));
}

#ifdef __CUDASIM__
TEST_CASE("--explain tells the truth: launches, device memory and OpenGL buffers") {
    const auto context = context_or_skip();
    const std::uint32_t n = 300;
    for (const Handover handover : {Handover::shared, Handover::copied}) {
        interop::FountainScene scene;
        scene.handover = handover;
        const interop::Needs needs = interop::needs(scene);
        const int buffers = course::gl_count(GlKind::buffer).made;
        const cudasim::Recording all;
        SharedFountain fountain(n, particle_loop::make_scene("crown"), handover);
        CHECK(course::gl_count(GlKind::buffer).made - buffers == needs.gl_buffers);
        CHECK(all.bytes() == n * needs.device_bytes_per_droplet);
        CHECK(fountain.position().gl_buffer().bytes() + fountain.velocity().gl_buffer().bytes() ==
              n * needs.gl_bytes_per_droplet);
        const cudasim::Recording one_step;
        fountain.step();
        CHECK(one_step.launches().size() == std::size_t(needs.kernels_per_step));
        CHECK(one_step.count("fountain_step_float4_kernel") == 1);
        CHECK(one_step.allocations() == 0);
    }
    interop::FountainScene numbers;
    numbers.points = numbers.spheres = false;
    CHECK(interop::needs(numbers).gl_buffers == 0);
    CHECK(interop::needs(numbers).device_bytes_per_droplet == 32);
}
#endif

// ---------------------------------------------------------------------------------------------- the studies

TEST_CASE("study spheres: more rays come nearer to the picture, few triangles do not") {
    const auto context = context_or_skip();
    const particle_loop::Fountain scene = particle_loop::make_scene("crown");
    SharedFountain fountain(500, scene);
    interop::grow(fountain, scene);
    interop::SpherePicture picture;
    picture.width_px = 160, picture.height_px = 90;
    const auto draw = [&](int samples, int rings) {
        picture.look.samples_per_axis = samples;
        picture.look.mesh_rings = rings;
        ParticleRenderer renderer = picture.renderer();
        picture.draw(renderer, fountain);
        return renderer.image();
    };
    const course::Image reference = draw(6, 0);
    CHECK(interop::difference(reference, reference) == 0);
    const double one = interop::difference(draw(1, 0), reference),
                 four = interop::difference(draw(2, 0), reference),
                 nine = interop::difference(draw(3, 0), reference),
                 coarse = interop::difference(draw(3, 2), reference);
    // A mean of k rays spread evenly: the error falls at least as 1 / sqrt(k), by 2 and by 1.5.
    CHECK_FALSE(!(four < one / 2));
    CHECK_FALSE(!(nine < four / 1.5));
    CHECK_FALSE(!(coarse > 2 * nine));
}

TEST_CASE("study handover: the comparison of bytes notices one") {
    const auto context = context_or_skip();
    const course::GlBuffer a = buffer_of({{1, 2, 3, 4}, {5, 6, 7, 8}}),
                           b = buffer_of({{1, 2, 3, 4}, {5, 6, 7, 8.5}});
    CHECK(interop::different_bytes(a, a) == 0);
    CHECK(interop::different_bytes(a, b) == 1);  // 8 and 8.5: 0x41000000 and 0x41080000
}

// ---------------------------------------------------------------------------------------- the program from
// outside

namespace {

const std::string kSmall = " --particles 500 --steps 20 --width 160 --height 120 --repeats 1 --out ";

// No driver can be found: EGL then offers no device and no platform that works.
const std::string kNoDriver = "__EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent ";

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("program: pictures and table") {
    context_or_skip();
    const TemporaryFolder folder;
    const Ended ended = run(program("ch06_gl_interop") + kSmall + folder.path.string());
    CAPTURE(ended.output);
    CHECK(ended.exit_code == 0);
    for (const char* file : {"fountain_points.png", "fountain_spheres.png", "result.json"})
        CHECK(std::filesystem::exists(folder.path / file));
    CHECK(contains(ended.output, "no copy"));
    const Ended copied = run(program("ch06_gl_interop") + kSmall + folder.path.string() + " --no-interop");
    CHECK(copied.exit_code == 0);
    CHECK(contains(copied.output, "through a copy in host memory (asked for)"));
}

TEST_CASE("program: numbers alone and --explain need no OpenGL at all") {
    const TemporaryFolder folder;
    const Ended info = run(kNoDriver + program("course_glinfo"));
    CHECK(info.exit_code == 1);
    CHECK(contains(info.output, "libgl1-mesa-dri"));
    const Ended pictures = run(kNoDriver + program("ch06_gl_interop") + kSmall + folder.path.string());
    CHECK(pictures.exit_code == 2);
    CHECK(contains(pictures.output, "libgl1-mesa-dri"));
    for (const char* option :
         {" --draw none", " --explain", " --explain --draw none", " --explain --no-interop"}) {
        CAPTURE(option);
        const Ended ended =
            run(kNoDriver + program("ch06_gl_interop") + kSmall + folder.path.string() + option);
        CHECK(ended.exit_code == 0);
    }
}

TEST_CASE("program: a broken shader is named, with the driver's message") {
    context_or_skip();
    const TemporaryFolder folder;
    const std::filesystem::path shaders = folder.path / "shaders";
    std::filesystem::copy(course::shader_folder(), shaders);
    std::ofstream(shaders / "sphere_impostor.frag")
        << "#version 330 core\nout vec4 c;\nvoid main() { c = nonsense; }\n";
    const std::string command = "COURSE_SHADER_DIR=" + shaders.string() + " " + program("ch06_gl_interop") +
                                kSmall + (folder.path / "out").string();
    const Ended broken = run(command);
    CAPTURE(broken.output);
    CHECK(broken.exit_code == 2);
    CHECK(contains(broken.output, "sphere_impostor.frag does not compile"));
    CHECK(contains(broken.output, "nonsense"));
    CHECK(contains(broken.output, "3"));  // the line

    std::filesystem::remove(shaders / "sphere_impostor.frag");
    const Ended missing = run(command);
    CHECK(missing.exit_code == 2);
    CHECK(contains(missing.output, "cannot read the shader"));

    // Compiles, but two functions that belong together are not: found at linking.
    std::filesystem::copy(course::shader_folder() / "sphere_impostor.frag", shaders);
    std::ofstream(shaders / "palette.frag")
        << "#version 330 core\nfloat another_function() { return 1.0; }\n";
    const Ended unlinked = run(command);
    CAPTURE(unlinked.output);
    CHECK(unlinked.exit_code == 2);
    CHECK(contains(unlinked.output, "palette.frag"));
    CHECK(contains(unlinked.output, "do not link"));
}

TEST_CASE("program: pictures too narrow to be useful, and too large for the driver") {
    context_or_skip();
    const TemporaryFolder folder;
    const std::string small =
        program("ch06_gl_interop") + " --particles 100 --steps 20 --repeats 1 --out " + folder.path.string();
    for (const char* size :
         {" --width 16 --height 16", " --width 16 --height 2048", " --width 2048 --height 16"}) {
        const Ended ended = run(small + size);
        CHECK_MESSAGE(ended.exit_code == 0, ended.output);
    }
    GLint largest = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
    if (largest < 32768) {  // two samples a pixel and axis: twice the width
        const Ended ended = run(small + " --width 16384 --height 16 --draw spheres");
        CHECK(ended.exit_code == 2);
        CHECK_MESSAGE(contains(ended.output, "OpenGL can't draw a picture of 32768 x 32 pixels here"),
                      ended.output);
    }
}

TEST_CASE("program: the study of the handover, and none without OpenGL") {
    context_or_skip();
    const TemporaryFolder folder;
    const std::string study =
        program("ch06_gl_interop") + " --study handover --quick --out " + folder.path.string();
    const Ended ended = run(study);
    CHECK_MESSAGE(ended.exit_code == 0, ended.output);
    CHECK(contains(ended.output, "copy through the host"));
    CHECK(std::filesystem::exists(folder.path / "study_handover.csv"));
    const Ended without = run(kNoDriver + study);
    CHECK(without.exit_code == 2);
    CHECK(contains(without.output, "libgl1-mesa-dri"));
}

TEST_CASE("program: more droplets than the machine can hold") {
    const double memory = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
    if (memory > 2147483647.0 * 32) course::skip("this machine can hold them");
    const TemporaryFolder folder;
    for (const std::string draw : {"none", "points"}) {
        const Ended ended = run(program("ch06_gl_interop") + " --particles 2147483647 --steps 1 --draw " +
                                draw + " --out " + folder.path.string());
        CHECK(ended.exit_code == 2);
        CHECK_MESSAGE(contains(ended.output, "GiB of memory"), ended.output);
    }
}

TEST_CASE("program: bad options") {
    for (const std::string options : {" --draw cubes", " --repeats 0", " --frames -1", " --scene pond",
                                      " --particles 0", " --dt nan", " --dt -1", " --dt 1e-30", " --dt 1e6",
                                      " --width 0", " --width 15", " --height -720", " --height 16385"}) {
        CAPTURE(options);
        CHECK(run(program("ch06_gl_interop") + options + " --explain").exit_code == 2);
    }
    const TemporaryFolder folder;
    CHECK(run(program("ch06_gl_interop") + " --study weather --out " + folder.path.string()).exit_code == 2);
}

// ------------------------------------------------------------------------------------------------- windows

namespace {

/// Runs this case again inside a virtual display if there is none. @return whether to go on here
bool display_or_run_under_xvfb(const std::string& case_name) {
    if (std::getenv("DISPLAY")) return true;
    if (run("command -v xvfb-run").exit_code != 0) course::skip("no display and no xvfb-run (Debian: xvfb)");
    const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
    // Two that start at once would take the same display number: begin to look for one at different places.
    const std::string display = std::to_string(100 + getpid() % 1000);
    const Ended ended = run("xvfb-run -a -n " + display + " -s '-screen 0 800x600x24' " + self +
                            " --test-case='" + case_name + "'");
    CAPTURE(ended.output);
    if (ended.exit_code == 77) course::skip("the case was skipped under xvfb-run");
    CHECK(ended.exit_code == 0);
    return false;
}

}  // namespace

TEST_CASE("window: shows the same pixels as a headless picture") {
#ifndef COURSE_WITH_WINDOW
    course::skip("built without windows (Debian: libglfw3-dev)");
#endif
    if (!display_or_run_under_xvfb("window: shows the same pixels as a headless picture")) return;
    const auto picture = [](bool in_window) {
        std::unique_ptr<course::GlContext> context;
        course::Window* window = nullptr;
        if (in_window) {
            auto made = course::make_window(320, 240, "test");
            window = made.get();
            context = std::move(made);
        } else {
            context = context_or_skip();
        }
        SharedFountain fountain(4000, particle_loop::make_scene("crown"));
        for (int step = 0; step < 150; ++step) fountain.step();
        Camera camera;
        camera.eye_m = {0, 2, 7};
        camera.target_m = {0, 1, 0};
        ParticleRenderer renderer(320, 240, interop::fountain_look(Drawing::spheres));
        interop::draw(renderer, fountain, camera);
        if (!window) return renderer.image();
        window->copy(renderer.picture());
        course::Image shown = window->read();
        window->swap();
        CHECK(shown.rgb == renderer.image().rgb);  // a screenshot is what the window shows
        return shown;
    };
    const course::Image window = picture(true), headless = picture(false);
    REQUIRE(window.width == headless.width);
    REQUIRE(window.height == headless.height);
    CHECK(window.rgb == headless.rgb);
}

TEST_CASE("window: the program runs in one") {
#ifndef COURSE_WITH_WINDOW
    course::skip("built without windows (Debian: libglfw3-dev)");
#endif
    if (!display_or_run_under_xvfb("window: the program runs in one")) return;
    const TemporaryFolder folder;
    for (const char* draw : {" --draw points", " --draw spheres"}) {
        const Ended ended =
            run(program("ch06_gl_interop") + kSmall + folder.path.string() + " --window --frames 5" + draw);
        CAPTURE(ended.output);
        CHECK(ended.exit_code == 0);
        CHECK(contains(ended.output, "handover: "));
    }
}

TEST_CASE("window: none without a display, in one sentence") {
    const TemporaryFolder folder;
    const Ended ended = run("env -u DISPLAY -u WAYLAND_DISPLAY " + program("ch06_gl_interop") + kSmall +
                            folder.path.string() + " --window");
    CHECK(ended.exit_code == 2);
    CHECK(contains(ended.output, "error: --window"));
    CHECK(std::count(ended.output.begin(), ended.output.end(), '\n') == 1);
}
