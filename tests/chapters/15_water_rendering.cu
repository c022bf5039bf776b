// Chapter 15: light at the surface of water, on its way through it, and what each way of drawing leaves out.
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <random>
#include <sstream>

#include "15_water_rendering/explain.h"
#include "15_water_rendering/optics.h"
#include "15_water_rendering/water_view.cuh"
#include "tests/chapters/06_gl_interop_support.h"
#ifdef __CUDASIM__
#include "common/cudasim/cudasim.h"
#endif

using namespace water;
using course::GlKind;
using gl_test::context_or_skip;

namespace {

constexpr double kPi = 3.14159265358979323846;

/// Rows of a table of numbers; its first line names the columns.
std::vector<std::vector<double>> read_table(const std::string& file) {
    std::ifstream in(std::string(COURSE_DATA_DIR) + "/15_water_rendering/" + file);
    REQUIRE(in);
    std::vector<std::vector<double>> rows;
    std::string line;
    std::getline(in, line);
    while (std::getline(in, line)) {
        std::istringstream cells(line);
        rows.emplace_back();
        for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(std::stod(cell));
    }
    return rows;
}

/// A pool with a level surface: a lattice of particles on the floor of a tank.
struct Pool {
    Stage stage;
    float spacing_m = 0.02f;
    std::vector<float4> particles;

    explicit Pool(float depth_m = 0.2f) {
        stage.tank_high_m = {0.4f, 0.4f, 0.4f};
        for (float y = 0.5f * spacing_m; y < depth_m; y += spacing_m)
            for (float z = 0.5f * spacing_m; z < 0.4f; z += spacing_m)
                for (float x = 0.5f * spacing_m; x < 0.4f; x += spacing_m)
                    particles.push_back(make_float4(x, y, z, 0));
    }
    course::Camera camera() const {
        course::OrbitCamera orbit;
        orbit.target_m = {0.2f, 0.12f, 0.2f};
        orbit.distance_m = 1.2f;
        orbit.yaw_rad = 0.4f;
        orbit.pitch_rad = 0.5f;
        return orbit.camera();
    }
};

/// All texels of a framebuffer's colour, four numbers each.
std::vector<glm::vec4> read_texels(const Framebuffer& framebuffer) {
    std::vector<glm::vec4> texels(std::size_t(framebuffer.width()) * framebuffer.height());
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer.id());
    glReadPixels(0, 0, framebuffer.width(), framebuffer.height(), GL_RGBA, GL_FLOAT, texels.data());
    course::check_gl("reading texels");
    return texels;
}

Look one_ray() {
    Look look;
    look.samples = 1;
    look.sunshine_texels = 150;
    return look;
}

}  // namespace

// ------------------------------------------------------------------------------------------------- formulas

TEST_CASE("fresnel: the reference's values, from air and from water") {
    // The reference has 17 digits; three or four roundings of numbers up to 1.
    for (const auto& row : read_table("fresnel_air_water.csv")) {
        const double cosine = std::cos(row[0] * kPi / 180);
        CAPTURE(row[0]);
        CHECK(std::abs(fresnel_exact(cosine, kWaterIndex) - row[3]) <= 1e-14);
        CHECK(std::abs(fresnel_schlick(cosine, kWaterIndex) - row[4]) <= 1e-14);
    }
    for (const auto& row : read_table("fresnel_water_air.csv")) {
        CAPTURE(row[0]);
        // 48.5 degrees is 0.1 degrees from total reflection, where the slope is infinite: 1e-13
        CHECK(std::abs(fresnel_exact(std::cos(row[0] * kPi / 180), 1 / kWaterIndex) - row[1]) <= 1e-13);
    }
    CHECK(std::abs(critical_angle_rad() * 180 / kPi - 48.6066) <= 1e-4);
}

TEST_CASE("schlick: far off the exact formula by 0.058 near 85 degrees, and never by more than 0.06") {
    double worst = 0, at = 0;
    for (double degrees = 0; degrees <= 90; degrees += 0.01) {
        const double cosine = std::cos(degrees * kPi / 180);
        const double off =
            std::abs(fresnel_schlick(cosine, kWaterIndex) - fresnel_exact(cosine, kWaterIndex));
        if (off > worst) worst = off, at = degrees;
    }
    CHECK(worst > 0.0577);  // the reference's difference at 85 degrees
    CHECK(worst < 0.06);
    CHECK(std::abs(at - 84) < 2);
}

