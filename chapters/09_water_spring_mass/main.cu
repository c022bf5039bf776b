// Chapter 09: water made of marbles, drawn as spheres.
#include <chrono>
#include <cstdio>
#include <memory>

#include "09_water_spring_mass/marbles_view.cuh"
#include "09_water_spring_mass/studies.cuh"
#include "common/gl_context.h"
#include "common/gl_window.h"
#include "common/gpu_timer.h"
#include "common/program.h"
#include "common/stills.h"

namespace {

using namespace spring_mass;

constexpr int kStills = 9;          // pictures of a run: the start, the end, and seven evenly between
constexpr int kStepsPerCheck = 50;  // a check costs about two steps

/// What this program can be asked for, beyond the options that all programs have.
struct Choices {
    std::string draw = "spheres";
    // Below 0: the scene's own.
    float stiffness = -1, restitution = -1, friction = -1, attraction = -1, drag_per_s = -1;
    float skin = kDefaultSkin;
    int frames = 0;
};

Settings make_settings(const course::ProgramOptions& options, const Choices& choices) {
    const auto want = [](bool good, const std::string& sentence) {
        if (!good) throw course::BadInput(sentence);
    };
    Settings settings;
    settings.scene = find_scene(all_scenes(), options.scene);
    // One that was not asked for stays as the scene has it. (NaN is asked for, and out of range.)
    const auto choose = [&](float& value, float choice, const char* name, float low, float high) {
        if (choice == -1) return;
        want(choice >= low && choice <= high, std::string("--") + name + " must be from " +
                                                  course::format_number(low) + " to " +
                                                  course::format_number(high));
        value = choice;
    };
    Touch& touch = settings.scene.touch;
    choose(touch.stiffness, choices.stiffness, "stiffness", 0.001f, 1e6f);
    choose(touch.restitution, choices.restitution, "restitution", 0.01f, 1);
    choose(touch.friction, choices.friction, "friction", 0, 10);
    choose(touch.attraction, choices.attraction, "attraction", 0, 1);
    choose(touch.drag_per_s, choices.drag_per_s, "drag", 0, 1e6f);
    choose(settings.skin, choices.skin, "skin", 0, 10);
    want(choices.draw == "spheres" || choices.draw == "points" || choices.draw == "none",
         "--draw must be spheres, points or none, not '" + choices.draw + "'");
    want(choices.frames >= 0, "--frames must be 0 or more");
    settings.particles = options.particles;
    settings.dt_s = options.dt_s;
    settings.seed = options.seed;
    settings.drawing = choices.draw == "none"     ? Drawing::none
                       : choices.draw == "points" ? Drawing::points
                                                  : Drawing::spheres;
    return settings;
}

/// The run as pictures and numbers. Stills are written as they come: what a run that fails has shown stays.
class Recorder {
  public:
    Recorder(course::Program& program, const Settings& settings, const Start& start)
        : program_(program),
          camera_(interop::first_view(look_of(settings, start).tank).camera()),
          table_("The marbles' state",
                 {"step", "time (s)", "front (m)", "kinetic energy (J)", "total energy (J)",
                  "contacts per marble", "deepest overlap (%)", "fastest (m/s)"}),
          stills_(program) {
        if (settings.drawing == Drawing::none) return;  // numbers alone: no OpenGL
        context_ = course::make_headless_context();
        view_ = std::make_unique<interop::TankView>(look_of(settings, start), start.marbles.size(),
                                                    program.options.width, program.options.height);
        program.result().note("OpenGL " + context_->info().version + ", " + context_->info().renderer +
                              "; handover: " + view_->handover());
    }

    void add(const Start& start, const Summary& now, int step) {
        table_.row({step, step * double(start.dt_s), now.front_m, now.kinetic_J, now.energy_J(),
                    now.contacts / start.marbles.size(),
                    100.0 * now.deepest_m / start.marbles.material().diameter_m, now.highest_speed});
        if (!view_) return;
        view_->draw(start.marbles.position(), start.marbles.velocity(), start.marbles.size(), camera_);
        stills_.add(view_->image(), step, step * double(start.dt_s));
    }

    /// Everything gathered so far goes into the result; also when the run ends by an error.
    void finish() {
        stills_.finish();
        program_.result().table(table_);
    }

