// Chapter 15: awkward water, awkward input, films and windows.
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>

#include "15_water_rendering/recording.h"
#include "15_water_rendering/water_view.cuh"
#include "common/gl_gui.h"
#include "tests/chapters/06_gl_interop_support.h"
#include "tests/support/run_program.h"

using namespace water;
using gl_test::context_or_skip;

namespace {

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// All light of a picture is a number, and none is below 0.
void check_light(const std::vector<float>& light) {
    int bad = 0;
    for (const float value : light) bad += !(value >= 0 && value < 1e4f);
    CHECK(bad == 0);
}

const char* kSmall = " --particles 300 --steps 2 --width 64 --height 36 --samples 1 --out ";

}  // namespace

TEST_CASE("extremes: no water, one particle, all at one point, NaN among them, one far out of the tank") {
    const auto context = context_or_skip();
    Stage stage;
    stage.tank_high_m = {0.5f, 0.4f, 0.4f};
    course::OrbitCamera orbit;
    orbit.target_m = {0.25f, 0.1f, 0.2f};
    orbit.distance_m = 1.2f;
    orbit.pitch_rad = 0.3f;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<std::vector<float4>> waters = {
        {},
        {make_float4(0.2f, 0.1f, 0.2f, 0)},
        std::vector<float4>(200, make_float4(0.2f, 0.1f, 0.2f, 0)),
        {make_float4(0.2f, 0.1f, 0.2f, 0), make_float4(nan, 0.1f, 0.2f, 0), make_float4(0.22f, nan, nan, 0)},
        {make_float4(0.2f, 0.1f, 0.2f, 0), make_float4(0.9f, 0.1f, -0.4f, 0)}};
    for (const Drawing drawing : {Drawing::surface, Drawing::screen_space}) {
        Look look;
        look.drawing = drawing;
        look.samples = 1;
        look.sunshine_texels = 150;
        SurfaceView view(64, 36, checked(look), stage, 0.02f);
        std::vector<float> empty;
        for (const std::vector<float4>& water : waters) {
            CAPTURE(water.size());
            const course::DeviceBuffer<float4> particles(water);
            view.draw(particles.data(), std::uint32_t(water.size()), {}, orbit.camera());
            check_light(view.light());
            if (water.empty()) empty = view.light();
            // A sphere on the screen is seen, if it is alone; smoothing takes it from a surface.
            if (water.size() == 1 && drawing == Drawing::screen_space) CHECK(view.light() != empty);
        }
    }
}

TEST_CASE("extremes: the eye in the water, on the glass, straight above; a tank 10 km from the origin") {
    const auto context = context_or_skip();
    for (const float origin_m : {0.0f, 1e4f}) {
        Stage stage;
        stage.tank_low_m = glm::vec3(origin_m, 0, 0);
        stage.tank_high_m = stage.tank_low_m + glm::vec3(0.5f, 0.4f, 0.4f);
        std::vector<float4> water;
        for (float x = 0.02f; x < 0.5f; x += 0.04f)
            for (float y = 0.02f; y < 0.2f; y += 0.04f)
                for (float z = 0.02f; z < 0.4f; z += 0.04f)
                    water.push_back(make_float4(origin_m + x, y, z, 0));
        const course::DeviceBuffer<float4> particles(water);
        Look look;
        look.samples = 1;
        look.sunshine_texels = 150;
        SurfaceView view(64, 36, look, stage, 0.04f);
        const glm::vec3 middle = stage.tank_low_m + glm::vec3(0.25f, 0.1f, 0.2f);
        for (const glm::vec3 eye : {middle, stage.tank_low_m + glm::vec3(0.25f, 0.1f, 0.4f),
                                    stage.tank_low_m + glm::vec3(0.25f, 1, 0.2f)}) {
            course::Camera camera;
            camera.eye_m = eye;
            camera.target_m = middle + glm::vec3(0.001f, 0.05f, -0.1f);
            view.draw(particles.data(), std::uint32_t(water.size()), {}, camera);
            check_light(view.light());
        }
    }
}

TEST_CASE("input: what can't be done is said in one sentence") {
    const course::TemporaryFolder folder;
    const std::string out = folder.path().string();
    const auto refused = [&](const std::string& arguments, const std::string& part) {
        const course::ProgramRun run =
            course::run_program("ch15_water_rendering", "--steps 1 --out " + out + " " + arguments);
        CAPTURE(arguments);
        CAPTURE(run.output);
        CHECK(run.exit_code == 2);
        CHECK(contains(run.output, part));
    };
    refused("--draw oil", "--draw must be one of surface, screen, spheres, points");
    refused("--inside out", "--inside must be one of marched");
    refused("--model ink", "--model must be one of sph, marbles");
    refused("--scene fountain_into_pool --model marbles", "knows neither pump nor ball");
    refused("--samples -1", "--samples must be from 0");
    refused("--nodes nan", "--nodes");
    refused("--nodes 8 --particles 2000000000", "GiB of memory");
    refused("--record film.avi --particles 100", "--record writes .mp4 or .gif");
    refused("--record film.mp4 --particles 100 --width 63", "even width");
    refused("--particles 100 --width 100000", "--width must be");
}