TEST_CASE("fresnel: what is reflected and what goes through is all there is") {
    // The part that goes through, from its own equations: (n2 cos2) / (n1 cos1) t^2 for each polarisation.
    for (const double index : {kWaterIndex, 1 / kWaterIndex, kGlassIndex})
        for (double cosine = 0.001; cosine <= 1; cosine += 0.001) {
            const double sine2 = (1 - cosine * cosine) / (index * index);
            if (sine2 >= 1) {
                CHECK(fresnel_exact(cosine, index) == 1);
                continue;
            }
            const double beyond = std::sqrt(1 - sine2), flux = index * beyond / cosine;
            const double across = 2 * cosine / (cosine + index * beyond);
            const double along = 2 * cosine / (index * cosine + beyond);
            const double through = 0.5 * flux * (across * across + along * along);
            CHECK(std::abs(fresnel_exact(cosine, index) + through - 1) <=
                  1e-12);  // roundings of numbers near 1
        }
}

TEST_CASE("fresnel: both sides of a surface mirror the same part") {
    for (double cosine = 0.01; cosine <= 1; cosine += 0.01) {
        const double beyond = std::sqrt(1 - (1 - cosine * cosine) / (kWaterIndex * kWaterIndex));
        CHECK(std::abs(fresnel_exact(cosine, kWaterIndex) - fresnel_exact(beyond, 1 / kWaterIndex)) <= 1e-13);
        CHECK(std::abs(fresnel_schlick(cosine, kWaterIndex) - fresnel_schlick(beyond, 1 / kWaterIndex)) <=
              1e-13);
    }
}

TEST_CASE("fresnel: the shader computes what the host computes") {
    const auto context = context_or_skip();
    const gl_test::TemporaryFolder folder;
    const std::filesystem::path file = folder.path / "table.frag";
    std::ofstream(file) << R"(#version 330 core
uniform float width;
out vec4 colour;
float fresnel_exact(float cosine, float index);
float fresnel_schlick(float cosine, float index);
float pane_reflection(float cosine);
void main() {
    float cosine = gl_FragCoord.x / width;
    colour = vec4(fresnel_exact(cosine, 1.333), fresnel_exact(cosine, 1.0 / 1.333), fresnel_schlick(cosine, 1.333),
                  pane_reflection(cosine));
})";
    constexpr int kWidth = 200;
    const WholePicture whole;
    const Framebuffer table(kWidth, 1, GL_RGBA32F, Framebuffer::Depth::none);
    const ShaderProgram program({"fullscreen.vert", file.string(), "water_optics.frag"});
    table.bind();
    program.use();
    program.set("width", float(kWidth));
    whole.draw();
    const std::vector<glm::vec4> got = read_texels(table);
    for (int k = 0; k < kWidth; ++k) {
        const double c = (k + 0.5) / kWidth;
        CAPTURE(c);
        // fp32; next to total reflection a rounding of 1e-7 under the root is 3e-4 of the result
        CHECK(std::abs(got[k].x - fresnel_exact(c, kWaterIndex)) <= 2e-6);
        CHECK(std::abs(got[k].y - fresnel_exact(c, 1 / kWaterIndex)) <= 1e-3);
        CHECK(std::abs(got[k].z - fresnel_schlick(c, kWaterIndex)) <= 2e-6);
        CHECK(std::abs(got[k].w - water::pane_reflection(c)) <= 2e-6);
    }
}

// --------------------------------------------------------------------------------------------------- kernels

