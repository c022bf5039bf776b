// Chapter 13: fire and smoke as a volume.
#include <cstdio>

#include "13_volume_rendering/explain.h"
#include "13_volume_rendering/studies.cuh"
#include "common/gpu_timer.h"
#include "common/program.h"

namespace {

using namespace volume;

constexpr int kLapse = 6;         // pictures of the time lapse...
constexpr float kLapse_s = 0.1f;  // ...and the time between them

/// What this program can be asked for, beyond the options that all programs have.
struct Choices {
    float cell_m = 0, step_in_cells = 0;
    int samples = 0;
    bool no_shadows = false, no_skipping = false, no_detail = false, still_only = false;
};

VolumeScene chosen_scene(const course::ProgramOptions& options, const Choices& choices,
                         const std::string& name) {
    if (options.window) throw course::BadInput("--window: this chapter draws pictures only; 06 opens one");
    const auto want = [](bool good, const std::string& sentence) {
        if (!good) throw course::BadInput(sentence);
    };
    want(!choices.still_only || options.csv.empty(), "--still-only makes no table that --csv could take");
    want(choices.cell_m >= 0 && choices.cell_m <= 1, "--cell must be from 0 (the scene's) to 1 m");
    want(choices.step_in_cells >= 0 && choices.step_in_cells <= 1000,
         "--march-step must be from 0 (the scene's) to 1000 cells");
    want(choices.samples >= 0 && choices.samples <= 64, "--samples must be from 0 (the scene's) to 64");
    VolumeScene scene = volume::make_scene(name, options.particles, options.seed);
    if (options.dt_s > 0) scene.dt_s = options.dt_s;
    if (choices.cell_m > 0) scene.look.cell_m = choices.cell_m;
    if (choices.step_in_cells > 0) scene.look.step_in_cells = choices.step_in_cells;
    if (choices.samples > 0) scene.look.samples = choices.samples;
    if (choices.no_shadows) scene.look.shadows = false;
    if (choices.no_skipping) scene.look.block_edge = 0;
    if (choices.no_detail) scene.look.detail.reach_m = 0;
    fire::check(scene.fire, scene.name, scene.dt_s);
    return scene;
}

void save(course::Program& program, const std::string& file, const course::Image& image,
          const std::string& caption) {
    course::save_png(program.options.out / file, image);
    program.result().picture(file, caption);
}

/// The same fire with one thing more from picture to picture.
course::Image parts(const VolumeScene& scene, const Particles& particles, int width, int height) {
    std::vector<course::Image> pictures;
    Photographer photographer(width, height, scene.look);
    for (int k = 0; k < 4; ++k) {
        VolumeLook look = scene.look;
        look.samples = 1;
        if (k < 2) look.light_edge = 0;
        if (k < 3) look.shadows = false;
        look.detail.risen_m = scene.detail_rises_m_per_s * particles.time_s();
        FireVolume fire(look);
        // The first kind, flame, comes first: without the others' numbers there is no smoke.
        fire.fill(particles.position(), particles.velocity(),
                  k == 0 ? scene.look.cargos.first[1] : particles.size());
        pictures.push_back(photographer.photograph(fire, camera_of(scene)));
    }
    return course::contact_sheet(pictures, 2);
}

/// The volume of the particles as they are now.
void fill(FireVolume& fire, const VolumeScene& scene, Particles& particles) {
    particles.check_state();
    fire.look().detail.risen_m = scene.detail_rises_m_per_s * particles.time_s();
    fire.fill(particles.position(), particles.velocity(), particles.size());
}

void cost(course::Program& program, const VolumeScene& scene, Particles& particles, FireVolume& fire,
          Photographer& photographer) {
    course::Table table("Cost of a picture on " + program.result().device,
                        {"particles", "cells", "device MB", "step ms", "fill ms", "picture ms"});
    const float step_ms = course::median_milliseconds(3, [&] { particles.step(); });
    const float fill_ms = course::median_milliseconds(1, [&] { fill(fire, scene, particles); });
    const float picture_ms =
        course::median_milliseconds(1, [&] { photographer.photograph(fire, camera_of(scene)); });
    table.row({particles.size(), fire.splatter().cells().cell_count(), 1e-6 * double(fire.bytes()), step_ms,
               fill_ms, picture_ms});
    program.result().table(table);
}

/// @param with_parts  the same fire once more, with one thing more from picture to picture
void draw_pictures(course::Program& program, const VolumeScene& scene, const Choices& choices,
                   bool with_parts) {
    const course::ProgramOptions& o = program.options;
    Particles particles(scene);
    const int frames = choices.still_only ? 1 : kLapse;
    const int between = std::max(1, int(kLapse_s / scene.dt_s + 0.5f));
    course::Progress progress(scene.name, scene.warm_up_steps + o.steps + frames - 1);
    for (int k = 0; k < scene.warm_up_steps + o.steps; ++k) {
        particles.step();
        progress.update(k + 1);
    }
    FireVolume fire(scene.look);
    Photographer photographer(o.width, o.height, scene.look);
    fill(fire, scene, particles);
    save(program, scene.name + ".png", photographer.photograph(fire, camera_of(scene)),
         "The " + scene.name + " after " + course::format_number(particles.time_s()) + " s");
    if (choices.still_only) return;

    fire.look().samples = 1;  // half as large, and many: one ray a pixel will do
    const int width = std::max(1, o.width / 2), height = std::max(1, o.height / 2);
    if (with_parts)
        save(program, scene.name + "_parts.png", parts(scene, particles, width, height),
             "Flame alone; black smoke; smoke lit by the fire; and shading itself");
    Photographer small(width, height, scene.look);
    std::vector<course::Image> lapse;
    for (int frame = 0; frame < frames; ++frame) {
        if (frame > 0)
            for (int k = 0; k < between; ++k) particles.step();
        fill(fire, scene, particles);
        lapse.push_back(small.photograph(fire, camera_of(scene)));
        progress.update(scene.warm_up_steps + o.steps + frame);
    }
    save(program, scene.name + "_time_lapse.png", course::contact_sheet(lapse, 3),
         "Time lapse, row by row, " + course::format_number(between * scene.dt_s) + " s apart");
    cost(program, scene, particles, fire, small);
}

}  // namespace