  private:
    course::Program& program_;
    course::Camera camera_;
    course::Table table_;
    std::unique_ptr<course::GlContext> context_;  // before the view: its objects must go first
    std::unique_ptr<interop::TankView> view_;
    course::Stills stills_;
};

void run_headless(course::Program& program, const Settings& settings, Start& start) {
    const int steps = program.options.steps;
    Recorder recorder(program, settings, start);
    Summarizer summarize(start.marbles.size());
    course::Progress progress(settings.scene.name, steps);
    double seconds = 0;  // of the steps alone
    int stills = 0;
    const double start_J = summarize(start.marbles).energy_J();
    try {
        for (int step = 0; step <= steps; ++step) {
            const bool still = step >= double(stills) * steps / (kStills - 1);
            if (still || step % kStepsPerCheck == 0) {
                const Summary now = summarize(start.marbles);
                check_state(start.marbles, now, start_J, step, start.dt_s);
                if (still) recorder.add(start, now, step);
                while (still && step >= double(stills) * steps / (kStills - 1) && stills < kStills) ++stills;
            }
            if (step == steps) break;
            const auto before = std::chrono::steady_clock::now();
            start.marbles.step(start.dt_s);
            CUDA_CHECK(cudaDeviceSynchronize());
            seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
            progress.update(step + 1);
        }
    } catch (const course::Unstable&) {
        recorder.finish();
        throw;
    }
    recorder.finish();
    course::Table cost("Cost", {"particles", "steps", "dt (s)", "ms per step", "million particle-steps per s",
                                "steps per neighbour list"});
    if (steps > 0)
        cost.row({start.marbles.size(), steps, start.dt_s, 1e3 * seconds / steps,
                  1e-6 * steps * double(start.marbles.size()) / seconds,
                  double(steps) / start.marbles.lists_made()});
    program.result().table(cost);
    char hash[64];
    std::snprintf(hash, sizeof hash, "State hash: %016llx",
                  static_cast<unsigned long long>(state_hash(start.marbles)));
    program.result().note(hash);
}

void run_window(course::Program& program, const Choices& choices, const Settings& settings, Start& start) {
    const course::ProgramOptions& options = program.options;
    const auto window = course::make_window(options.width, options.height, "Marbles: " + settings.scene.name);
    const interop::TankScene look = look_of(settings, start);
    interop::TankView view(look, start.marbles.size(), options.width, options.height);
    std::printf("%s; handover: %s\n", window->info().renderer.c_str(), view.handover().c_str());
    std::printf(
        "drag: orbit, right drag: move, wheel: zoom, space: pause, S or right: step, R: reset, "
        "P: picture, Esc: end\n");
    Summarizer summarize(start.marbles.size());
    const double start_J = summarize(start.marbles).energy_J();
    course::OrbitCamera orbit = interop::first_view(look.tank);
    bool paused = false;
    int step = 0;
    for (int frame = 0; !window->closed() && (choices.frames == 0 || frame < choices.frames); ++frame) {
        const course::WindowEvents events = window->poll();
        if (events.pause) paused = !paused;
        if (events.step) paused = true;
        if (events.reset) {
            start = make_start(settings);
            step = 0;
        }
        course::steer(orbit, events, options.height);
        if (!paused || events.step) {
            start.marbles.step(start.dt_s);
            if (++step % kStepsPerCheck == 0)
                check_state(start.marbles, summarize(start.marbles), start_J, step, start.dt_s);
        }
        view.draw(start.marbles.position(), start.marbles.velocity(), start.marbles.size(), orbit.camera());
        if (events.screenshot) {
            const std::string file = "screenshot_" + course::file_number(step) + ".png";
            course::save_png(options.out / file, view.image());
            std::printf("%s\n", (options.out / file).string().c_str());
        }
        window->show(view.picture());
    }
}

}  // namespace

int main(int argc, char** argv) {
    course::Program program("09_water_spring_mass", "Water of marbles",
                            "Marbles that push each other like springs fall, burst, slide and pile up.");
    program.options.particles = 16384;
    program.options.steps = 6000;
    for (const Scene& scene : all_scenes()) program.scenes.push_back(scene.name);
    Choices choices;
    program.option("--draw", choices.draw, "spheres, points, or none (numbers alone, no OpenGL)");
    program.option("--stiffness", choices.stiffness, "factor on the scene's stiffness");
    program.option("--restitution", choices.restitution,
                   "speed after a head-on collision / speed before, 0.01 to 1; 1: nothing is lost");
    program.option("--friction", choices.friction, "coefficient; 0: none, not even computed");
    program.option("--attraction", choices.attraction,
                   "of marbles that touch, as a fraction of the stiffness; 0: none, not even computed");
    program.option("--drag", choices.drag_per_s,
                   "deceleration for each m/s of speed, 1/s; 0: none, not even computed");
    program.option("--skin", choices.skin, "of the neighbour list, in diameters");
    program.option("--frames", choices.frames,
                   "close the window after so many frames (0: when the user does)");
    declare_studies(program);
    return program.run(argc, argv, [&] {
        const Settings settings = make_settings(program.options, choices);
        // Start on the host, state on the device, which on the simulator is the host's memory too.
        course::require_memory(double(settings.particles) * (2 * sizeof(float4) + Marbles::kBytesPerMarble));
        Start start = make_start(settings);
        if (program.options.explain) {
            std::printf("%s", explain(settings, start).c_str());
            return;
        }
        program.result().device = course::device_name();
        if (const std::string broken = broken_limit(start.marbles.material(), start.dt_s); !broken.empty())
            program.result().note(broken + ": the run may end, but its numbers mean little");
        if (program.options.window)
            run_window(program, choices, settings, start);
        else
            run_headless(program, settings, start);
    });
}
