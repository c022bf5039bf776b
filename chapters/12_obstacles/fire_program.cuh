/// @file
/// Flames around a ball: as numbers and pictures, or in a window.
#pragma once
#include "12_obstacles/explain.h"
#include "12_obstacles/fire_run.cuh"
#include "12_obstacles/tank_program.cuh"

namespace obstacles {

/// The fire with its ball, which may have been left out.
inline FireObstacles fire_scene(const course::ProgramOptions& options, const Choices& choices) {
    FireObstacles scene = flame_around_ball(options.particles, options.seed);
    adjust(scene.obstacles, choices);
    if (scene.obstacles.empty())
        scene.fire.stage.rods.pop_back();
    else
        scene.fire.stage.rods.back().radius_m = scene.obstacles[0].solid.half_size_m.x;
    if (options.window && !scene.obstacles.empty()) scene.obstacles[0].control = Control::hand;
    if (options.dt_s > 0) scene.fire.dt_s = options.dt_s;
    fire::check(scene.fire);
    return scene;
}

inline void draw(fire::FireView& view, fire::SharedFire& flames, const FireRun& run,
                 const course::Camera& camera) {
    if (!run.obstacles().empty()) place_ball(view.renderer().stage, run.obstacles().now().obstacle[0].to_m);
    view.draw(flames, camera);
}

inline void fire_headless(course::Program& program, const Choices& choices, const FireObstacles& scene) {
    FireRun run(scene, choices.speed);
    const double dt_s = scene.fire.dt_s, duration_s = scene.duration_s / choices.speed;
    const int steps = program.options.steps > 0 ? program.options.steps : int(std::ceil(duration_s / dt_s));
    const std::uint32_t n = fire::particle_count(scene.fire.fire);
    course::Table table("The ball and the flames",
                        {"step", "time (s)", "x (m)", "y (m)", "inside", "deepest (m)"});
    course::Stills stills(program);
    course::Progress progress(scene.fire.name, steps);
    const auto row = [&](int step, const fire::FlameArrays& flames) {
        const Observation seen = observe(flames.position, flames.velocity, n, 1, run.obstacles());
        const Motion motion = run.obstacles().empty() ? Motion{} : run.obstacles().motion(0);
        table.row({step, step * dt_s, motion.position_m.x, motion.position_m.y, seen.inside, seen.deepest_m});
    };
    if (choices.draws()) {
        const auto context = course::make_headless_context();
        program.result().note("OpenGL " + context->info().version + ", " + context->info().renderer);
        fire::FireView view(scene.fire, program.options.width, program.options.height);
        fire::SharedFire shared(scene.fire);
        for (int step = 0; step <= steps; ++step) {
            const fire::FlameArrays flames = shared.map();
            if (step > 0) run.step(flames);
            if (is_still(step, steps)) row(step, flames);
            shared.unmap();
            if (is_still(step, steps)) {
                draw(view, shared, run, fire::camera_of(scene.fire));
                stills.add(view.image(), step, step * dt_s);
            }
            progress.update(step);
        }
    } else {
        course::DeviceBuffer<float4> position(n), velocity(n);
        course::DeviceBuffer<std::uint32_t> generation(n);
        const fire::FlameArrays flames{position.data(), velocity.data(), generation.data()};
        fire::launch_flame_clear(flames, scene.fire.fire);
        for (int step = 0; step <= steps; ++step) {
            if (step > 0) run.step(flames);
            if (is_still(step, steps)) row(step, flames);
        }
    }
    stills.finish();
    program.result().table(table);
}

inline void fire_window(course::Program& program, const Choices& choices, const FireObstacles& scene) {
    const course::ProgramOptions& options = program.options;
    const auto window = course::make_window(options.width, options.height, "Obstacles: " + options.scene);
    auto run = std::make_unique<FireRun>(scene, choices.speed);
    fire::SharedFire flames(scene.fire);
    fire::FireView view(scene.fire, options.width, options.height);
    std::printf("%s; handover: %s\n", window->info().renderer.c_str(), flames.position().why().c_str());
    print_keys();
    course::OrbitCamera orbit = scene.fire.view;
    glm::dvec3 hand_m = scene.obstacles.empty() ? glm::dvec3(0) : run->obstacles().motion(0).position_m;
    bool paused = false;
    for (int frame = 0; !window->closed() && (choices.frames == 0 || frame < choices.frames); ++frame) {
        const course::WindowEvents events = window->poll();
        if (events.pause) paused = !paused;
        if (events.step) paused = true;
        if (events.reset) {
            flames.reset();
            run = std::make_unique<FireRun>(scene, choices.speed);
            hand_m = scene.obstacles.empty() ? glm::dvec3(0) : run->obstacles().motion(0).position_m;
        }
        steer_camera(orbit, events, options.height);
        const course::Camera camera = fire::camera_of(scene.fire, orbit);
        if (!scene.obstacles.empty()) {
            hand_m = dragged(hand_m, events, camera, options.height);
            run->obstacles().lead(0, hand_m);
        }
        if (!paused || events.step) {
            run->step(flames.map());
            flames.unmap();
        }
        draw(view, flames, *run, camera);
        if (events.screenshot) {
            const std::string file = "screenshot_" + std::to_string(frame) + ".png";
            course::save_png(options.out / file, view.image());
            std::printf("%s\n", (options.out / file).string().c_str());
        }
        window->show(view.picture());
    }
}

inline void run_fire(course::Program& program, const Choices& choices) {
    const course::ProgramOptions& options = program.options;
    course::require_memory(double(options.particles) * 3 * fire::kFlameBytes);
    const FireObstacles scene = fire_scene(options, choices);
    if (options.explain) {
        const FireRun run(scene, choices.speed);
        const Launches flames{{scene.fire.curl ? "flame_step_kernel<true>" : "flame_step_kernel<false>", 1}};
        std::printf("%s", explain(options.scene, flames, launches_per_step(run.obstacles()), run.obstacles(),
                                  false, choices.draws())
                              .c_str());
    } else if (options.window) {
        fire_window(program, choices, scene);
    } else {
        fire_headless(program, choices, scene);
    }
}

}  // namespace obstacles
