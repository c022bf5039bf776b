// Chapter 14: the surface of chapter 10's water.
#include <chrono>
#include <cstdio>
#include <memory>

#include "14_surface_generation/mesh_file.h"
#include "14_surface_generation/studies.cuh"
#include "14_surface_generation/surface_view.cuh"
#include "common/gl_context.h"
#include "common/gl_window.h"
#include "common/gpu_timer.h"
#include "common/program.h"
#include "common/stills.h"

namespace {

using namespace surface;

constexpr int kStills = 6;          // pictures of a run: the start, the end, and four evenly between
constexpr int kStepsPerCheck = 10;  // as in chapter 10

/// What this program can be asked for, beyond the options that all programs have.
struct Choices {
    std::string draw = "surface", field = "anisotropic", mesh = "none";
    float resolution = 2, iso = 0;
    bool dense = false;
    int frames = 0;
};

Settings make_settings(const course::ProgramOptions& options, const Choices& choices) {
    const auto one_of = [](const std::string& option, const std::string& value,
                           const std::vector<std::string>& allowed) {
        std::string list;
        for (std::size_t k = 0; k < allowed.size(); ++k) {
            if (value == allowed[k]) return int(k);
            list += (k == 0 ? "" : ", ") + allowed[k];
        }
        throw course::BadInput(option + " must be one of " + list + ", not '" + value + "'");
    };
    Settings settings;
    settings.drawing = Drawing(one_of("--draw", choices.draw, {"none", "points", "spheres", "surface"}));
    settings.surface.kind =
        FieldKind(one_of("--field", choices.field, {"colour", "zhu_bridson", "anisotropic"}));
    one_of("--mesh", choices.mesh, {"none", "ply", "obj"});
    if (!(choices.iso >= 0)) throw course::BadInput("--iso must be 0 (what suits the field) or more");
    if (choices.frames < 0) throw course::BadInput("--frames must be 0 or more");
    settings.water.scene = sph::find_scene(sph::all_scenes(), options.scene);
    settings.water.particles = options.particles;
    settings.water.dt_s = options.dt_s;
    settings.water.seed = options.seed;
    settings.water.drawing = settings.drawing == Drawing::points    ? sph::Drawing::points
                             : settings.drawing == Drawing::spheres ? sph::Drawing::spheres
                                                                    : sph::Drawing::none;
    settings.surface.nodes_per_spacing = choices.resolution;
    settings.surface.iso = choices.iso;
    settings.surface.sparse = !choices.dense;
    return settings;
}

/// The run as pictures and numbers. Stills are written as they come: what a run that fails has shown stays.
class Recorder {
  public:
    Recorder(course::Program& program, const Settings& settings, const sph::Start& start)
        : program_(program),
          settings_(settings),
          camera_(interop::first_view(tank_of(settings)).camera()),
          stills_(program) {
        if (settings.drawing == Drawing::none) {  // numbers alone: no OpenGL, and no normals
            numbers_ = std::make_unique<Surface>(settings.surface);
            return;
        }
        context_ = course::make_headless_context();
        view_ = std::make_unique<View>(settings, start, program.options.width, program.options.height);
    }

    void add(const sph::Start& start, int step) {
        const double time_s = step * double(start.dt_s);
        if (numbers_) {
            const auto before = std::chrono::steady_clock::now();
            numbers_->build(start.water.position(), start.water.size());
            mesh_.take(*numbers_);
            CUDA_CHECK(cudaDeviceSynchronize());
            const double seconds =
                std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
            const Measures measures = measure(mesh_.download());
            table_.row({step, time_s, numbers_->brick_count(), mesh_.size().vertices, mesh_.size().triangles,
                        measures.area_m2, measures.volume_m3,
                        1e-6 * double(numbers_->bytes() + mesh_.bytes()), 1e3 * seconds});
            return;
        }
        view_->draw(start.water, camera_);
        stills_.add(view_->image(), step, time_s);
        if (const Surface* surface = view_->surface())
            drawn_.row(
                {step, time_s, surface->brick_count(), surface->size().vertices, surface->size().triangles});
    }

    /// Everything gathered so far goes into the result; also when the run ends by an error.
    void finish() {
        if (!stills_.empty()) {
            program_.result().note("OpenGL " + context_->info().version + ", " + context_->info().renderer +
                                   "; handover: " + view_->handover());
            stills_.finish();
        }
        if (settings_.drawing == Drawing::none) program_.result().table(table_);
        if (settings_.drawing == Drawing::surface) program_.result().table(drawn_);
    }

