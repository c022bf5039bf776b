// Chapter 06: the fountain on screen with no host copy.
#include <cstdio>
#include <list>

#include "01_particle_loop/checks.h"
#include "06_gl_interop/studies.cuh"
#include "06_gl_interop/wide_angle.h"
#include "common/gl_window.h"
#include "common/program.h"

namespace {

using interop::Drawing;
using interop::fountain_look;
using interop::FountainScene;
using interop::Handover;
using interop::ParticleRenderer;
using interop::SharedFountain;
using particle_loop::Fountain;

/// What this program can be asked for, beyond the options that all programs have.
struct Choices {
    std::string draw = "both";
    bool no_interop = false;
    int repeats = 5;
    int frames = 0;
};

FountainScene make_scene(const Choices& choices) {
    const std::string& draw = choices.draw;
    FountainScene scene;
    scene.points = draw == "points" || draw == "both";
    scene.spheres = draw == "spheres" || draw == "both";
    scene.handover = choices.no_interop ? Handover::copied : Handover::shared;
    if (!scene.draws() && draw != "none")
        throw course::BadInput("--draw must be points, spheres, both or none, not '" + draw + "'");
    if (choices.repeats < 1) throw course::BadInput("--repeats must be 1 or more");
    if (choices.frames < 0) throw course::BadInput("--frames must be 0 or more");
    return scene;
}

void run_headless(course::Program& program, const Choices& choices, const FountainScene& scene,
                  const Fountain& fountain) {
    const auto context = course::make_headless_context();
    const course::ProgramOptions& options = program.options;
    SharedFountain droplets(options.particles, fountain, scene.handover);
    program.result().note("OpenGL " + context->info().version + ", " + context->info().renderer + ", " +
                          context->info().platform);
    program.result().note("Handover: " + droplets.position().why());

    struct Picture {
        ParticleRenderer renderer;
        std::string drawn_as, file, caption;
    };
    std::list<Picture> pictures;  // made first: a shader that does not compile is known before the long work
    const auto plan = [&](Drawing drawing, const std::string& drawn_as, const std::string& caption) {
        pictures.push_back({{options.width, options.height, fountain_look(drawing)},
                            drawn_as,
                            "fountain_" + drawn_as + ".png",
                            caption});
    };
    if (scene.spheres) plan(Drawing::spheres, "spheres", "Droplets as lit spheres");
    if (scene.points) plan(Drawing::points, "points", "The same droplets as points");

    course::Progress progress("fountain", options.steps);
    for (int step = 0; step < options.steps; ++step) {
        droplets.step();
        progress.update(step + 1);
    }
    const auto median_ms = [&](const auto& work) {
        const auto frame = [&] {
            work();
            interop::finish();
        };
        return 1e3 * course::time_work(choices.repeats, frame).median_s;
    };
    std::vector<std::string> columns{"droplets", "handover", "copied (MB)", "step and handover"};
    std::vector<double> draw_ms;
    const bool shared = droplets.position().handover() == Handover::shared;
    std::vector<course::Cell> cells{options.particles, shared ? "no copy" : "copy",
                                    shared ? 0.0 : 1e-6 * 2 * sizeof(float4) * options.particles};
    for (Picture& picture : pictures) {
        const auto draw = [&] { interop::draw(picture.renderer, droplets, interop::first_view().camera()); };
        draw_ms.push_back(median_ms(draw));
        course::save_png(options.out / picture.file, picture.renderer.image());
        program.result().picture(picture.file, picture.caption);
        columns.push_back("draw " + picture.drawn_as);
    }
    cells.push_back(median_ms([&] { droplets.step(); }));
    cells.insert(cells.end(), draw_ms.begin(), draw_ms.end());
    if (scene.spheres) {
        course::save_png(options.out / "wide_angle.png",
                         interop::wide_angle_picture(options.width, options.height));
        program.result().picture(
            "wide_angle.png",
            "Pairs of spheres through a wide lens: ellipses off the middle, and circles where they meet");
    }
    course::Table table("Milliseconds, median of " + std::to_string(choices.repeats), columns);
    table.row(cells);
    program.result().table(table);
}

/// Numbers alone: plain device memory, and no OpenGL.
void run_without_pictures(course::Program& program, const Choices& choices, const Fountain& fountain) {
    const std::uint32_t n = program.options.particles;
    course::DeviceBuffer<float4> position(n), velocity(n);
    first_kernels::launch_fountain_clear(position.data(), velocity.data(), n);
    std::uint32_t step = 0;
    for (; step < std::uint32_t(program.options.steps); ++step)
        first_kernels::launch_fountain_step(position.data(), velocity.data(), n, fountain, step);
    course::Table table("Milliseconds per step, median of " + std::to_string(choices.repeats),
                        {"droplets", "step, nothing drawn"});
    const float time = course::median_milliseconds(choices.repeats, [&] {
        first_kernels::launch_fountain_step(position.data(), velocity.data(), n, fountain, step++);
    });
    table.row({n, time});
    program.result().table(table);
}

void run_window(course::Program& program, const Choices& choices, const FountainScene& scene,
                const Fountain& fountain) {
    const course::ProgramOptions& options = program.options;
    const auto window = course::make_window(options.width, options.height, "Fountain");
    SharedFountain droplets(options.particles, fountain, scene.handover);
    std::printf("%s; handover: %s\n", window->info().renderer.c_str(), droplets.position().why().c_str());
    std::printf(
        "drag: orbit, right drag: move, wheel: zoom, space: pause, S or right: step, R: reset, "
        "P: picture, Esc: end\n");
    ParticleRenderer renderer(options.width, options.height,
                              fountain_look(scene.spheres ? Drawing::spheres : Drawing::points));
    course::OrbitCamera orbit = interop::first_view();
    bool paused = false;
    int pictures = 0;
    for (int frame = 0; !window->closed() && (choices.frames == 0 || frame < choices.frames); ++frame) {
        const course::WindowEvents events = window->poll();
        if (events.pause) paused = !paused;
        if (events.step) paused = true;
        if (events.reset) droplets.reset();
        steer(orbit, events, options.height);
        if (!paused || events.step) droplets.step();
        interop::draw(renderer, droplets, orbit.camera());
        if (events.screenshot) {
            const std::string file = "screenshot_" + std::to_string(pictures++) + ".png";
            course::save_png(options.out / file, renderer.image());
            std::printf("%s\n", (options.out / file).string().c_str());
        }
        window->show(renderer.picture());
    }
}

}  // namespace

