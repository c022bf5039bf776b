// Chapter 07: fire from particles that do not know each other.
#include <cstdio>

#include "07_fire_particles/studies.cuh"
#include "common/gl_window.h"
#include "common/program.h"

namespace {

using namespace fire;

constexpr int kLapse = 9;                      // pictures of a time lapse...
constexpr float kLapseInterval_s = 1.0f / 12;  // ...and the time between two

/// What this program can be asked for, beyond the options that all programs have.
struct Choices {
    std::string draw = "fire";
    float exposure_stops = 0;
    bool unsorted = false;
    int frames = 0;

    SmokeOrder order() const { return unsorted ? SmokeOrder::unsorted : SmokeOrder::sorted; }
};

FireScene make(const course::ProgramOptions& options, const Choices& choices, const std::string& name) {
    FireScene scene = make_scene(name, options.particles, options.seed);
    if (options.dt_s > 0) {
        scene.warm_up_steps = int(std::ceil(scene.warm_up_steps * scene.dt_s / options.dt_s));
        scene.dt_s = options.dt_s;
    }
    if (options.steps > 0) scene.warm_up_steps = options.steps;
    scene.stage.exposure *= std::exp2(choices.exposure_stops);
    check(scene);
    return scene;
}

void check(const Choices& choices) {
    const auto want = [](bool good, const std::string& sentence) {
        if (!good) throw course::BadInput(sentence);
    };
    want(choices.draw == "fire" || choices.draw == "none",
         "--draw must be fire or none, not '" + choices.draw + "'");
    want(std::abs(choices.exposure_stops) <= 20, "--exposure must be from -20 to 20 stops");
    want(choices.frames >= 0, "--frames must be 0 or more");
}

void save_lapse(course::Program& program, SharedFire& fire, FireView& view) {
    const FireScene& scene = fire.scene();
    const int steps = std::max(1, int(kLapseInterval_s / scene.dt_s + 0.5f));
    std::vector<course::Image> stills;
    for (int k = 0; k < kLapse; ++k) {
        for (int step = 0; step < steps; ++step) fire.step();
        view.draw(fire, camera_of(scene));
        stills.push_back(view.image());
    }
    const std::string file = scene.name + "_time_lapse.png";
    course::save_png(program.options.out / file, course::contact_sheet(stills, 3));
    program.result().picture(file, "Time lapse, row by row, " +
                                       course::format_number(1e3 * steps * scene.dt_s) +
                                       " ms from one to the next");
}

/// One scene: a still, its costs, and a time lapse. @returns the still
course::Image run_scene(course::Program& program, const Choices& choices, const FireScene& scene,
                        course::Table& costs) {
    const course::ProgramOptions& options = program.options;
    FireView view(scene, options.width, options.height, choices.order());  // a shader that fails is known now
    SharedFire fire(scene);
    course::Progress progress(scene.name, scene.warm_up_steps);
    for (int step = 0; step < scene.warm_up_steps; ++step) {
        fire.step();
        progress.update(step + 1);
    }
    view.draw(fire, camera_of(scene));
    const course::Image still = view.image();
    course::save_png(options.out / (scene.name + ".png"), still);
    program.result().picture(scene.name + ".png",
                             "The " + scene.name + " after " + course::format_number(fire.time_s()) + " s");
    const int width = std::max(1, options.width / 2), height = std::max(1, options.height / 2);
    FireView sorted(scene, width, height), unsorted(scene, width, height, SmokeOrder::unsorted);
    add_cost(costs, fire, sorted, unsorted);
    save_lapse(program, fire, choices.unsorted ? unsorted : sorted);
    return still;
}

/// Numbers alone: plain device memory, and no OpenGL.
void run_without_pictures(const FireScene& scene, course::Table& costs) {
    const std::uint32_t n = particle_count(scene.fire);
    course::DeviceBuffer<float4> position(n), velocity(n);
    course::DeviceBuffer<std::uint32_t> generation(n);
    const FlameArrays arrays{position.data(), velocity.data(), generation.data()};
    launch_flame_clear(arrays, scene.fire);
    int step = 0;
    const auto advance = [&] {
        launch_flame_step(arrays, scene.fire, scene.curl, float(step++ * double(scene.dt_s)), scene.dt_s);
    };
    while (step < scene.warm_up_steps) advance();
    const double ms = course::median_milliseconds(15, advance);
    costs.row({scene.name, n, ms, 1e-3 * n / ms});
}

void run_window(course::Program& program, const Choices& choices, const FireScene& scene) {
    const course::ProgramOptions& options = program.options;
    const auto window = course::make_window(options.width, options.height, "Fire: " + scene.name);
    SharedFire fire(scene);
    FireView view(scene, options.width, options.height, choices.order());
    std::printf("%s; handover: %s\n", window->info().renderer.c_str(), fire.position().why().c_str());
    std::printf(
        "drag: orbit, right drag: move, wheel: zoom, space: pause, S or right: step, R: reset, "
        "P: picture, Esc: end\n");
    constexpr float kRefresh_s = 1.0f / 60;  // as fast as a fire burns, on a usual screen
    const int steps = std::max(1, int(kRefresh_s / scene.dt_s + 0.5f));
    course::OrbitCamera orbit = scene.view;
    bool paused = false;
    for (int frame = 0; !window->closed() && (choices.frames == 0 || frame < choices.frames); ++frame) {
        const course::WindowEvents events = window->poll();
        if (events.pause) paused = !paused;
        if (events.step) paused = true;
        if (events.reset) fire.reset();
        course::steer(orbit, events, options.height);
        if (!paused)
            for (int step = 0; step < steps; ++step) fire.step();
        else if (events.step)
            fire.step();
        view.draw(fire, camera_of(scene, orbit));
        if (events.screenshot) {
            const std::string file = "screenshot_" + std::to_string(fire.steps_done()) + ".png";
            course::save_png(options.out / file, view.image());
            std::printf("%s\n", (options.out / file).string().c_str());
        }
        window->show(view.picture());
    }
}

void declare_studies(course::Program& program) {
    program.study({"time_step", "Which step follows a particle through turning air at the least cost?",
                   "largest distance from the exact place after 1 s (m)", "dt_s"},
                  study_time_step);
    program.study(
        {"sprites", "How many sprites does a fire need?",
         "difference of the light from that of a converged picture, relative, root mean square", "sprites"},
        study_sprites);
    program.study({"sorting", "How finely must smoke be sorted, and what does that cost?",
                   "difference of the light from that of fully sorted smoke, relative, root mean square",
                   "depth_slices", course::StudyPlot::error_against_time, true},
                  study_sorting);
    program.stability(
        {"drag", "How long may a time step be at a given drag?",
         "after 400 steps in still air a particle is no faster than at first",
         "Euler's methods: 2 / drag, where the factor 1 - drag dt passes -1. The exponential step has no "
         "limit; it is tried up to 1000 times Euler's",
         "drag (1/s)"},
        stability_drag);
}

}  // namespace