TEST_CASE("smoothing: as a loop on the host; the sum stays") {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(0.3f, 0.6f);
    std::vector<float4> cloud;
    for (int k = 0; k < 900; ++k) cloud.push_back(make_float4(unit(random), unit(random), unit(random), 0));
    const course::DeviceBuffer<float4> particles(cloud);
    surface::SurfaceSettings settings;
    settings.particle_spacing_m = 0.03f;
    settings.kind = surface::FieldKind::colour;
    surface::Surface surface(settings);
    surface.build(particles.data(), std::uint32_t(cloud.size()));
    const std::vector<float> field = surface.field().download();
    const auto around = [&] {
        std::vector<std::uint32_t> host(surface::kAround * surface.brick_count());
        CUDA_CHECK(cudaMemcpy(host.data(), surface.bricks().view().around, host.size() * sizeof host[0],
                              cudaMemcpyDeviceToHost));
        return host;
    }();
    std::vector<float> expected = field, other = field;
    for (int axis = 0; axis < 3; ++axis) {
        glm::ivec3 step(0);
        step[axis] = 1;
        for (std::uint32_t b = 0; b < surface.brick_count(); ++b)
            for (int k = 0; k < surface::kBrickNodes; ++k) {
                const glm::ivec3 node(k % 8, k / 8 % 8, k / 64);
                const auto at = [&](glm::ivec3 n) {
                    const glm::ivec3 side = (n + 8) / 8;
                    const std::uint32_t brick = around[27 * b + side.x + 3 * side.y + 9 * side.z];
                    const glm::ivec3 in = n + 8 * (1 - side);
                    return brick == surface::kNone ? 0.0f
                                                   : expected[512 * brick + 64 * in.z + 8 * in.y + in.x];
                };
                other[512 * b + k] = 0.5f * at(node) + 0.25f * (at(node - step) + at(node + step));
            }
        expected.swap(other);
    }
    SmoothedSurface smoothed;
    smoothed.build(surface, 1);
    std::vector<float> got(512 * surface.brick_count());
    CUDA_CHECK(cudaMemcpy(got.data(), smoothed.field(), got.size() * sizeof(float), cudaMemcpyDeviceToHost));
    expected.resize(got.size());
    course::check_close(got, expected, course::Tolerance(1e-6), "field", "node");  // a rounding or two of 1
    CHECK(smoothed.size().triangles > 0);
}

TEST_CASE("free ways: no surface within the distance that a ray may go at once") {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(0, 1);
    const glm::ivec3 size(37, 21, 50), blocks = (size + kBlock - 1) / kBlock;
    std::vector<float> volume(std::size_t(size.x) * size.y * size.z, 0.2f);
    // A few lonely nodes inside, and a corner that is all inside.
    for (int k = 0; k < 6; ++k) volume[std::size_t(unit(random) * float(volume.size() - 1))] = 0.9f;
    for (int z = 30; z < 50; ++z)
        for (int y = 0; y < 12; ++y)
            for (int x = 20; x < 37; ++x) volume[(std::size_t(z) * size.y + y) * size.x + x] = 0.9f;
    const course::DeviceBuffer<float> field(volume);
    const int n = blocks.x * blocks.y * blocks.z, launch = (n + 127) / 128;
    course::DeviceBuffer<float> a(n), b(n);
    find_surface_kernel<<<launch, 128>>>(a.data(), field.data(), 0.5f, size, blocks);
    CUDA_CHECK(cudaGetLastError());
    for (int round = 0; round < 4; ++round) {
        grow_free_kernel<<<launch, 128>>>(b.data(), a.data(), blocks);
        CUDA_CHECK(cudaGetLastError());
        grow_free_kernel<<<launch, 128>>>(a.data(), b.data(), blocks);
        CUDA_CHECK(cudaGetLastError());
    }
    const std::vector<float> free = a.download();
    int long_ways = 0;
    for (int k = 0; k < n; ++k) {
        const int reach = int(free[k]);  // the block and reach - 1 around it are of one kind
        if (reach == 0) continue;
        long_ways += reach > 2;
        const glm::ivec3 here = surface::item_of(k, blocks);
        const glm::ivec3 low = glm::max(kBlock * (here - reach + 1), glm::ivec3(0));
        const glm::ivec3 high = glm::min(kBlock * (here + reach), size - 1);
        bool inside = false, outside = false;
        for (int z = low.z; z <= high.z; ++z)
            for (int y = low.y; y <= high.y; ++y)
                for (int x = low.x; x <= high.x; ++x) {
                    const bool in = volume[(std::size_t(z) * size.y + y) * size.x + x] > 0.5f;
                    inside = inside || in;
                    outside = outside || !in;
                }
        CHECK(!(inside && outside));
    }
    CHECK(long_ways > 0);
}