int main(int argc, char** argv) {
    course::Program program(
        "06_gl_interop", "The fountain on screen",
        "Kernels write into OpenGL's own buffer, and shaders turn droplets into lit spheres.");
    program.options.particles = 65536;
    program.options.steps = 600;
    program.scenes = {"crown", "spray"};
    Choices choices;
    program.option("--draw", choices.draw, "points, spheres, both, or none (numbers alone, no OpenGL)");
    program.option("--repeats", choices.repeats, "frames measured of each kind");
    program.option("--frames", choices.frames,
                   "close the window after so many frames (0: when the user does)");
    program.flag("--no-interop", choices.no_interop, "hand droplets over through a copy in host memory");
    program.study(
        {"spheres", "What does a rounder sphere cost: rays, triangles, or points?",
         "difference from a picture with 36 rays a pixel, root mean square, of 255", "samples a pixel"},
        interop::study_spheres);
    program.study({"handover", "What does a copy through the host cost on the way to OpenGL?",
                   "bytes that differ between the two ways", "n", course::StudyPlot::time_against_value},
                  interop::study_handover);
    return program.run(argc, argv, [&] {
        const course::ProgramOptions& options = program.options;
        const FountainScene scene = make_scene(choices);
        Fountain fountain = particle_loop::make_scene(options.scene);
        fountain.seed = options.seed;
        if (options.dt_s > 0) fountain.dt_s = options.dt_s;
        particle_loop::check(fountain);
        if (options.explain) {
            std::printf("%s", interop::explain(scene).c_str());
            return;
        }
        program.result().device = course::device_name();
        // Where OpenGL and the simulator draw and compute on the CPU, all of it is the host's memory.
        const interop::Needs needs = interop::needs(scene);
        course::require_memory(double(options.particles) *
                               double(needs.device_bytes_per_droplet + needs.gl_bytes_per_droplet +
                                      needs.copied_bytes_per_droplet));
        if (options.window)
            run_window(program, choices, scene, fountain);
        else if (scene.draws())
            run_headless(program, choices, scene, fountain);
        else
            run_without_pictures(program, choices, fountain);
    });
}