  private:
    course::Program& program_;
    Settings settings_;
    course::Camera camera_;
    course::Table table_{
        "The surface",
        {"step", "time (s)", "bricks", "vertices", "triangles", "area (m^2)", "volume (m^3)", "MB", "ms"}};
    course::Table drawn_{"The surface", {"step", "time (s)", "bricks", "vertices", "triangles"}};
    std::unique_ptr<Surface> numbers_;
    DeviceMesh mesh_{Normals::none};
    std::unique_ptr<course::GlContext> context_;  // before the view: its objects must go first
    std::unique_ptr<View> view_;
    course::Stills stills_;
};

/// The mesh as a file: the one case where it comes to the host.
void save_mesh(course::Program& program, const Settings& settings, const sph::Water& water,
               const std::string& format) {
    Surface surface(settings.surface);
    surface.build(water.position(), water.size());
    DeviceMesh mesh;
    mesh.take(surface);
    const std::filesystem::path file = program.options.out / ("surface." + format);
    format == "ply" ? save_ply(file, mesh.download()) : save_obj(file, mesh.download());
    program.result().note("The last surface: " + file.string());
}

void run_headless(course::Program& program, const Settings& settings, const Choices& choices,
                  sph::Start& start) {
    const int steps = program.options.steps;
    Recorder recorder(program, settings, start);
    sph::Summarizer summarize(start.water.size());
    course::Progress progress(settings.water.scene.name, steps);
    int stills = 0;
    try {
        for (int step = 0; step <= steps; ++step) {
            const bool still = step >= double(stills) * steps / (kStills - 1);
            if (still || step % kStepsPerCheck == 0)
                sph::check_state(start.water, summarize(start.water), step, start.dt_s);
            if (still) recorder.add(start, step);
            while (still && step >= double(stills) * steps / (kStills - 1) && stills < kStills) ++stills;
            if (step == steps) break;
            start.water.step(start.dt_s);
            CUDA_CHECK(cudaDeviceSynchronize());
            progress.update(step + 1);
        }
    } catch (const course::Unstable&) {
        recorder.finish();
        throw;
    }
    recorder.finish();
    if (choices.mesh != "none") save_mesh(program, settings, start.water, choices.mesh);
}

void run_window(course::Program& program, const Choices& choices, const Settings& settings,
                sph::Start& start) {
    const course::ProgramOptions& options = program.options;
    const auto window =
        course::make_window(options.width, options.height, "Water's surface: " + settings.water.scene.name);
    if (settings.drawing == Drawing::none)
        throw course::BadInput("--window shows something: not with --draw none");
    View view(settings, start, options.width, options.height);
    std::printf(
        "drag: orbit, right drag: move, wheel: zoom, space: pause, S or right: step, R: reset, "
        "P: picture, Esc: end\n");
    sph::Summarizer summarize(start.water.size());
    course::OrbitCamera orbit = interop::first_view(tank_of(settings));
    bool paused = false;
    int step = 0;
    for (int frame = 0; !window->closed() && (choices.frames == 0 || frame < choices.frames); ++frame) {
        const course::WindowEvents events = window->poll();
        if (events.pause) paused = !paused;
        if (events.step) paused = true;
        if (events.reset) {
            start = sph::make_start(settings.water);
            step = 0;
        }
        course::steer(orbit, events, options.height);
        if (!paused || events.step) {
            start.water.step(start.dt_s);
            if (++step % kStepsPerCheck == 0)
                sph::check_state(start.water, summarize(start.water), step, start.dt_s);
        }
        view.draw(start.water, orbit.camera());
        if (events.screenshot) {
            const std::string file = "screenshot_" + course::file_number(step) + ".png";
            course::save_png(options.out / file, view.image());
            std::printf("%s\n", (options.out / file).string().c_str());
        }
        window->show(view.picture());
    }
}

/// The answer to --explain, for which the surface of the start is made.
void print_explanation(const Settings& settings, const sph::Start& start) {
    if (settings.drawing == Drawing::points || settings.drawing == Drawing::spheres) {
        std::printf("%s", explain(settings, nullptr).c_str());
        return;
    }
    Surface surface(settings.surface);
    surface.build(start.water.position(), start.water.size());
    std::printf("%s", explain(settings, &surface).c_str());
}

}  // namespace

int main(int argc, char** argv) {
    course::Program program(
        "14_surface_generation", "The water's surface",
        "A field on a grid that exists only where particles are, and marching cubes in four "
        "kernels: water gets a skin, as a picture or as a file.");
    program.options.particles = 16384;
    program.options.steps = 1000;
    for (const sph::Scene& scene : sph::all_scenes()) program.scenes.push_back(scene.name);
    Choices choices;
    program.option("--draw", choices.draw, "surface, spheres, points, or none (numbers alone, no OpenGL)");
    program.option("--field", choices.field, "anisotropic, zhu_bridson or colour");
    program.option("--resolution", choices.resolution,
                   "nodes of the field for each spacing of the particles");
    program.option("--iso", choices.iso, "value of the field where the surface is (0: what suits the field)");
    program.option("--mesh", choices.mesh, "write the last surface as ply or obj");
    program.flag("--dense", choices.dense, "bricks everywhere in the box, to compare");
    program.option("--frames", choices.frames,
                   "close the window after so many frames (0: when the user does)");
    declare_studies(program);
    return program.run(argc, argv, [&] {
        Settings settings = make_settings(program.options, choices);
        course::require_memory(double(settings.water.particles) *
                               (2 * sizeof(float4) + sph::Water::bytes_per_particle(true)));
        complete(settings.surface);  // bad input is told before the water is made
        sph::Start start = sph::make_start(settings.water);
        settings.surface.particle_spacing_m = start.spacing_m;
        if (program.options.explain) {
            print_explanation(settings, start);
            return;
        }
        program.result().device = course::device_name();
        if (program.options.window)
            run_window(program, choices, settings, start);
        else
            run_headless(program, settings, choices, start);
    });
}