TEST_CASE("scenes: exactly as many particles as asked for, in the tank, none closer than 0.85 spacings") {
    for (const WaterScene& scene : all_scenes()) {
        if (scene.stage.ball.radius_m > 0) continue;  // chapter 12 fills that one
        for (const std::uint32_t n : {1u, 2u, 7u, 1000u, 5000u}) {
            CAPTURE(scene.name);
            CAPTURE(n);
            const Start start = fill(scene, n, 1);
            CHECK(start.position.size() == n);
            CHECK(start.velocity.size() == n);
            float nearest2 = 1e30f;
            for (std::size_t i = 0; i < start.position.size(); ++i) {
                const glm::vec3 x = grid::xyz(start.position[i]);
                CHECK(glm::all(glm::greaterThanEqual(x, scene.stage.tank_low_m)));
                CHECK(glm::all(glm::lessThanEqual(x, scene.stage.tank_high_m)));
                if (n > 1000) continue;
                for (std::size_t j = 0; j < i; ++j) {
                    const glm::vec3 off = x - grid::xyz(start.position[j]);
                    nearest2 = std::min(nearest2, glm::dot(off, off));
                }
            }
            // Two neighbours may each be moved by 0.05 towards the other: 0.9, and a little across.
            if (n > 1 && n <= 1000) CHECK(std::sqrt(nearest2) > 0.85f * start.spacing_m);
        }
    }
}

// ------------------------------------------------------------------------------------------------- pictures

TEST_CASE("sunshine: bent as Snell says, and no light is lost on the map") {
    const auto context = context_or_skip();
    const Pool pool;
    const course::DeviceBuffer<float4> particles(pool.particles);
    SurfaceView view(32, 18, one_ray(), pool.stage, pool.spacing_m);
    view.draw(particles.data(), std::uint32_t(pool.particles.size()), {}, pool.camera());
    const Sunshine& sunshine = *view.sunshine();
    const std::vector<glm::vec4> landings = read_texels(sunshine.landings());
    const glm::vec4 r = sunshine.rectangle_m();
    const Light light;
    const double sine = std::sqrt(1 - double(light.to_sun.y) * light.to_sun.y), bent = sine / kWaterIndex;
    const double cos_bent = std::sqrt(1 - bent * bent);
    const double slower =
        cos_bent * (sine / light.to_sun.y - bent / cos_bent);  // m on the floor per m of water
    int through_the_top = 0;
    double arriving = 0, leaving = 0, on_map = 0;
    const int width = sunshine.landings().width(), height = sunshine.landings().height();
    for (int k = 0; k < width * height; ++k) {
        const glm::vec4 l = landings[k];
        CHECK(l.z >= 0);
        CHECK(l.z <= 1);
        const glm::vec2 straight(r.x + r.z * (k % width + 0.5f) / width,
                                 r.y + r.w * (k / width + 0.5f) / height);
        if (!(l.z == 1 && l.w == 0)) {
            leaving += 1;
            arriving += l.z * std::exp(-light.absorption_per_m.y * l.w);
        }
        // Landed well off the walls with nearly all of its light: through no pane, so through the level
        // surface.
        const bool middle = l.x > 0.15f && l.x < 0.3f && l.y > 0.15f && l.y < 0.3f && l.w > 0;
        if (!middle || l.z < 0.95f) continue;
        ++through_the_top;
        const double moved = glm::distance(glm::vec2(l.x, l.y), straight);
        // The lattice's rows are dents of a few thousandths in the normal, and as much in both.
        CHECK(std::abs(moved / l.w - slower) <= 0.004);
        CHECK(std::abs(l.z - (1 - fresnel_exact(double(light.to_sun.y), kWaterIndex))) <= 0.002);
    }
    CHECK(through_the_top > 300);
    for (const glm::vec4& texel : read_texels(sunshine.map())) on_map += texel.y - 1;
    const double photons_per_texel =
        double(width) * height / (double(sunshine.map().width()) * sunshine.map().height());
    // Nothing lands outside the map but what its rim cuts off, and fp32 sums of half a million weights.
    CHECK(std::abs(on_map - (arriving - leaving) / photons_per_texel) <= 0.01 * leaving / photons_per_texel);
}

