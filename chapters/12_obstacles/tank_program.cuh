/// @file
/// Particles in a tank with obstacles: as numbers and pictures, or in a window.
#pragma once
#include <cstdio>
#include <memory>

#include "12_obstacles/choices.h"
#include "12_obstacles/observe.cuh"
#include "12_obstacles/obstacle_view.cuh"
#include "common/gl_context.h"
#include "common/gl_window.h"
#include "common/stills.h"

namespace obstacles {

/// Is this step one of kStills, spread evenly over the run?
inline bool is_still(int step, int steps) {
    if (step == 0 || step == steps) return true;
    return (long(step) * (kStills - 1)) / steps != (long(step - 1) * (kStills - 1)) / steps;
}

// ------------------------------------------------------------------------------- particles in a tank

/// @tparam Run  WaterRun, or another that moves particles and obstacles together
template <class Run>
inline void run_headless(course::Program& program, const Choices& choices, Run& run) {
    const int steps =
        program.options.steps > 0 ? program.options.steps : int(std::ceil(run.duration_s() / run.dt_s()));
    std::unique_ptr<course::GlContext> context;
    std::unique_ptr<ObstacleView> view;
    if (choices.draws()) {
        context = course::make_headless_context();
        view = std::make_unique<ObstacleView>(run.view(), run.size(), program.options.width,
                                              program.options.height);
        program.result().note("OpenGL " + context->info().version + ", " + context->info().renderer +
                              "; handover: " + view->handover());
    }
    course::Table table("Obstacle 0 and the particles",
                        {"step", "time (s)", "x (m)", "y (m)", "z (m)", "its speed (m/s)",
                         "fastest particle (m/s)", "inside", "deepest (m)"});
    course::Stills stills(program);
    course::Progress progress(program.options.scene, steps);
    const auto look = [&](int step) {
        const Observation seen =
            observe(run.position(), run.velocity(), run.size(), run.particle_mass_kg(), run.obstacles());
        const double time_s = step * double(run.dt_s());
        const Motion motion = run.obstacles().empty() ? Motion{} : run.obstacles().motion(0);
        table.row({step, time_s, motion.position_m.x, motion.position_m.y, motion.position_m.z,
                   glm::length(motion.velocity_m_per_s), seen.fastest_m_per_s, seen.inside, seen.deepest_m});
        if (!view) return;
        view->draw(run.position(), run.velocity(), run.size(), run.obstacles(),
                   obstacle_view(run.view().tank).camera());
        stills.add(view->image(), step, time_s);
    };
    try {
        for (int step = 0; step <= steps; ++step) {
            if (step % kStepsPerCheck == 0) run.check_state(step);
            if (is_still(step, steps)) look(step);
            if (step == steps) break;
            run.step();
            progress.update(step + 1);
        }
    } catch (const course::Unstable&) {
        stills.finish();
        program.result().table(table);
        throw;
    }
    stills.finish();
    program.result().table(table);
}

/// Camera by the right button; the left one moves obstacle 0.
inline void steer_camera(course::OrbitCamera& orbit, const course::WindowEvents& events, int height_px) {
    course::WindowEvents camera_events = events;
    camera_events.drag_x_px = events.pan_x_px, camera_events.drag_y_px = events.pan_y_px;
    camera_events.pan_x_px = camera_events.pan_y_px = 0;
    course::steer(orbit, camera_events, height_px);
}

inline void print_keys() {
    std::printf(
        "drag: move the obstacle, right drag: orbit, wheel: zoom, space: pause, S or right: step, R: reset, "
        "P: picture, Esc: end\n");
}

template <class Run, class Make>
inline void run_window(course::Program& program, const Choices& choices, const Make& make) {
    const course::ProgramOptions& options = program.options;
    const auto window = course::make_window(options.width, options.height, "Obstacles: " + options.scene);
    auto run = std::make_unique<Run>(make());
    ObstacleView view(run->view(), run->size(), options.width, options.height);
    std::printf("%s; handover: %s\n", window->info().renderer.c_str(), view.handover().c_str());
    print_keys();
    course::OrbitCamera orbit = obstacle_view(run->view().tank);
    glm::dvec3 hand_m = run->obstacles().empty() ? glm::dvec3(0) : run->obstacles().motion(0).position_m;
    const glm::dvec3 start_m = hand_m;
    bool paused = false;
    int step = 0;
    for (int frame = 0; !window->closed() && (choices.frames == 0 || frame < choices.frames); ++frame) {
        const course::WindowEvents events = window->poll();
        if (events.pause) paused = !paused;
        if (events.step) paused = true;
        if (events.reset) {
            run = std::make_unique<Run>(make());
            hand_m = start_m;
            step = 0;
        }
        steer_camera(orbit, events, options.height);
        if (!run->obstacles().empty()) {
            hand_m = dragged(hand_m, events, orbit.camera(), options.height);
            run->obstacles().lead(0, hand_m);
        }
        for (int k = 0; k < (paused ? int(events.step) : Run::kStepsPerFrame); ++k) {
            run->step();
            if (++step % kStepsPerCheck == 0) run->check_state(step);
        }
        view.draw(run->position(), run->velocity(), run->size(), run->obstacles(), orbit.camera());
        if (events.screenshot) {
            const std::string file = "screenshot_" + course::file_number(step) + ".png";
            course::save_png(options.out / file, view.image());
            std::printf("%s\n", (options.out / file).string().c_str());
        }
        window->show(view.picture());
    }
}

}  // namespace obstacles
