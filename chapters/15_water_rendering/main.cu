// Chapter 15: water as the eye knows it.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>

#include "15_water_rendering/explain.h"
#include "15_water_rendering/panel.h"
#include "15_water_rendering/recording.h"
#include "15_water_rendering/studies.cuh"
#include "common/gl_context.h"
#include "common/gpu_timer.h"
#include "common/program.h"
#include "common/stills.h"

namespace {

using namespace water;

constexpr int kStills = 9;          // of the time lapse: the start, the end, and seven evenly between
constexpr int kStepsPerCheck = 10;  // an explosion doubles its speed in a few steps

/// What this program can be asked for, beyond the options that all programs have.
struct Choices {
    std::string draw = "surface", inside = "marched", model = "sph", record;
    int samples = 0, every = 10, frames = 0;
    float nodes = 2, exposure = 0.85f;
    bool schlick = false, no_caustics = false, no_lapse = false, compare = false;
};

/// The value that `names` gives to a name. @throws course::BadInput listing the names
template <class Value>
Value named(const std::string& option, const std::string& name,
            const std::vector<std::pair<std::string, Value>>& names) {
    std::string all;
    for (const auto& [known, value] : names) {
        if (known == name) return value;
        all += (all.empty() ? "" : ", ") + known;
    }
    throw course::BadInput(option + " must be one of " + all + ", not '" + name + "'");
}

Look make_look(const Choices& choices) {
    const auto want = [](bool good, const char* sentence) {
        if (!good) throw course::BadInput(sentence);
    };
    want(choices.samples >= 0 && choices.samples <= 1024,
         "--samples must be from 0 (4, or 1 in a window) to 1024");
    want(choices.nodes >= 0.25f && choices.nodes <= 8, "--nodes must be from 0.25 to 8");
    want(choices.exposure >= 0.01f && choices.exposure <= 100, "--exposure must be from 0.01 to 100");
    want(choices.every >= 1, "--every must be 1 or more");
    want(choices.frames >= 0, "--frames must be 0 or more");
    Look look;
    if (choices.draw != "none")
        look.drawing = named<Drawing>("--draw", choices.draw,
                                      {{"surface", Drawing::surface},
                                       {"screen", Drawing::screen_space},
                                       {"spheres", Drawing::spheres},
                                       {"points", Drawing::points},
                                       {"none", Drawing::points}});
    look.inside = named<Inside>(
        "--inside", choices.inside,
        {{"marched", Inside::marched}, {"thickness", Inside::thickness}, {"straight", Inside::straight}});
    look.schlick = choices.schlick;
    look.caustics = !choices.no_caustics;
    if (choices.samples > 0) look.samples = choices.samples;
    look.nodes_per_spacing = choices.nodes;
    look.exposure = choices.exposure;
    return checked(look);
}

/// Milliseconds of each pass, of all pictures that were drawn.
class Costs {
  public:
    void add(const PassClock& clock) {
        for (const auto& [pass, milliseconds] : clock.passes()) {
            if (!times_.count(pass)) order_.push_back(pass);
            times_[pass].push_back(milliseconds);
        }
    }
    course::Table table() {
        course::Table table("Milliseconds of a picture's passes, median", order_);
        std::vector<course::Cell> cells;
        for (const std::string& pass : order_) {
            std::vector<double>& t = times_[pass];
            std::nth_element(t.begin(), t.begin() + t.size() / 2, t.end());
            cells.push_back(t[t.size() / 2]);
        }
        table.row(cells);
        return table;
    }
    bool empty() const { return order_.empty(); }