TEST_CASE("sunshine: without water none is brighter than the sun; a ball's shadow is an ellipse") {
    const auto context = context_or_skip();
    const Pool pool;
    Look look = one_ray();
    look.sunshine_texels = 500;
    SurfaceView view(32, 18, look, pool.stage, pool.spacing_m);
    view.draw(nullptr, 0, {{0.2f, 0.15f, 0.2f}, 0.1f}, pool.camera());
    const Sunshine& sunshine = *view.sunshine();
    double missing = 0;
    int too_bright = 0;
    for (const glm::vec4& texel : read_texels(sunshine.map())) {
        missing += texel.x < 1e-3f;
        too_bright += texel.x > 1.001f;
    }
    // The shadow of a ball on level ground is an ellipse, longer by the sine of the sun's height.
    const glm::vec4 r = sunshine.rectangle_m();
    const double texel_m2 = double(r.z) * r.w / (double(sunshine.map().width()) * sunshine.map().height());
    const double shadow_m2 = kPi * 0.1 * 0.1 / Light().to_sun.y;
    // Photons are spread 2 texels of 1.5 mm around where they land: 3 mm of the radius, 6 % of the area, are
    // rim.
    CHECK(missing * texel_m2 < shadow_m2);
    CHECK(missing * texel_m2 > 0.93 * shadow_m2);
    CHECK(too_bright == 0);
}

TEST_CASE("first surface: the mesh lies where the march finds the field's surface") {
    const auto context = context_or_skip();
    const Pool pool;
    std::vector<float4> ball;  // of water, in mid-air
    for (const float4& p : Pool(0.4f).particles)
        if (glm::distance(grid::xyz(p), glm::vec3(0.2f)) < 0.11f) ball.push_back(p);
    const course::DeviceBuffer<float4> particles(ball);
    const auto light = [&](bool marched) {
        Look look = one_ray();
        look.first_marched = marched;
        look.caustics = false;
        look.step_in_nodes = 0.5f;
        SurfaceView view(96, 54, look, pool.stage, pool.spacing_m);
        view.draw(particles.data(), std::uint32_t(ball.size()), {}, pool.camera());
        return view.light();
    };
    const std::vector<float> drawn = light(false), marched = light(true);
    // Tiles seen through a ball of water jump where a ray moves by a hair: most pixels agree, not all.
    std::size_t same = 0;
    for (std::size_t k = 0; k < drawn.size(); ++k) same += std::abs(drawn[k] - marched[k]) < 0.05f;
    CHECK(double(same) > 0.95 * double(drawn.size()));
}

TEST_CASE("white furnace: in a world that is equally bright everywhere, water is invisible") {
    const auto context = context_or_skip();
    // The shaders as they are, but with a stage whose every colour is 1.
    const gl_test::TemporaryFolder folder;
    std::filesystem::copy(
        course::shader_folder(), folder.path,
        std::filesystem::copy_options::recursive | std::filesystem::copy_options::overwrite_existing);
    std::ofstream(folder.path / "water_stage.frag") << R"(#version 330 core
uniform vec3 tank_low_m;
uniform vec4 ball_m;
vec3 sky(vec3 towards) { return vec3(1.0); }
vec3 sun_disc(vec3 towards) { return vec3(0.0); }
vec3 ground_colour(vec3 p, float seen_m) { return vec3(1.0); }
float ground_distance(vec3 from, vec3 towards) { return towards.y < 0.0 ? (tank_low_m.y - from.y) / towards.y : 1e9; }
float ball_distance(vec3 from, vec3 towards) { return 1e9; }
vec3 ball_colour(vec3 p, vec3 towards, bool in_water) { return vec3(1.0); }
vec3 stage(vec3 from, vec3 towards, float seen_per_m, bool with_sun) { return vec3(1.0); }
)";
    setenv("COURSE_SHADER_DIR", folder.path.c_str(), 1);
    Light even;
    even.absorption_per_m = glm::vec3(0);
    even.scattered = glm::vec3(1);
    const Pool pool(0.12f);
    const course::DeviceBuffer<float4> particles(pool.particles);
    for (const Inside inside : {Inside::marched, Inside::thickness}) {
        Look look = one_ray();
        look.inside = inside;
        look.caustics = false;
        SurfaceView view(64, 36, look, pool.stage, pool.spacing_m, even);
        view.draw(particles.data(), std::uint32_t(pool.particles.size()), {}, pool.camera());
        int glass = 0, wrong = 0;
        const std::vector<float> light = view.light();
        for (std::size_t k = 0; k < light.size(); k += 3) {
            // The panes' edges are green, and take light. Everything else splits it and loses nothing: fp32.
            if (light[k] < light[k + 1] - 1e-4f)
                ++glass;
            else if (std::abs(light[k] - 1) > 1e-4f)
                ++wrong;
        }
        CHECK(wrong == 0);
        CHECK(glass < 64 * 36 / 4);
    }
    unsetenv("COURSE_SHADER_DIR");
}

