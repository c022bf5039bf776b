// Chapter 02: ways to take a time step. The tour draws what they do and tells what they cost; --scene runs
// one problem by one method; --study and --stability measure.
#include <cstdio>

#include "02_integrators/checks.h"
#include "02_integrators/methods.h"
#include "02_integrators/pictures.h"
#include "02_integrators/studies.h"
#include "02_integrators/tables.h"
#include "common/program.h"

using namespace integrators;

namespace {

/// What the command line says beyond the options of all programs.
struct Choice {
    std::string method = "leapfrog";
    float zeta = 0.1f, stiffness = 1e6f;
    bool in_float = false;
};

void check(const Choice& choice) {
    with_method<Oscillator>(choice.method, [](auto) {});  // is there such a method?
    if (!(choice.zeta >= 0 && choice.zeta <= 1e6f))
        throw course::BadInput("--zeta must be from 0 to 1000000, not " + to_text(choice.zeta));
    if (!(choice.stiffness >= 1 && choice.stiffness <= 1e12f))
        throw course::BadInput("--stiffness must be from 1 to 1e12, not " + to_text(choice.stiffness));
}

/// Six methods an orbit, six methods a period, and three tables.
void tour(course::Program& program) {
    const course::ProgramOptions& o = program.options;
    course::save_png(o.out / "orbits.png", draw_orbits(o.width, 1600, 10));
    program.result().picture(
        "orbits.png", "Ten orbits of a comet, 1600 evaluations of the force each; blue first, gold last");
    course::save_png(o.out / "phase.png", draw_phase(o.width, 2 * kPi / 12, 11));
    program.result().picture("phase.png",
                             "A disc of oscillators and what eleven steps of 30 degrees make of it");
    program.result().table(energy_table());
    program.result().table(price_table());
    program.result().table(limit_table());
}

/// Flying: the ball of this chapter has its impacts interpolated.
template <class Method, class System>
struct AsFlown {
    using Type = Method;
};
template <class Method>
struct AsFlown<Method, BouncingBall> {
    using Type = ImpactInterpolated<Method>;
};

/// Half the longest stable step, but never longer than a fiftieth of a second. A method that has none gets a
/// twentieth of leapfrog's, in which it grows slowly.
template <class Method, class System>
double chosen_dt_s(const System& system) {
    if constexpr (std::is_same_v<System, BouncingBall>)
        return 0.01;
    else {
        const double limit_s = longest_step_s<Method>(system);
        return std::min(0.02, limit_s > 0 ? 0.5 * limit_s : 0.05 * longest_step_s<Leapfrog>(system));
    }
}
template <class Method, class System>
double known_limit_s(const System& system) {
    if constexpr (std::is_same_v<System, BouncingBall>)
        return std::numeric_limits<double>::infinity();
    else
        return longest_step_s<Method>(system);
}

/// One problem by one method, with its error on the way.
template <class Method, class Real, class System>
void run_one(course::Program& program, const System& system) {
    constexpr int D = System::kDim;
    const course::ProgramOptions& o = program.options;
    const double limit_s = known_limit_s<Method>(system);
    const double dt_s = o.dt_s > 0 ? double(o.dt_s) : chosen_dt_s<Method>(system);
    const char* precision = std::is_same_v<Real, float> ? "float" : "double";
    if (o.explain) {
        std::printf("%s by %s in %s: %d steps of %g s; longest stable step %g s.\n", o.scene.c_str(),
                    Method::kName, precision, o.steps, dt_s, limit_s);
        std::printf(
            "A step is %d evaluation(s) of the force and %zu bytes of state, read and written once.\n",
            Method::kEvaluations, sizeof(Real) * D * (Method::kKeepsForce ? 3 : 2));
        std::printf(
            "Left out: no list of forces, no mass (accelerations only), no time stored: step x dt.\n");
        return;
    }
    course::Table table(o.scene + " by " + Method::kName + " in " + precision,
                        {"step", "t s", "x", "v", "error"});
    const long every = std::max(1, o.steps / 10);
    const State<double, D> exact = system.exact(0, 0);
    const State<Real, D> start = begin(system, Real(0), Vec<Real, D>(exact.x), Vec<Real, D>(exact.v));
    const auto show = [&](long step, const State<Real, D>& s) {
        if (step % every != 0 && step != o.steps) return;
        const State<double, D> now{Vec<double, D>(s.x), Vec<double, D>(s.v), Vec<double, D>(s.force)};
        table.row({std::to_string(step), step * dt_s, to_text<double, D>(now.x), to_text<double, D>(now.v),
                   system.error(now, system.exact(0, step * dt_s))});
    };
    try {
        using Flown = typename AsFlown<Method, System>::Type;
        run_watched<Flown>(system, start, o.steps, dt_s, Method::kName, limit_s, show);
    } catch (const course::Unstable&) {
        program.result().table(table);  // what there was until then
        throw;
    }
    program.result().table(table);
}

template <class System>
void run_scene(course::Program& program, const Choice& choice, const System& system) {
    with_method<System>(choice.method, [&](auto method) {
        using Method = decltype(method);
        if (choice.in_float)
            run_one<Method, float>(program, system);
        else
            run_one<Method, double>(program, system);
    });
}

void explain_tour() {
    std::printf(
        "Two pictures, each method in its panel, and three tables: energy at equal cost, cost at equal "
        "error,\n"
        "longest stable steps. One copy of each problem, in double. A step is at most 4 evaluations of the "
        "force.\n"
        "Left out: no batch of copies and no clock (--study NAME has them), no float, no drag (--scene "
        "damped).\n");
}

}  // namespace

int main(int argc, char** argv) {
    course::Program program("02_integrators", "Integrators",
                            "Ways to take a time step: what they keep, what they cost, and when they break");
    program.options.steps = 1000;
    program.scenes = {"tour",       "oscillator", "damped", "stiff_pair",
                      "stiff_drag", "projectile", "kepler", "bouncing_ball"};
    Choice choice;
    program.option("--method", choice.method,
                   "of a scene other than tour: leapfrog, RK4, implicit-Euler, ...");
    program.option("--zeta", choice.zeta, "drag ratio of the scene damped");
    program.option("--stiffness", choice.stiffness,
                   "stiffness ratio of stiff_pair, drag per second of stiff_drag");
    program.flag("--float", choice.in_float, "compute in float instead of double");
    declare_studies(program);
    return program.run(argc, argv, [&] {
        const course::ProgramOptions& o = program.options;
        if (o.window) throw course::BadInput("--window: this chapter draws pictures only; 06 opens one");
        check(choice);
        const std::string& scene = o.scene;
        if (scene == "tour") return o.explain ? explain_tour() : tour(program);
        if (scene == "oscillator") return run_scene(program, choice, Oscillator{});
        if (scene == "damped") return run_scene(program, choice, Oscillator{1, choice.zeta});
        if (scene == "stiff_pair") return run_scene(program, choice, StiffPair{choice.stiffness});
        if (scene == "stiff_drag") return run_scene(program, choice, MoteInWind{choice.stiffness});
        if (scene == "projectile") return run_scene(program, choice, Projectile{});
        if (scene == "kepler") return run_scene(program, choice, Kepler{});
        return run_scene(program, choice, BouncingBall{});
    });
}