int main(int argc, char** argv) {
    course::Program program(
        "07_fire_particles", "Fire from sprites",
        "Thousands of faint sprites, each with a life of its own, add up to a candle, a torch and "
        "a campfire.");
    program.options.particles = 20000;
    program.options.steps = 0;  // as many as the scene takes to reach its full height
    program.scenes = {"all"};
    for (const std::string& name : scene_names()) program.scenes.push_back(name);
    Choices choices;
    program.option("--draw", choices.draw, "fire, or none (numbers alone, no OpenGL)");
    program.option("--exposure", choices.exposure_stops,
                   "in stops: 1 doubles the light on the film, -1 halves it");
    program.option("--frames", choices.frames,
                   "close the window after so many frames (0: when the user does)");
    program.flag("--unsorted", choices.unsorted, "draw the smoke without sorting it");
    declare_studies(program);
    return program.run(argc, argv, [&] {
        const course::ProgramOptions& options = program.options;
        check(choices);
        const bool draws = choices.draw == "fire";
        std::vector<FireScene> scenes;
        for (const std::string& name : scene_names())
            if (options.scene == "all" || options.scene == name)
                scenes.push_back(make(options, choices, name));
        course::require_memory(double(options.particles) * 3 * kFlameBytes);
        if (options.explain) {
            for (const FireScene& scene : scenes) std::printf("%s", explain(scene, draws).c_str());
            return;
        }
        program.result().device = course::device_name();
        if (options.window) {
            run_window(program, choices, scenes[options.scene == "all" ? 2 : 0]);  // all: the campfire
        } else if (draws) {
            const auto context = course::make_headless_context();
            course::Table costs = cost_table(options.width / 2, options.height / 2);
            std::vector<course::Image> stills;
            for (const FireScene& scene : scenes)
                stills.push_back(half_size(run_scene(program, choices, scene, costs)));
            if (stills.size() > 1) {
                course::save_png(options.out / "fires.png", course::contact_sheet(stills, 2));
                program.result().picture("fires.png", "Candle, torch, campfire, and a log in the wind");
            }
            program.result().note("OpenGL " + context->info().version + ", " + context->info().renderer);
            program.result().table(costs);
        } else {
            course::Table costs("Steps alone, median of 15",
                                {"scene", "particles", "ms per step", "million particle-steps per s"});
            for (const FireScene& scene : scenes) run_without_pictures(scene, costs);
            program.result().table(costs);
        }
    });
}