TEST_CASE("straight, bent, dry: water that is not bent and not coloured shows what is there without it") {
    const auto context = context_or_skip();
    const Pool pool(0.12f);
    const course::DeviceBuffer<float4> particles(pool.particles);
    Light clear;
    clear.absorption_per_m = glm::vec3(0);
    clear.scattering_per_m = 0;
    const auto light = [&](Inside inside, bool wet) {
        Look look = one_ray();
        look.inside = inside;
        SurfaceView view(96, 54, look, pool.stage, pool.spacing_m, clear);
        view.draw(particles.data(), wet ? std::uint32_t(pool.particles.size()) : 0, {}, pool.camera());
        return view.light();
    };
    const std::vector<float> dry = light(Inside::straight, false), straight = light(Inside::straight, true),
                             bent = light(Inside::thickness, true);
    double off_straight = 0, off_bent = 0;
    for (std::size_t k = 0; k < dry.size(); ++k) {
        off_straight += std::abs(straight[k] - dry[k]);
        off_bent += std::abs(bent[k] - dry[k]);
    }
    // What is mirrored differs in both; tiles stay in their places in one only.
    CHECK(off_straight < 0.5 * off_bent);
}

// ------------------------------------------------------------------------------------------ what is left out

namespace {

/// Draws a little water and holds what was made and launched against explain.h.
void check_needs(const Look& look) {
    const auto context = context_or_skip();
    const WaterScene scene = find_scene(all_scenes(), "dam_break");
    const auto run = make_run(scene, Model::sph, 400, 0, 1);
    const auto live = [](GlKind kind) { return course::gl_count(kind).live; };
    const int before[] = {live(GlKind::buffer), live(GlKind::vertex_array), live(GlKind::texture),
                          live(GlKind::framebuffer), live(GlKind::program)};
    {
        WaterView view(look, scene, *run, 64, 36);
#ifdef __CUDASIM__
        cudasim::Recording recording;
#endif
        view.draw(*run, scene.camera());
        const GlNeeds needs = gl_needs(look);
        CHECK(live(GlKind::buffer) - before[0] == needs.buffers);
        CHECK(live(GlKind::vertex_array) - before[1] == needs.vertex_arrays);
        CHECK(live(GlKind::texture) - before[2] == needs.textures);
        CHECK(live(GlKind::framebuffer) - before[3] == needs.framebuffers);
        CHECK(live(GlKind::program) - before[4] == needs.programs);
#ifdef __CUDASIM__
        for (const auto& [kernel, count] : kernels_per_picture(look)) {
            CAPTURE(kernel);
            CHECK(int(recording.count(kernel)) == count);
        }
        if (!look.has_field()) CHECK(recording.allocations() == 0);  // no field, no mesh: no device memory
#endif
    }
    CHECK(live(GlKind::buffer) == before[0]);  // nothing stays behind
    CHECK(live(GlKind::program) == before[4]);
}

Look drawn_as(Drawing drawing) {
    Look look = one_ray();
    look.drawing = drawing;
    return checked(look);
}

}  // namespace

TEST_CASE("left out: points have no field and no mesh") {
    check_needs(drawn_as(Drawing::points));
}
TEST_CASE("left out: spheres have no array of normals") {
    check_needs(drawn_as(Drawing::spheres));
}
TEST_CASE("left out: screen space has no field, no mesh and no texture of it") {
    check_needs(drawn_as(Drawing::screen_space));
}
TEST_CASE("left out: a marched surface has no spheres and no thickness") {
    check_needs(drawn_as(Drawing::surface));
}
TEST_CASE("left out: a surface with thickness has no field as a texture") {
    Look look = drawn_as(Drawing::surface);
    look.inside = Inside::thickness;
    check_needs(look);
}
TEST_CASE("left out: without caustics there is no map of the sunshine; marched from the eye, no mesh") {
    Look look = drawn_as(Drawing::surface);
    look.caustics = false;
    look.first_marched = true;
    check_needs(look);
}
