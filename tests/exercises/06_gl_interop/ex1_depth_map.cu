#include "ex1_depth_map.cuh"

#include "06_gl_interop/sphere_ray.h"
#include "common/device_buffer.h"
#include "tests/support/course_test.h"

namespace {

using interop::Lens;

// 60 degrees high, 4 : 3, no multiple of the block.
const Lens kLens{100, 75, 0.7698f, 0.57735f, 0.1f, 50};

struct Depths {
    std::vector<float> got, expected;  // metres
};

/// Depths in metres by the learner's kernel and in double precision by the book. A pixel whose ray passes a
/// rim nearer than 1/200 of the radius counts as equal: there rounding decides.
Depths depths(const std::vector<float4>& spheres, const Lens& lens) {
    const int pixels = lens.width_px * lens.height_px;
    course::DeviceBuffer<float> stored(pixels);
    const course::DeviceBuffer<float4> on_device(spheres);
    interop::depth_map(stored.data(), on_device.data(), int(spheres.size()), lens);
    Depths result{stored.download(), std::vector<float>(pixels)};
    const double scale = double(lens.far_m) / (lens.far_m - lens.near_m);
    for (int i = 0; i < pixels; ++i) {
        const glm::dvec3 ray((2 * (i % lens.width_px + 0.5) / lens.width_px - 1) * lens.half_width,
                             (2 * (i / lens.width_px + 0.5) / lens.height_px - 1) * lens.half_height, -1);
        double nearest = lens.far_m;
        bool at_rim = false;
        for (const float4& s : spheres) {
            const glm::dvec3 centre(s.x, s.y, s.z);
            const auto hit = interop::ray_sphere(ray, centre, s.w, lens.near_m);
            if (hit.hit) nearest = std::min(nearest, hit.depth_m);
            const double off = glm::length(glm::cross(ray, centre)) / glm::length(ray);
            at_rim = at_rim || std::abs(off / s.w - 1) < 5e-3;
        }
        result.got[i] = float(lens.near_m / (1 - result.got[i] / scale));  // back to metres
        result.expected[i] = float(nearest);
        if (at_rim) result.got[i] = result.expected[i] = 0;
    }
    return result;
}

void check(const std::vector<float4>& spheres, const Lens& lens = kLens) {
    const Depths d = depths(spheres, lens);
    // A stored depth has a step of 6e-8; at 10 m and near = 0.1 m that is 6e-5 m, and some rounding is added.
    // Where nothing is (50 m) a step is 1.5e-3 m.
    course::check_close(d.got, d.expected, course::Tolerance(1e-4, 1e-4), "depth", "pixel");
}

}  // namespace

TEST_CASE("a sphere in the middle") {
    course::set_hint(2);
    check({make_float4(0, 0, -3, 1)});
}

TEST_CASE("a sphere in a corner: depth is distance from the eye's plane") {
    course::set_hint(1);
    check({make_float4(1.7f, 1.2f, -3, 0.6f)});
}

TEST_CASE("nothing to see is as deep as the far plane") {
    course::set_hint(3);
    check({});
    check({make_float4(0, 0, 3, 1),
           make_float4(0, 0, -0.05f, 0.02f)});  // behind the eye; before the near plane
}

TEST_CASE("the nearest of many is seen, whatever their order") {
    course::set_hint(2);
    check(
        {make_float4(0, 0, -3, 0.7f), make_float4(0.4f, 0.2f, -5, 1.5f), make_float4(-0.3f, 0, -2.6f, 0.5f)});
    check(
        {make_float4(-0.3f, 0, -2.6f, 0.5f), make_float4(0.4f, 0.2f, -5, 1.5f), make_float4(0, 0, -3, 0.7f)});
}

TEST_CASE("5 mm seen from 10 m: the digits are still there") {
    course::set_hint(2);
    const Lens telescope{64, 64, 0.0008f, 0.0008f, 5, 20};
    const Depths d = depths({make_float4(0.001f, 0, -10, 0.005f)}, telescope);
    // A fiftieth of the radius: fp32 places are 1e-6 m apart at 10 m, near the rim that counts tenfold, and a
    // stored depth's step is 1.2e-6 m with near = 5 m.
    course::check_close(d.got, d.expected, course::Tolerance(1e-4), "depth", "pixel");
}
