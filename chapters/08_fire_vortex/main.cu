// Chapter 08: fire stirred by vortices.
#include <cstdio>
#include <memory>

#include "08_fire_vortex/compare.cuh"
#include "08_fire_vortex/studies.cuh"
#include "common/gl_context.h"
#include "common/gl_window.h"
#include "common/gpu_timer.h"
#include "common/program.h"

namespace {

using namespace vortex;

constexpr int kLapse = 9;                      // pictures of a time lapse...
constexpr float kLapseInterval_s = 1.0f / 12;  // ...and the time between two
constexpr int kStepsPerCheck = 10;

/// What this program can be asked for, beyond the options that all programs have.
struct Choices {
    std::string far = "pyramid", stepping = "euler";
    int vortons = -1, reach = 1, frames = 0;
    float wind_m_per_s = 0, strength = 1;
    bool no_stretching = false;
};

VortexScene make(const course::ProgramOptions& options, const Choices& choices, const std::string& name) {
    const auto want = [](bool good, const std::string& sentence) {
        if (!good) throw course::BadInput(sentence);
    };
    want(choices.far == "pyramid" || choices.far == "cells" || choices.far == "dropped" ||
             choices.far == "direct",
         "--far must be pyramid, cells, dropped or direct, not '" + choices.far + "'");
    want(choices.stepping == "euler" || choices.stepping == "midpoint",
         "--stepping must be euler or midpoint, not '" + choices.stepping + "'");
    want(choices.vortons >= -1 && choices.vortons <= (1 << 22), "--vortons must be 0 to 4194304");
    want(std::abs(choices.wind_m_per_s) <= 100, "--wind must be -100 to 100 m/s");
    want(choices.strength >= 0 && choices.strength <= 1e6f, "--strength must be 0 to 1000000");
    want(choices.frames >= 0, "--frames must be 0 or more");
    VortexScene scene = make_scene(name, options.particles, options.seed);
    VortexModel& m = scene.model;
    if (choices.vortons >= 0 && m.vortons > 0) {
        const float share = float(m.vortons) / float(std::max(1, choices.vortons));  // of the same gas
        m.physics.volume_m3 *= share;
        m.heat_m4_per_s2 *= share;
        m.vortons = std::uint32_t(choices.vortons);
    }
    m.far_field = {choices.far == "pyramid"   ? Far::pyramid
                   : choices.far == "cells"   ? Far::cells
                   : choices.far == "dropped" ? Far::dropped
                                              : Far::direct,
                   choices.reach};
    m.stepping = choices.stepping == "euler" ? Stepping::euler : Stepping::midpoint;
    m.physics.stretching = !choices.no_stretching;
    m.heat_m4_per_s2 *= choices.strength;
    scene.fire.fire.wind.steady_m_per_s.x += choices.wind_m_per_s;
    if (options.dt_s > 0) {
        scene.fire.warm_up_steps =
            std::max(1, int(scene.fire.warm_up_steps * scene.fire.dt_s / options.dt_s));
        scene.fire.dt_s = options.dt_s;
    }
    if (options.steps > 0) scene.fire.warm_up_steps = options.steps;
    check(m);
    fire::check(scene.fire);
    return scene;
}

void advance(SharedVortexFire& fire, int steps, course::Progress* progress = nullptr) {
    for (int step = 1; step <= steps; ++step) {
        fire.step();
        if (step % kStepsPerCheck == 0 || step == steps) fire.check_state();
        if (progress) progress->update(step);
    }
}

void show_comparison(course::Program& program, SharedVortexFire& fire, double step_s) {
    const course::ProgramOptions& options = program.options;
    const TwoFires two = compare_fires(fire, step_s, options.seed, options.width, options.height);
    course::save_png(options.out / "two_fires.png", two.side_by_side);
    course::save_png(options.out / "shading.png", two.shading);
    program.result().picture("two_fires.png",
                             "The same emitter: non-interacting (left), velocity-vortex (right)");
    program.result().picture(
        "shading.png",
        "A slice through the flames, lit evenly and by their vorticity (above); and what "
        "the vortons know there: vorticity and speed, from blue (little) to red (below)");
    program.result().table(two.table);
}

void show_lapse(course::Program& program, SharedVortexFire& fire, const course::Camera& camera) {
    const course::ProgramOptions& options = program.options;
    const VortexScene& scene = fire.scene();
    VortexView small(scene, options.width / 2, options.height / 2);
    std::vector<course::Image> stills;
    for (int k = 0; k < kLapse; ++k) {
        advance(fire, std::max(1, int(kLapseInterval_s / scene.fire.dt_s + 0.5f)));
        small.draw(fire, camera);
        stills.push_back(small.image());
    }
    const std::string file = scene.fire.name + "_lapse.png";
    course::save_png(options.out / file, course::contact_sheet(stills, 3));
    program.result().picture(file, "Time lapse, twelve pictures a second, row by row");
}

/// A still, its costs, a time lapse; and, if wanted, the comparison with chapter 07's fire.
void run_scene(course::Program& program, const VortexScene& scene, bool comparison, course::Table& costs) {
    const course::ProgramOptions& options = program.options;
    const std::string name = scene.fire.name;
    const int steps = scene.fire.warm_up_steps;
    SharedVortexFire fire(scene);
    VortexView view(scene, options.width, options.height);
    const course::Camera camera = fire::camera_of(scene.fire);
    course::Progress progress(name, steps);
    const double step_s = seconds_per_step(1, [&] { advance(fire, steps, &progress); }) / std::max(1, steps);
    const double picture_s = seconds_per_step(1, [&] {
        view.draw(fire, camera);
        glFinish();
    });
    course::save_png(options.out / (name + ".png"), view.image());
    program.result().picture(name + ".png", name + " after " + course::format_number(fire.time_s()) + " s");
    const CellGrid& cells = fire.vortons().flow().grid;
    costs.row({name, fire.vortons().particles(), scene.model.vortons, cells.cell_count(),
               1 / cells.cells_per_m, scene.fire.dt_s, 1e3 * step_s, 1e3 * picture_s});
    if (comparison) show_comparison(program, fire, step_s);
    show_lapse(program, fire, camera);
}

void run_headless(course::Program& program, const Choices& choices) {
    const course::ProgramOptions& options = program.options;
    const auto context = course::make_headless_context();
    program.result().note("OpenGL " + context->info().version + ", " + context->info().renderer);
    const bool all = options.scene == "all";
    course::Table costs("Cost of a scene", {"scene", "particles", "vortons", "cells", "cell (m)", "dt (s)",
                                            "ms per step", "ms per picture"});
    for (const std::string& name : scene_names())
        if (all || options.scene == name)
            run_scene(program, make(options, choices, name), name == "campfire", costs);
    program.result().table(costs);
}

void run_window(course::Program& program, const Choices& choices) {
    const course::ProgramOptions& options = program.options;
    const VortexScene scene = make(options, choices, options.scene == "all" ? "campfire" : options.scene);
    const auto window = course::make_window(options.width, options.height, "Vortex fire: " + scene.fire.name);
    SharedVortexFire fire(scene);
    VortexView view(scene, options.width, options.height);
    std::printf("%s\n", window->info().renderer.c_str());
    std::printf(
        "drag: orbit, right drag: move, wheel: zoom, space: pause, S or right: step, R: reset, "
        "P: picture, Esc: end\n");
    course::OrbitCamera orbit = scene.fire.view;
    course::Camera lens = fire::camera_of(scene.fire);
    bool paused = false;
    int pictures = 0;
    for (int frame = 0; !window->closed() && (choices.frames == 0 || frame < choices.frames); ++frame) {
        const course::WindowEvents events = window->poll();
        if (events.pause) paused = !paused;
        if (events.step) paused = true;
        if (events.reset) fire.reset();
        course::steer(orbit, events, options.height);
        if (!paused || events.step) advance(fire, 1);
        view.draw(fire, orbit.camera(lens));
        if (events.screenshot) {
            const std::string file = "screenshot_" + std::to_string(pictures++) + ".png";
            course::save_png(options.out / file, view.image());
            std::printf("%s\n", (options.out / file).string().c_str());
        }
        window->show(view.picture());
    }
}

/// The grid's size is not known before there is a fire: --explain lets it burn, and draws nothing.
void print_explanation(const VortexScene& scene) {
    VortexFire vortons(scene.fire.fire, scene.model);
    DeviceFlames flames(scene.fire.fire);
    for (int step = 0; step < scene.fire.warm_up_steps; ++step)
        vortons.step(flames.arrays(), scene.fire.dt_s);
    std::printf("%s", explain(scene, vortons.flow().grid.size, vortons.grid_bytes()).c_str());
}

}  // namespace