int main(int argc, char** argv) {
    course::Program program(
        "13_volume_rendering", "Fire as a volume",
        "Soot and heat of particles on a grid: flames glow, smoke hides, and shades itself");
    program.options.particles = 40000;
    program.options.steps = 0;
    program.scenes = {"all"};
    for (const std::string& name : volume::scene_names()) program.scenes.push_back(name);
    Choices choices;
    program.option("--cell", choices.cell_m, "edge of a cell in m (0: the scene's)");
    program.option("--march-step", choices.step_in_cells, "step of the march in cells (0: the scene's)");
    program.option("--samples", choices.samples, "rays of a pixel, 1 to 64 (0: the scene's)");
    program.flag("--no-shadows", choices.no_shadows, "smoke does not shade smoke");
    program.flag("--no-skipping", choices.no_skipping, "march through empty space as well");
    program.flag("--no-detail", choices.no_detail, "nothing finer than the cells");
    program.flag("--still-only", choices.still_only, "one picture, nothing else");
    program.study(step_size_question(), study_step_size);
    program.study(grid_resolution_question(), study_grid_resolution);
    program.study(skipping_question(), study_skipping);
    program.study(sprites_question(), study_sprites);
    return program.run(argc, argv, [&] {
        const course::ProgramOptions& options = program.options;
        std::vector<VolumeScene> scenes;
        for (const std::string& name : volume::scene_names())
            if (options.scene == "all" || options.scene == name)
                scenes.push_back(chosen_scene(options, choices, name));
        if (options.explain) {
            for (const VolumeScene& scene : scenes)
                std::printf("%s:\n%s", scene.name.c_str(), explain(scene).c_str());
            return;
        }
        program.result().device = course::device_name();
        for (const VolumeScene& scene : scenes) {
            const grid::CellGrid cells = grid_over(scene.look.low_m, scene.look.high_m, scene.look.cell_m);
            course::require_memory(double(cells.cell_count()) * double(Splatter::kBytesPerCell) +
                                   double(options.particles) * double(fire::kFlameBytes) +
                                   80.0 * options.width * options.height);
        }
        for (const VolumeScene& scene : scenes)
            draw_pictures(program, scene, choices, scenes.size() == 1 || scene.name == "campfire");
        if (program.result().device.find("simulator") != std::string::npos)
            program.result().note("Times of the CUDA simulator, on the CPU: they say nothing about a GPU.");
    });
}