  private:
    std::vector<std::string> order_;
    std::map<std::string, std::vector<double>> times_;
};

/// The same water at the same moment, from the cheapest picture to the dearest.
course::Image side_by_side(const Look& look, const WaterScene& scene, const Run& run, int width_px,
                           int height_px) {
    std::vector<Look> ways(6, look);
    ways[0].drawing = Drawing::points;
    ways[1].drawing = Drawing::spheres;
    ways[2].drawing = Drawing::screen_space;
    ways[3].inside = Inside::straight;
    ways[4].inside = Inside::thickness;
    std::vector<course::Image> pictures;
    for (const Look& way : ways) {
        WaterView view(checked(way), scene, run, width_px, height_px);
        view.draw(run, scene.camera());
        pictures.push_back(view.image());
    }
    return course::contact_sheet(pictures, 2);
}

void run_headless(course::Program& program, const Choices& choices, const WaterScene& scene, Run& run) {
    const course::ProgramOptions& o = program.options;
    std::unique_ptr<course::GlContext> context;  // before the views: their objects must go first
    std::optional<WaterView> large, small;
    std::optional<Recording> film;
    const Look look = make_look(choices);
    const bool draws = choices.draw != "none", lapse = draws && !choices.no_lapse;
    if (draws) {
        context = course::make_headless_context();
        program.result().note("OpenGL " + context->info().version + ", " + context->info().renderer);
        large.emplace(look, scene, run, o.width, o.height);
        large->clock().on = true;
        Look little = look;
        little.sunshine_texels /= 2;
        if (lapse) small.emplace(little, scene, run, std::max(1, o.width / 3), std::max(1, o.height / 3));
        if (!choices.record.empty()) film.emplace(choices.record, o.width, o.height, 30);
    }
    const course::Camera camera = scene.camera();
    std::vector<course::Image> stills;
    Costs costs;
    double seconds = 0;  // of the steps alone
    course::Progress progress(scene.name, o.steps);
    for (int step = 0; step <= o.steps; ++step) {
        if (step % kStepsPerCheck == 0 || step == o.steps) run.check(step);
        if (lapse && step >= double(stills.size()) * o.steps / (kStills - 1)) {
            small->draw(run, camera);
            stills.push_back(small->image());
        }
        if (film && step % choices.every == 0) {
            large->draw(run, camera);
            costs.add(large->clock());
            film->add(large->image());
        }
        if (step == o.steps) break;
        const auto before = std::chrono::steady_clock::now();
        run.step();
        CUDA_CHECK(cudaDeviceSynchronize());
        seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
        progress.update(step + 1);
    }
    if (draws) {
        large->draw(run, camera);
        costs.add(large->clock());
        course::save_png(o.out / (scene.name + ".png"), large->image());
        program.result().picture(scene.name + ".png", course::format_number(o.steps * double(run.dt_s)) +
                                                          " s after the start, step " +
                                                          std::to_string(o.steps));
        if (film) program.result().note(film->finish());
    }
    if (lapse) {
        while (int(stills.size()) < kStills) stills.push_back(stills.back());  // fewer steps than stills
        course::save_png(o.out / "time_lapse.png", course::contact_sheet(stills, 3));
        program.result().picture("time_lapse.png", "Time lapse, row by row");
    }
    if (draws && choices.compare) {
        const course::Image sheet =
            side_by_side(look, scene, run, std::max(1, o.width / 2), std::max(1, o.height / 2));
        course::save_png(o.out / "ways.png", sheet);
        program.result().picture(
            "ways.png", "Points, spheres; screen space, not bent; bent once, followed through the field");
    }
    if (!costs.empty()) program.result().table(costs.table());
    course::Table steps("Steps", {"particles", "spacing (m)", "dt (s)", "steps", "ms per step"});
    steps.row({run.size(), run.spacing_m, run.dt_s, o.steps, o.steps ? 1e3 * seconds / o.steps : 0.0});
    program.result().table(steps);
}

/// The mouse moves the camera; with the right button, the ball, where there is one: in the plane of the
/// picture.
void steer(course::OrbitCamera& orbit, Wishes& wishes, const Stage& stage, course::WindowEvents events,
           const course::Camera& camera, int height_px) {
    if (stage.ball.radius_m > 0) {
        const float metres_per_px =
            2 * orbit.distance_m * std::tan(camera.field_of_view_rad / 2) / float(height_px);
        const glm::mat3 to_world = glm::transpose(glm::mat3(camera.view()));
        const glm::vec3 way_px(events.pan_x_px, -events.pan_y_px, 0);
        const float r = stage.ball.radius_m;
        wishes.ball_m = glm::clamp(wishes.ball_m + metres_per_px * (to_world * way_px), stage.tank_low_m + r,
                                   stage.tank_high_m - r);
        events.pan_x_px = events.pan_y_px = 0;
    }
    course::steer(orbit, events, height_px);
}

void run_window(course::Program& program, const Choices& choices, const WaterScene& scene, Model model) {
    const course::ProgramOptions& o = program.options;
    if (choices.draw == "none" || !choices.record.empty())
        throw course::BadInput("--window draws, and records nothing: leave out --draw none and --record");
    const auto restart = [&] { return make_run(scene, model, o.particles, o.dt_s, o.seed); };
    std::unique_ptr<Run> run = restart();
    const auto window = course::make_window(o.width, o.height, "Water: " + scene.name);
    std::printf("%s\n", window->info().renderer.c_str());
    std::printf(
        "drag: orbit, right drag: move the ball (or the view), wheel: zoom, space: pause, S or right: step, "
        "R: reset, 1 to 4: points, spheres, screen space, surface, P: picture, Esc: end\n");
    if (!course::gui_available())
        std::printf("no panel: Dear ImGui was missing when this was built (Debian: libimgui-dev)\n");
    course::Gui gui(*window);
    Wishes wishes;
    wishes.look = make_look(choices);
    if (choices.samples == 0) wishes.look.samples = 1;
    wishes.ball_m = scene.stage.ball.middle_m;
    std::optional<WaterView> view;
    WaterScene seen = scene;  // its camera moves
    int step = 0;
    double step_ms = 0;
    for (int frame = 0; !window->closed() && (choices.frames == 0 || frame < choices.frames); ++frame) {
        course::WindowEvents events = window->poll();
        const Look before = wishes.look;
        gui.begin(events);
        follow_keys(wishes, events);
        steer(seen.view, wishes, scene.stage, events, seen.camera(), o.height);
        if (view) draw_panel(wishes, scene.stage, view->clock(), step_ms);
        if (!view || !same_view(before, wishes.look)) {
            view.reset();  // free before asking for more
            view.emplace(checked(wishes.look), scene, *run, o.width, o.height);
            view->clock().on = true;
        }
        if (events.reset) {
            run = restart();
            step = 0;
        }
        if (events.step) wishes.paused = true;
        if (!wishes.paused || events.step) {
            const auto start = std::chrono::steady_clock::now();
            run->lead_ball(wishes.ball_m);
            run->step();
            CUDA_CHECK(cudaDeviceSynchronize());
            step_ms = 1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
            if (++step % kStepsPerCheck == 0) run->check(step);
        }
        view->draw(*run, seen.camera());
        if (events.screenshot) {
            const std::string file = "screenshot_" + course::file_number(step) + ".png";
            course::save_png(o.out / file, view->image());
            std::printf("%s\n", (o.out / file).string().c_str());
        }
        window->copy(view->picture());
        gui.end();
        window->set_title(title(scene.name, view->clock(), step_ms));
        window->swap();
    }
}

}  // namespace