TEST_CASE("headless numbers: no OpenGL at all") {
    const course::TemporaryFolder folder;
    // Where no shader can be read no picture can be drawn: numbers must not mind.
    const course::ProgramRun run =
        course::run_program("ch15_water_rendering", kSmall + folder.path().string() + " --draw none",
                            "COURSE_SHADER_DIR=/nowhere");
    CAPTURE(run.output);
    CHECK(run.exit_code == 0);
    CHECK(!contains(run.output, "OpenGL"));
    const course::ProgramRun drawn =
        course::run_program("ch15_water_rendering", kSmall + folder.path().string() + " --no-lapse",
                            "COURSE_SHADER_DIR=/nowhere");
    CHECK(drawn.exit_code == 2);
    CHECK(contains(drawn.output, "COURSE_SHADER_DIR"));
}

TEST_CASE("program: still and time lapse, the same bytes from the same seed") {
    const course::TemporaryFolder a, b;
    for (const course::TemporaryFolder* folder : {&a, &b}) {
        const course::ProgramRun run = course::run_program(
            "ch15_water_rendering", kSmall + folder->path().string() + " --draw screen --model marbles");
        CAPTURE(run.output);
        REQUIRE(run.exit_code == 0);
    }
    for (const char* file : {"dam_break.png", "time_lapse.png"}) {
        const auto bytes = [&](const course::TemporaryFolder& folder) {
            std::ifstream in(folder.path() / file, std::ios::binary);
            return std::string(std::istreambuf_iterator<char>(in), {});
        };
        CHECK(bytes(a).size() > 100);
        CHECK(bytes(a) == bytes(b));
    }
}

// ----------------------------------------------------------------------------------------------------- films

TEST_CASE("film: whole or not there") {
    const course::TemporaryFolder folder;
    const course::Image grey(64, 36);
    for (const char* name : {"a.mp4", "it's a film.gif"}) {
        const std::filesystem::path file = folder.path() / name;
        if (find_program("ffmpeg").empty()) course::skip("no ffmpeg (Debian: ffmpeg)");
        {
            Recording film(file, 64, 36, 30);
            for (int k = 0; k < 3; ++k) film.add(grey);
        }  // never finished: as if the run had failed
        CHECK(!std::filesystem::exists(file));
        CHECK(std::filesystem::is_empty(folder.path()));
        {
            Recording film(file, 64, 36, 30);
            for (int k = 0; k < 3; ++k) film.add(grey);
            CHECK(contains(film.finish(), "3 frames"));
        }
        CHECK(std::filesystem::file_size(file) > 100);
        std::filesystem::remove(file);
        CHECK(std::filesystem::is_empty(folder.path()));
    }
}

TEST_CASE("film: an ffmpeg that fails is a sentence, and leaves nothing") {
    const course::TemporaryFolder folder, bin;
    const std::filesystem::path fake = bin.path() / "ffmpeg";
    std::ofstream(fake) << "#!/bin/sh\nexit 3\n";
    std::filesystem::permissions(fake, std::filesystem::perms::owner_all);
    setenv("PATH", (bin.path().string() + ":/usr/bin:/bin").c_str(), 1);
    const course::Image grey(640, 360);  // more than a pipe holds
    CHECK_THROWS_AS(
        [&] {
            Recording film(folder.path() / "a.mp4", 640, 360, 30);
            for (int k = 0; k < 3; ++k) film.add(grey);
            film.finish();
        }(),
        course::BadInput);
    CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("film: without ffmpeg its frames are PNG files, and the program says so") {
    const course::TemporaryFolder folder, bin;
    setenv("PATH", bin.path().c_str(), 1);
    Recording film(folder.path() / "a.mp4", 64, 36, 30);
    film.add(course::Image(64, 36));
    film.add(course::Image(64, 36));
    const std::string sentence = film.finish();
    CHECK(contains(sentence, "ffmpeg is not installed"));
    CHECK(std::filesystem::exists(folder.path() / "a" / "frame_000001.png"));
    CHECK(std::filesystem::exists(folder.path() / "a" / "frame_000002.png"));
    CHECK(!std::filesystem::exists(folder.path() / "a.mp4"));
}

// --------------------------------------------------------------------------------------------------- windows

TEST_CASE("window: runs with its panel, the ball in hand") {
#ifndef COURSE_WITH_WINDOW
    course::skip("built without windows (Debian: libglfw3-dev)");
#endif
    std::string in_display;
    if (!std::getenv("DISPLAY")) {
        if (gl_test::run("command -v xvfb-run").exit_code != 0)
            course::skip("no display and no xvfb-run (Debian: xvfb)");
        in_display =
            "xvfb-run -a -n " + std::to_string(100 + getpid() % 1000) + " -s '-screen 0 800x600x24' ";
    }
    const course::TemporaryFolder folder;
    const gl_test::Ended ended =
        gl_test::run(in_display + gl_test::program("ch15_water_rendering") + kSmall + folder.path().string() +
                     " --scene wave_around_sphere --draw screen --window --frames 3");
    CAPTURE(ended.output);
    CHECK(ended.exit_code == 0);
    CHECK(contains(ended.output, "screen space"));  // the keys
    CHECK(contains(ended.output, "no panel") == !course::gui_available());
}
