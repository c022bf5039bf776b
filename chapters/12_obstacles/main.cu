// Chapter 12: spheres and boxes in water and in fire.
#include <cstdio>
#include <memory>

#include "12_obstacles/explain.h"
#include "12_obstacles/fire_run.cuh"
#include "12_obstacles/marble_run.cuh"
#include "12_obstacles/observe.cuh"
#include "12_obstacles/obstacle_view.cuh"
#include "12_obstacles/studies.cuh"
#include "common/gl_context.h"
#include "common/gl_window.h"
#include "common/program.h"

namespace {

using namespace obstacles;

constexpr int kStills = 9;          // pictures of a run: the start, the end, and seven evenly between
constexpr int kStepsPerCheck = 10;  // as in chapter 10
constexpr const char* kFireScene = "flame_around_ball";
constexpr const char* kMarbleScene = "marbles_on_sphere";

/// What this program can be asked for, beyond the options that all programs have.
struct Choices {
    std::string draw = "spheres", skin = "ghost";
    float speed = 1, size = 1, restitution = -1, friction = -1;
    bool without = false;
    int frames = 0;

    bool draws() const { return draw == "spheres"; }
};

void check(const Choices& choices) {
    const auto want = [](bool good, const std::string& sentence) {
        if (!good) throw course::BadInput(sentence);
    };
    want(choices.draw == "spheres" || choices.draw == "none",
         "--draw must be spheres or none, not '" + choices.draw + "'");
    want(choices.skin == "ghost" || choices.skin == "bare",
         "--skin must be ghost or bare, not '" + choices.skin + "'");
    want(choices.frames >= 0, "--frames must be 0 or more");
}

/// The scene's obstacles, as the user wants them.
void adjust(std::vector<Obstacle>& obstacles, const Choices& choices) {
    if (choices.without) obstacles.clear();
    for (Obstacle& o : obstacles) {
        o.solid.half_size_m *= choices.size;
        if (o.control == Control::free) o.mass_kg *= double(choices.size) * choices.size * choices.size;
        if (!(choices.restitution < 0)) o.surface.restitution = choices.restitution;
        if (!(choices.friction < 0)) o.surface.friction = choices.friction;
    }
}

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

std::string file_number(int number) {
    char text[16];
    std::snprintf(text, sizeof text, "%06d", number);
    return text;
}

/// Stills as files and as one sheet. Written as they come: what a run that fails has shown stays.
class Stills {
  public:
    explicit Stills(course::Program& program) : program_(program) {}
    void add(const course::Image& image, int step, double time_s) {
        const std::string file = "still_" + file_number(step) + ".png";
        course::save_png(program_.options.out / file, image);
        captions_.push_back({file, course::format_number(time_s) + " s, step " + std::to_string(step)});
        small_.push_back(course::half_size(image));
    }
    void finish() {
        if (small_.empty()) return;
        course::save_png(program_.options.out / "time_lapse.png", course::contact_sheet(small_, 3));
        program_.result().picture("time_lapse.png", "Time lapse, row by row");
        for (const auto& [file, caption] : captions_) program_.result().picture(file, caption);
    }

  private:
    course::Program& program_;
    std::vector<course::Image> small_;
    std::vector<std::pair<std::string, std::string>> captions_;
};

/// Is this step one of kStills, spread evenly over the run?
bool is_still(int step, int steps) {
    if (step == 0 || step == steps) return true;
    return (long(step) * (kStills - 1)) / steps != (long(step - 1) * (kStills - 1)) / steps;
}

// ------------------------------------------------------------------------------- particles in a tank

/// @tparam Run  WaterRun, or another that moves particles and obstacles together
template <class Run>
void run_headless(course::Program& program, const Choices& choices, Run& run) {
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
    Stills stills(program);
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
void steer_camera(course::OrbitCamera& orbit, const course::WindowEvents& events, int height_px) {
    course::WindowEvents camera_events = events;
    camera_events.drag_x_px = events.pan_x_px, camera_events.drag_y_px = events.pan_y_px;
    camera_events.pan_x_px = camera_events.pan_y_px = 0;
    course::steer(orbit, camera_events, height_px);
}

void print_keys() {
    std::printf(
        "drag: move the obstacle, right drag: orbit, wheel: zoom, space: pause, S or right: step, R: reset, "
        "P: picture, Esc: end\n");
}

template <class Run, class Make>
void run_window(course::Program& program, const Choices& choices, const Make& make) {
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
            const std::string file = "screenshot_" + file_number(step) + ".png";
            course::save_png(options.out / file, view.image());
            std::printf("%s\n", (options.out / file).string().c_str());
        }
        window->show(view.picture());
    }
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

/// The fire with its ball, which may have been left out.
FireObstacles fire_scene(const course::ProgramOptions& options, const Choices& choices) {
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

void draw(fire::FireView& view, fire::SharedFire& flames, const FireRun& run, const course::Camera& camera) {
    if (!run.obstacles().empty()) place_ball(view.renderer().stage, run.obstacles().now().obstacle[0].to_m);
    view.draw(flames, camera);
}

void fire_headless(course::Program& program, const Choices& choices, const FireObstacles& scene) {
    FireRun run(scene, choices.speed);
    const double dt_s = scene.fire.dt_s, duration_s = scene.duration_s / choices.speed;
    const int steps = program.options.steps > 0 ? program.options.steps : int(std::ceil(duration_s / dt_s));
    const std::uint32_t n = fire::particle_count(scene.fire.fire);
    course::Table table("The ball and the flames",
                        {"step", "time (s)", "x (m)", "y (m)", "inside", "deepest (m)"});
    Stills stills(program);
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

void fire_window(course::Program& program, const Choices& choices, const FireObstacles& scene) {
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

void run_fire(course::Program& program, const Choices& choices) {
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