int main(int argc, char** argv) {
    course::Program program(
        "08_fire_vortex", "Fire stirred by vortices",
        "Thousands of little vortices, driven by hot gas, stir the air; flames go with it, roll up "
        "and tear off.");
    program.options.particles = 16000;
    program.options.steps = 0;
    program.scenes = {"all"};
    for (const std::string& name : scene_names()) program.scenes.push_back(name);
    Choices choices;
    program.option("--vortons", choices.vortons, "number of vortons (-1: the scene's)");
    program.option("--far", choices.far, "what far vortons do: pyramid, cells, dropped or direct");
    program.option("--reach", choices.reach, "cells around a cell whose vortons are summed one by one");
    program.option("--stepping", choices.stepping, "of the vortons: euler or midpoint");
    program.option("--wind", choices.wind_m_per_s, "more wind along x, m/s");
    program.option("--strength", choices.strength, "factor on the heat of the vortons");
    program.flag("--no-stretching", choices.no_stretching, "vortons are carried and turned by heat alone");
    program.option("--frames", choices.frames,
                   "close the window after so many frames (0: when the user does)");
    declare_studies(program);
    return program.run(argc, argv, [&] {
        const course::ProgramOptions& options = program.options;
        const std::string first = options.scene == "all" ? "campfire" : options.scene;
        if (options.explain) {
            std::printf("%s:\n", first.c_str());
            print_explanation(make(options, choices, first));
            return;
        }
        make(options, choices, first);  // bad input is told before OpenGL is asked for
        program.result().device = course::device_name();
        if (options.window)
            run_window(program, choices);
        else
            run_headless(program, choices);
    });
}
