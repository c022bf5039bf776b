// Chapter 10: water by SPH, drawn as spheres.
#include <chrono>
#include <cstdio>
#include <memory>

#include "10_water_sph/studies.cuh"
#include "10_water_sph/water_view.cuh"
#include "common/gl_context.h"
#include "common/gl_window.h"
#include "common/gpu_timer.h"
#include "common/program.h"
#include "common/stills.h"

namespace {

using namespace sph;

constexpr int kStills = 9;  // pictures of a run: the start, the end, and seven evenly between
constexpr int kStepsPerCheck =
    10;  // an explosion doubles its speed in a few steps; a check costs 1/50 of a step

/// What this program can be asked for, beyond the options that all programs have.
struct Choices {
    std::string draw = "spheres", equation = "linear", pressure = "state";
    float stiffness = 1, viscosity = 1, tolerance = PbfChoice().tolerance;
    int frames = 0;
};

Settings make_settings(const course::ProgramOptions& options, const Choices& choices) {
    const auto want = [](bool good, const std::string& sentence) {
        if (!good) throw course::BadInput(sentence);
    };
    want(choices.draw == "spheres" || choices.draw == "points" || choices.draw == "none",
         "--draw must be spheres, points or none, not '" + choices.draw + "'");
    want(choices.equation == "linear" || choices.equation == "tait",
         "--equation must be linear or tait, not '" + choices.equation + "'");
    want(choices.pressure == "state" || choices.pressure == "pbf",
         "--pressure must be state or pbf, not '" + choices.pressure + "'");
    want(choices.tolerance > 0 && choices.tolerance <= 1, "--tolerance must be above 0 and at most 1");
    want(choices.stiffness >= 0.01f && choices.stiffness <= 1e6f, "--stiffness must be from 0.01 to 1000000");
    want(choices.viscosity >= 0 && choices.viscosity <= 1e6f, "--viscosity must be from 0 to 1000000");
    want(choices.frames >= 0, "--frames must be 0 or more");
    Settings settings;
    settings.scene = find_scene(all_scenes(), options.scene);
    settings.choice.stiffness = choices.stiffness;
    settings.choice.viscosity = choices.viscosity;
    settings.pressure = choices.pressure == "state" ? Pressure::state : Pressure::pbf;
    settings.pbf.tolerance = choices.tolerance;
    settings.state = choices.equation == "linear" ? EquationOfState::linear : EquationOfState::tait;
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
    template <class AnyWater>
    Recorder(course::Program& program, const Settings& settings, const StartOf<AnyWater>& start)
        : program_(program),
          camera_(interop::first_view(look_of(settings, start).tank).camera()),
          table_("The water's state",
                 {"step", "time (s)", "front (m)", "kinetic energy (J)", "total energy (J)",
                  "mean density (kg/m^3)", "highest (kg/m^3)", "fastest (m/s)"}),
          stills_(program) {
        if (settings.drawing == Drawing::none) return;  // numbers alone: no OpenGL
        context_ = course::make_headless_context();
        view_ = std::make_unique<interop::TankView>(look_of(settings, start), start.water.size(),
                                                    program.options.width, program.options.height);
        program.result().note("OpenGL " + context_->info().version + ", " + context_->info().renderer +
                              "; handover: " + view_->handover());
    }

    template <class AnyWater>
    void add(const StartOf<AnyWater>& start, const Summary& now, int step) {
        table_.row({step, step * double(start.dt_s), now.front_m, now.kinetic_J,
                    now.kinetic_J + now.potential_J, now.density_sum / start.water.size(),
                    now.highest_density, now.highest_speed});
        if (!view_) return;
        view_->draw(start.water.position(), start.water.velocity(), start.water.size(), camera_);
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

/// What a step has to tell of itself, added up over a run. An equation of state has nothing to tell.
struct Effort {
    void add(const Water&) {}
    void add(const PbfWater& water) {
        corrections += water.report().corrections;
        mean_sum += water.report().mean_compression;
        highest = std::max(highest, double(water.report().highest_compression));
        ++steps;
    }
    double corrections = 0, mean_sum = 0, highest = 0;
    int steps = 0;
};

template <class AnyWater>
void run_headless(course::Program& program, const Settings& settings, StartOf<AnyWater>& start) {
    const int steps = program.options.steps;
    Recorder recorder(program, settings, start);
    Summarizer summarize(start.water.size());
    course::Progress progress(settings.scene.name, steps);
    double seconds = 0;  // of the steps alone
    Effort effort;
    int stills = 0;
    try {
        for (int step = 0; step <= steps; ++step) {
            const bool still = step >= double(stills) * steps / (kStills - 1);
            if (still || step % kStepsPerCheck == 0) {
                const Summary now = summarize(start.water);
                check_state(start.water, now, step, start.dt_s);
                if (still) recorder.add(start, now, step);
                while (still && step >= double(stills) * steps / (kStills - 1) && stills < kStills) ++stills;
            }
            if (step == steps) break;
            const auto before = std::chrono::steady_clock::now();
            start.water.step(start.dt_s);
            CUDA_CHECK(cudaDeviceSynchronize());
            seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
            effort.add(start.water);
            progress.update(step + 1);
        }
    } catch (const course::Unstable&) {
        recorder.finish();
        throw;
    }
    recorder.finish();
    course::Table cost("Cost",
                       {"particles", "steps", "dt (s)", "ms per step", "million particle-steps per s"});
    if (steps > 0)
        cost.row({start.water.size(), steps, start.dt_s, 1e3 * seconds / steps,
                  1e-6 * steps * double(start.water.size()) / seconds});
    program.result().table(cost);
    if (effort.steps > 0) {
        course::Table table("Corrections", {"per step", "mean compression", "highest"});
        table.row({effort.corrections / effort.steps, effort.mean_sum / effort.steps, effort.highest});
        program.result().table(table);
    }
    char hash[64];
    std::snprintf(hash, sizeof hash, "State hash: %016llx",
                  static_cast<unsigned long long>(state_hash(start.water)));
    program.result().note(hash);
}

/// make: the water at its start, made anew.
template <class AnyWater, class Make>
void run_window(course::Program& program, const Choices& choices, const Settings& settings,
                StartOf<AnyWater>& start, Make make) {
    const course::ProgramOptions& options = program.options;
    const auto window =
        course::make_window(options.width, options.height, "Water by SPH: " + settings.scene.name);
    const interop::TankScene look = look_of(settings, start);
    interop::TankView view(look, start.water.size(), options.width, options.height);
    std::printf("%s; handover: %s\n", window->info().renderer.c_str(), view.handover().c_str());
    std::printf(
        "drag: orbit, right drag: move, wheel: zoom, space: pause, S or right: step, R: reset, "
        "P: picture, Esc: end\n");
    Summarizer summarize(start.water.size());
    course::OrbitCamera orbit = interop::first_view(look.tank);
    bool paused = false;
    int step = 0;
    for (int frame = 0; !window->closed() && (choices.frames == 0 || frame < choices.frames); ++frame) {
        const course::WindowEvents events = window->poll();
        if (events.pause) paused = !paused;
        if (events.step) paused = true;
        if (events.reset) {
            start = make(settings);
            step = 0;
        }
        course::steer(orbit, events, options.height);
        if (!paused || events.step) {
            start.water.step(start.dt_s);
            if (++step % kStepsPerCheck == 0)
                check_state(start.water, summarize(start.water), step, start.dt_s);
        }
        view.draw(start.water.position(), start.water.velocity(), start.water.size(), orbit.camera());
        if (events.screenshot) {
            const std::string file = "screenshot_" + course::file_number(step) + ".png";
            course::save_png(options.out / file, view.image());
            std::printf("%s\n", (options.out / file).string().c_str());
        }
        window->show(view.picture());
    }
}

/// What makes the numbers of a run mean little, as a sentence; empty if nothing does.
std::string broken_rule(const Start& start) {
    const std::string broken = broken_limit(start.water.fluid(), start.dt_s);
    return broken.empty() ? "" : broken + ": the run may end, but its numbers mean little";
}
std::string broken_rule(const PbfStart& start) {
    // Nobody knows the speed before the run; check_state watches it.
    if (!(start.dt_s > time_step_limit(start.water.fluid()).viscosity_s)) return "";
    return "dt is over the limit 0.0625 h^2 / nu, set by the viscosity: the run may end, but its numbers "
           "mean "
           "little";
}

/// The program with one of the two kinds of water.
template <class AnyWater>
void run(course::Program& program, const Choices& choices, const Settings& settings,
         StartOf<AnyWater> (*make)(const Settings&)) {
    // Start on the host, state on the device, which on the simulator is the host's memory too.
    const std::size_t each = std::max(Water::bytes_per_particle(true), PbfWater::bytes_per_particle(true));
    course::require_memory(double(settings.particles) * (2 * sizeof(float4) + each));
    StartOf<AnyWater> start = make(settings);
    if (program.options.explain) {
        std::printf("%s", explain(settings, start).c_str());
        return;
    }
    program.result().device = course::device_name();
    if (const std::string broken = broken_rule(start); !broken.empty()) program.result().note(broken);
    if (program.options.window)
        run_window(program, choices, settings, start, make);
    else
        run_headless(program, settings, start);
}

}  // namespace

int main(int argc, char** argv) {
    course::Program program(
        "10_water_sph", "Water by SPH",
        "Density, pressure and viscosity summed over neighbours make a block of particles break, "
        "run, splash and settle like water.");
    program.options.particles = 16384;
    program.options.steps = 2000;
    for (const Scene& scene : all_scenes()) program.scenes.push_back(scene.name);
    Choices choices;
    program.option("--draw", choices.draw, "spheres, points, or none (numbers alone, no OpenGL)");
    program.option("--pressure", choices.pressure,
                   "from an equation of state (state), or by position based fluids (pbf)");
    program.option("--tolerance", choices.tolerance, "with pbf: mean compression that a step may leave");
    program.option("--equation", choices.equation, "of state: linear or tait");
    program.option("--stiffness", choices.stiffness, "factor on the scene's sound speed");
    program.option("--viscosity", choices.viscosity,
                   "factor on the scene's viscosity; 0: none, not even computed");
    program.option("--frames", choices.frames,
                   "close the window after so many frames (0: when the user does)");
    declare_studies(program);
    return program.run(argc, argv, [&] {
        const Settings settings = make_settings(program.options, choices);
        if (settings.pressure == Pressure::pbf)
            run(program, choices, settings, make_pbf_start);
        else
            run(program, choices, settings, make_start);
    });
}