int main(int argc, char** argv) {
    course::Program program(
        "15_water_rendering", "Water",
        "Light that is mirrored, bent and coloured by water: sky, tiles and sun in one tank");
    program.options.particles = 16384;
    program.options.steps = 800;
    for (const WaterScene& scene : all_scenes()) program.scenes.push_back(scene.name);
    Choices choices;
    program.option("--draw", choices.draw,
                   "surface, screen (screen space), spheres, points, or none (no OpenGL)");
    program.option("--inside", choices.inside, "light in the water: marched, thickness or straight");
    program.option("--model", choices.model, "sph (chapter 10) or marbles (chapter 09)");
    program.option("--samples", choices.samples, "rays of a pixel (0: 4, in a window 1)");
    program.option("--nodes", choices.nodes, "nodes of the field for each spacing of the particles");
    program.option("--exposure", choices.exposure, "of the film");
    program.option("--record", choices.record, "film of the run: FILE.mp4 or FILE.gif");
    program.option("--every", choices.every, "steps from one frame of the film to the next");
    program.option("--frames", choices.frames,
                   "close the window after so many frames (0: when the user does)");
    program.flag("--schlick", choices.schlick, "Schlick's formula in place of Fresnel's");
    program.flag("--no-caustics", choices.no_caustics,
                 "the sun shines on the ground as if there were no water");
    program.flag("--compare", choices.compare, "one more picture: the same water drawn in six ways");
    program.flag("--no-lapse", choices.no_lapse, "one picture, no time lapse");
    declare_studies(program);
    return program.run(argc, argv, [&] {
        const WaterScene scene = find_scene(all_scenes(), program.options.scene);
        const Look look = make_look(choices);  // says what is wrong before the long work
        const Model model =
            named<Model>("--model", choices.model, {{"sph", Model::sph}, {"marbles", Model::marbles}});
        if (program.options.explain) {
            std::printf("%s", explain(look, choices.draw != "none").c_str());
            return;
        }
        program.result().device = course::device_name();
        // Start on the host, state on the device; the field's nodes, twice for smoothing and once as a
        // texture.
        const double n = program.options.particles, nodes = std::pow(double(look.nodes_per_spacing), 3);
        course::require_memory(n * 300 + (look.has_field() ? 40 * sizeof(float) * n * nodes : 0) +
                               80.0 * program.options.width * program.options.height);
        if (program.options.window) {
            run_window(program, choices, scene, model);
            return;
        }
        const std::unique_ptr<Run> run =
            make_run(scene, model, program.options.particles, program.options.dt_s, program.options.seed);
        run_headless(program, choices, scene, *run);
    });
}
