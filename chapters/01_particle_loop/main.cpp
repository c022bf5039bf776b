// Chapter 01: a fountain on the CPU, drawn to PNG. Its studies: error against run time of the time step,
// array of structs against struct of arrays; its stability map: drag.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "01_particle_loop/checks.h"
#include "01_particle_loop/film.h"
#include "01_particle_loop/particle_loop.h"
#include "01_particle_loop/scenes.h"
#include "01_particle_loop/studies.h"
#include "common/program.h"

using namespace particle_loop;

namespace {

/// Where the droplets are, as numbers.
void describe(course::Program& program, const Fountain& fountain, const std::vector<Particle>& particles) {
    const course::ProgramOptions& o = program.options;
    const std::uint32_t born = born_after(fountain, o.particles, o.steps);
    float highest_m = 0, furthest_m = 0, fastest_m_per_s = 0;
    for (std::uint32_t i = 0; i < born; ++i) {
        const glm::vec3 x = particles[i].position_m;
        highest_m = std::max(highest_m, x.y);
        furthest_m = std::max(furthest_m, std::hypot(x.x, x.z));
        fastest_m_per_s = std::max(fastest_m_per_s, glm::length(particles[i].velocity_m_per_s));
    }
    course::Table table("After " + std::to_string(o.steps) + " steps",
                        {"droplets", "time s", "highest m", "furthest from the nozzle m", "fastest m/s"});
    table.row({born, o.steps * fountain.dt_s, highest_m, furthest_m, fastest_m_per_s});
    program.result().table(table);
}

/// Runs the fountain and writes its pictures: also what there is of them when the run becomes unstable.
void show(course::Program& program, const Fountain& fountain) {
    const course::ProgramOptions& o = program.options;
    std::vector<Particle> particles(o.particles);
    Film film(o, fountain);
    course::Progress progress("fountain", o.steps);
    std::uint32_t born = 0;
    try {
        for (int s = 0; s < o.steps; ++s) {
            step(particles, fountain, s);
            born = born_after(fountain, o.particles, s + 1);
            watch(particles, born, fountain, s);
            if (film.wants(s + 1)) film.take(particles, born);
            progress.update(s + 1);
        }
    } catch (const course::Unstable&) {
        film.save_sheet(program.result());
        throw;
    }
    film.save_end(
        program.result(), particles, born,
        std::to_string(born) + " droplets after " + course::format_number(o.steps * fountain.dt_s) + " s");
    film.save_sheet(program.result());
    describe(program, fountain, particles);
}

void explain(const Fountain& fountain, std::uint32_t n) {
    std::printf("A step is two passes over the state: move those in flight, then start %u of %u again.\n",
                n / life_steps(fountain), n);
    std::printf(
        "State: %zu bytes a droplet (position, velocity): %.1f KiB. A step reads and writes each once.\n",
        sizeof(Particle), double(n) * sizeof(Particle) / 1024);
    std::printf(
        "Left out: no age and no generation is stored, both follow from the id and the step; no colour,\n"
        "the picture makes it from the position; no random state, Philox is asked by id; no neighbours.\n");
    std::printf("dt %g s; stable below %g s (2 / drag); a life is %u steps.\n", fountain.dt_s,
                2.0 / fountain.drag_per_s, life_steps(fountain));
}

}  // namespace

int main(int argc, char** argv) {
    course::Program program("01_particle_loop", "A particle loop",
                            "A fountain on the CPU: state, forces, a loop, and a picture without OpenGL");
    program.options.particles = 30000;
    program.options.steps = 700;
    program.scenes = {"crown", "spray"};
    float drag_per_s = -1.0f, restitution = -1.0f;
    program.option("--drag", drag_per_s, "linear drag per second (below 0: the scene's)");
    program.option("--restitution", restitution,
                   "vertical speed after / before a bounce (below 0: the scene's)");
    program.study({"time_step", "What does a smaller time step buy, and when does it buy nothing more?",
                   "largest distance from the exact height after one second of flight, 64 droplets (m)",
                   "dt_s", course::StudyPlot::error_against_time, true},
                  study_time_step);
    program.study({"layout", "Which layout is cheaper, and for what?",
                   "droplets in which the layouts differ, and the difference of their counts", "n",
                   course::StudyPlot::time_against_value, true},
                  study_layout);
    program.stability({"drag", "Up to which time step does drag slow a droplet down?",
                       "after 200 steps the droplet is slower than at the start",
                       "each step multiplies the velocity by 1 - k dt, so dt < 2 / k", "drag k (1/s)"},
                      map_drag);
    return program.run(argc, argv, [&] {
        if (program.options.window)
            throw course::BadInput("--window: this chapter draws pictures only; 06 opens one");
        Fountain fountain = make_scene(program.options.scene);
        fountain.seed = program.options.seed;
        if (program.options.dt_s > 0) fountain.dt_s = program.options.dt_s;
        if (!(drag_per_s < 0)) fountain.drag_per_s = drag_per_s;
        if (!(restitution < 0)) fountain.restitution = restitution;
        check(fountain);
        if (program.options.explain) return explain(fountain, program.options.particles);
        course::require_memory(double(program.options.particles) * sizeof(Particle) +
                               Film::bytes(program.options));
        show(program, fountain);
    });
}
