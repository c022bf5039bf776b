// Chapter 01: a fountain on the CPU, drawn to PNG; array of structs against struct of arrays; error against
// run time of the time step.
#include <cmath>
#include <cstdio>
#include <cstring>

#include "01_particle_loop/checks.h"
#include "01_particle_loop/film.h"
#include "01_particle_loop/particle_loop.h"
#include "01_particle_loop/scenes.h"
#include "01_particle_loop/stopwatch.h"
#include "common/program.h"

using namespace particle_loop;

namespace {

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
}

/// Both layouts side by side: the same result, at what price?
void compare_layouts(course::Program& program, const Fountain& fountain) {
    course::Table table(
        "One step, and a question that needs one of six numbers (median ns per droplet)",
        {"droplets", "state KiB", "step AoS", "step SoA", "AoS/SoA", "count AoS", "count SoA", "AoS/SoA"});
    std::uint32_t different = 0;
    const std::uint32_t full = life_steps(fountain);  // from this step on, all droplets are in flight
    for (const std::uint32_t n : {1000u, 10000u, 100000u, 1000000u}) {
        std::vector<Particle> aos(n);
        ParticleArrays soa(n);
        for (std::uint32_t i = 0; i < n; ++i) {
            emit(fountain, random_start(fountain.seed, i, 0), aos[i].position_m, aos[i].velocity_m_per_s);
            soa.store(i, aos[i]);
        }
        std::uint32_t s_aos = full, s_soa = full, above = 0;
        const int calls = std::max(1u, 100000u / n);  // so many at once that the clock's own cost vanishes
        const auto [step_aos, step_soa] = compare(
            15,
            [&] {
                for (int k = 0; k < calls; ++k) step(aos, fountain, s_aos++);
            },
            [&] {
                for (int k = 0; k < calls; ++k) step(soa, fountain, s_soa++);
            });
        // Another height each time, and a sum that is used: else the compiler would do the work once, or
        // never.
        const auto [count_aos, count_soa] = compare(
            15,
            [&] {
                for (int k = 0; k < calls; ++k) above += count_above(aos, n, 1e-3f * k);
            },
            [&] {
                for (int k = 0; k < calls; ++k) above -= count_above(soa, n, 1e-3f * k);
            });
        for (std::uint32_t i = 0; i < n; ++i) {
            const Particle p = soa.load(i);
            different += std::memcmp(&p, &aos[i], sizeof p) != 0;
        }
        different += above != 0;
        const double to_ns = 1e9 / calls / n;
        table.row({n, int(n * sizeof(Particle) / 1024), to_ns * step_aos, to_ns * step_soa,
                   step_aos / step_soa, to_ns * count_aos, to_ns * count_soa, count_aos / count_soa});
    }
    program.result().table(table);
    program.result().note(different == 0 ? "Both layouts give the same result, bit for bit."
                                         : "The layouts differ: " + std::to_string(different) + " droplets.");
}

/// Height after t seconds by the formula, in double precision (the README derives it).
double exact_height_m(const Fountain& f, double y0_m, double vy_m_per_s, double t_s) {
    const double k = f.drag_per_s, g = f.gravity_m_per_s2;
    if (k == 0) return y0_m + vy_m_per_s * t_s - 0.5 * g * t_s * t_s;
    return y0_m + (vy_m_per_s + g / k) * -std::expm1(-k * t_s) / k - g / k * t_s;
}

/// How far from the exact height a droplet is after one second, and what a second costs.
void error_against_time(course::Program& program, Fountain fountain) {
    course::Table table("Error against run time: one second of flight of the first jet",
                        {"dt ms", "steps", "error mm", "error / dt", "us per 1000 droplets"});
    const float start_m = 20.0f;  // high enough that no floor is met
    for (const int steps : {25, 50, 100, 250, 500, 1000}) {
        fountain.dt_s = 1.0f / float(steps);
        std::vector<Particle> droplets(1000, Particle{{0, start_m, 0}, fountain.jet_m_per_s[0]});
        std::vector<double> times;
        for (int repeat = 0; repeat < 5; ++repeat) {
            std::fill(droplets.begin(), droplets.end(), Particle{{0, start_m, 0}, fountain.jet_m_per_s[0]});
            times.push_back(seconds([&] {
                for (int s = 0; s < steps; ++s)
                    for (Particle& p : droplets) move(fountain, p.position_m, p.velocity_m_per_s);
            }));
        }
        const double exact_m = exact_height_m(fountain, start_m, fountain.jet_m_per_s[0].y, 1.0);
        const double error_m = std::abs(double(droplets[0].position_m.y) - exact_m);
        table.row({1e3 / steps, steps, 1e3 * error_m, error_m * steps, 1e6 * median(times)});
    }
    program.result().table(table);
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
    bool no_measure = false;
    program.option("--drag", drag_per_s, "linear drag per second (below 0: the scene's)");
    program.option("--restitution", restitution,
                   "vertical speed after / before a bounce (below 0: the scene's)");
    program.flag("--no-measure", no_measure, "pictures only, no tables");
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
        course::require_memory(double(program.options.particles) * sizeof(Particle));
        show(program, fountain);
        if (no_measure) return;
        compare_layouts(program, make_scene("crown"));
        error_against_time(program, make_scene("crown"));
    });
}
