// Chapter 12: spheres and boxes in water and in fire.
#include "12_obstacles/fire_program.cuh"
#include "12_obstacles/marble_run.cuh"
#include "12_obstacles/studies.cuh"

namespace {

using namespace obstacles;

WaterSettings water_settings(const course::ProgramOptions& options, const Choices& choices) {
    WaterSettings settings;
    for (const WaterScene& scene : water_scenes())
        if (scene.water.name == options.scene) settings.scene = scene;
    adjust(settings.scene.obstacles, choices);
    settings.skin = choices.skin == "bare" ? Skin::bare : Skin::ghost;
    settings.control = options.window ? Control::hand : Control::path;
    settings.particles = options.particles;
    settings.dt_s = options.dt_s;
    settings.speed = choices.speed;
    settings.seed = options.seed;
    return settings;
}

void run_water(course::Program& program, const Choices& choices) {
    const course::ProgramOptions& options = program.options;
    const WaterSettings settings = water_settings(options, choices);
    course::require_memory(double(settings.particles) *
                           (2 * sizeof(float4) + sph::Water::bytes_per_particle(true)));
    const auto make = [&] { return WaterRun(settings); };
    if (options.explain) {
        const WaterRun run = make();
        const sph::Settings water = run.water_settings();
        std::printf("%s", explain(options.scene, sph::launches_per_step(water, run.water()),
                                  launches_per_step(run.obstacles(), settings.skin, run.water().state()),
                                  run.obstacles(), true, choices.draws())
                              .c_str());
    } else if (options.window) {
        run_window<WaterRun>(program, choices, make);
    } else {
        WaterRun run = make();
        run_headless(program, choices, run);
    }
}

void run_marbles(course::Program& program, const Choices& choices) {
    const course::ProgramOptions& options = program.options;
    MarbleSettings settings;
    settings.scene = marbles_on_sphere();
    adjust(settings.scene.obstacles, choices);
    settings.control = options.window ? Control::hand : Control::path;
    settings.particles = options.particles;
    settings.dt_s = options.dt_s;
    settings.speed = choices.speed;
    settings.seed = options.seed;
    course::require_memory(double(settings.particles) *
                           (2 * sizeof(float4) + spring_mass::Marbles::kBytesPerMarble));
    const auto make = [&] { return MarbleRun(settings); };
    if (options.explain) {
        const MarbleRun run = make();
        std::printf("%s", explain(options.scene, spring_mass::launches_per_step(run.marbles()),
                                  launches_per_step(run.obstacles()), run.obstacles(), false, choices.draws())
                              .c_str());
    } else if (options.window) {
        run_window<MarbleRun>(program, choices, make);
    } else {
        MarbleRun run = make();
        run_headless(program, choices, run);
    }
}

// ------------------------------------------------------------------------------------------------ fire

}  // namespace

int main(int argc, char** argv) {
    course::Program program(
        "12_obstacles", "Obstacles",
        "Spheres and boxes that particles bounce off, flow round and push: in water and in fire.");
    program.options.particles = 5832;  // 18^3: the dam of the first scene is a whole cube
    program.options.steps = 0;         // as many as the scene takes
    for (const WaterScene& scene : water_scenes()) program.scenes.push_back(scene.water.name);
    program.scenes.push_back(kMarbleScene);
    program.scenes.push_back(kFireScene);
    Choices choices;
    program.option("--draw", choices.draw, "spheres, or none (numbers alone, no OpenGL)");
    program.option("--skin", choices.skin,
                   "what water feels of an obstacle: ghost (water beyond its surface) or bare (nothing)");
    program.option("--speed", choices.speed, "factor on the speed of the obstacles' paths");
    program.option("--size", choices.size, "factor on the obstacles' sizes");
    program.option("--restitution", choices.restitution, "of the obstacles, 0 to 1; below 0: the scene's");
    program.option("--friction", choices.friction, "of the obstacles, 0 and up; below 0: the scene's");
    program.option("--frames", choices.frames,
                   "close the window after so many frames (0: when the user does)");
    program.flag("--without", choices.without, "the same scene without obstacles");
    declare_studies(program);
    return program.run(argc, argv, [&] {
        check(choices);
        if (!program.options.explain) program.result().device = course::device_name();
        if (program.options.scene == kFireScene)
            run_fire(program, choices);
        else if (program.options.scene == kMarbleScene)
            run_marbles(program, choices);
        else
            run_water(program, choices);
    });
}
