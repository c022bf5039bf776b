// Chapter 15: water as the eye knows it.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>

#include "15_water_rendering/recording.h"
#include "15_water_rendering/water_view.cuh"
#include "common/gl_context.h"
#include "common/gpu_timer.h"
#include "common/program.h"

namespace {

using namespace water;

constexpr int kStills = 9;         // of the time lapse: the start, the end, and seven evenly between
constexpr int kStepsPerCheck = 10;  // an explosion doubles its speed in a few steps

/// What this program can be asked for, beyond the options that all programs have.
struct Choices {
    std::string draw = "surface", inside = "marched", model = "sph", record;
    int samples = 4, every = 10, frames = 0;
    float nodes = 2, exposure = 0.8f;
    bool schlick = false, no_caustics = false, no_lapse = false;
};

/// The value that `names` gives to a name. @throws course::BadInput listing the names
template <class Value>
Value named(const std::string& option, const std::string& name, const std::vector<std::pair<std::string, Value>>& names) {
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
    want(choices.samples >= 1 && choices.samples <= 1024, "--samples must be from 1 to 1024");
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
    if (look.drawing == Drawing::screen_space && look.inside == Inside::marched) look.inside = Inside::thickness;
    look.schlick = choices.schlick;
    look.caustics = !choices.no_caustics;
    look.samples = choices.samples;
    look.nodes_per_spacing = choices.nodes;
    look.exposure = choices.exposure;
    return look;
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

std::string file_number(int number) {
    char text[16];
    std::snprintf(text, sizeof text, "%06d", number);
    return text;
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
        if (lapse) small.emplace(look, scene, run, std::max(1, o.width / 3), std::max(1, o.height / 3));
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
                                                          " s after the start, step " + std::to_string(o.steps));
        if (film) program.result().note(film->finish());
    }
    if (lapse) {
        while (int(stills.size()) < kStills) stills.push_back(stills.back());  // fewer steps than stills
        course::save_png(o.out / "time_lapse.png", course::contact_sheet(stills, 3));
        program.result().picture("time_lapse.png", "Time lapse, row by row");
    }
    if (!costs.empty()) program.result().table(costs.table());
    course::Table steps("Steps", {"particles", "spacing (m)", "dt (s)", "steps", "ms per step"});
    steps.row({run.size(), run.spacing_m, run.dt_s, o.steps, o.steps ? 1e3 * seconds / o.steps : 0.0});
    program.result().table(steps);
}

}  // namespace

int main(int argc, char** argv) {
    course::Program program("15_water_rendering", "Water",
                            "Light that is mirrored, bent and coloured by water: sky, tiles and sun in one tank");
    program.options.particles = 16384;
    program.options.steps = 800;
    for (const WaterScene& scene : all_scenes()) program.scenes.push_back(scene.name);
    Choices choices;
    program.option("--draw", choices.draw, "surface, screen (screen space), spheres, points, or none (no OpenGL)");
    program.option("--inside", choices.inside, "light in the water: marched, thickness or straight");
    program.option("--model", choices.model, "sph (chapter 10) or marbles (chapter 09)");
    program.option("--samples", choices.samples, "rays of a pixel");
    program.option("--nodes", choices.nodes, "nodes of the field for each spacing of the particles");
    program.option("--exposure", choices.exposure, "of the film");
    program.option("--record", choices.record, "film of the run: FILE.mp4 or FILE.gif");
    program.option("--every", choices.every, "steps from one frame of the film to the next");
    program.option("--frames", choices.frames, "close the window after so many frames (0: when the user does)");
    program.flag("--schlick", choices.schlick, "Schlick's formula in place of Fresnel's");
    program.flag("--no-caustics", choices.no_caustics, "the sun shines on the ground as if there were no water");
    program.flag("--no-lapse", choices.no_lapse, "one picture, no time lapse");
    return program.run(argc, argv, [&] {
        const WaterScene scene = find_scene(all_scenes(), program.options.scene);
        make_look(choices);  // says what is wrong before the long work
        const Model model = named<Model>("--model", choices.model, {{"sph", Model::sph}, {"marbles", Model::marbles}});
        program.result().device = course::device_name();
        const std::unique_ptr<Run> run =
            make_run(scene, model, program.options.particles, program.options.dt_s, program.options.seed);
        run_headless(program, choices, scene, *run);
    });
}
