// Chapter 11: both models of water from the same start, timed at growing sizes, and explained.
#include <chrono>
#include <cstdio>

#include "11_water_compared/answers.h"
#include "11_water_compared/pictures.cuh"
#include "11_water_compared/studies.cuh"
#include "common/gl_context.h"
#include "common/program.h"

namespace {

using namespace compared;

/// What this program can be asked for, beyond the options that all programs have.
struct Choices {
    int min_exponent = 14, max_exponent = 0;  // 0: sized for the machine
    int runs = 0, samples = 40;
    float stiffness = 1, dt_factor = 1;
    std::string draw = "spheres";
};

/// On a GPU the thesis's own experiment; on the simulator one that is done within half a minute.
void size_for_the_machine(Choices& choices, int& steps) {
    const bool gpu = course::is_gpu();
    if (choices.max_exponent == 0) choices.max_exponent = gpu ? 19 : 15;
    if (choices.runs == 0) choices.runs = gpu ? 50 : 2;
    if (steps == 0) steps = gpu ? 2000 : 400;
}

Experiment make_experiment(const course::ProgramOptions& options, const Choices& choices) {
    const auto want = [](bool good, const std::string& sentence) {
        if (!good) throw course::BadInput(sentence);
    };
    want(choices.min_exponent >= 6 && choices.min_exponent <= choices.max_exponent &&
             choices.max_exponent <= 24,
         "sizes go from 2^6 to 2^24, and --min-exponent is at most --max-exponent");
    want(choices.runs >= 1 && choices.runs <= 1000, "--runs must be from 1 to 1000");
    want(options.steps >= 2, "--steps must be at least 2");
    want(options.dt_s == 0, "each model has its own time step: use --dt-factor");
    want(choices.samples >= 1, "--samples must be at least 1");
    want(choices.stiffness >= 1e-4f && choices.stiffness <= 1e6f,
         "--stiffness must be from 0.0001 to 1000000");
    want(choices.dt_factor > 0 && choices.dt_factor <= 1e6f,
         "--dt-factor must be above 0, and at most 1000000");
    want(choices.draw == "spheres" || choices.draw == "none",
         "--draw must be spheres or none, not '" + choices.draw + "'");
    Experiment experiment;
    experiment.min_exponent = choices.min_exponent;
    experiment.max_exponent = choices.max_exponent;
    experiment.runs = choices.runs;
    experiment.run.steps = options.steps;
    experiment.run.samples = std::min(choices.samples, options.steps / 2);
    experiment.run.stiffness = choices.stiffness;
    experiment.run.dt_factor = choices.dt_factor;
    experiment.run.seed = options.seed;
    return experiment;
}

const Drop drop_of(const std::string& scene) {
    return scene == "drop" ? from_the_middle() : along_the_left_wall();
}

/// A line on standard error: which run, how far it is, and how long all of them will take.
class Countdown {
  public:
    explicit Countdown(const std::vector<RunPlan>& plans) {
        for (const RunPlan& plan : plans) work_left_ += work_of(plan);
    }
    void skip(const RunPlan& plan) { work_left_ -= work_of(plan); }
    void start(const RunPlan& plan, std::size_t number, std::size_t count) {
        std::fprintf(stderr, "[%zu/%zu] %s, 2^%d particles, run %d%s\n", number, count,
                     name_of(plan.model).c_str(), plan.exponent, plan.run, time_left().c_str());
    }
    void finish(const RunPlan& plan) {
        work_left_ -= work_of(plan);
        work_done_ += work_of(plan);
    }

  private:
    /// SPH walks through some ten times as many neighbours; the estimate corrects itself as runs are done.
    static double work_of(const RunPlan& plan) {
        return double(plan.particles()) * plan.steps * (plan.model == Model::sph ? 5 : 1);
    }
    std::string time_left() const {
        if (work_done_ == 0) return "";
        const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start_;
        char text[64];
        std::snprintf(text, sizeof text, "; about %.0f s left", passed.count() / work_done_ * work_left_);
        return text;
    }

    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    double work_left_ = 0, work_done_ = 0;
};

/// Makes the runs that are not done yet.
std::vector<RunRecord> make_runs(const Experiment& experiment, const Drop& drop,
                                 const std::filesystem::path& folder) {
    const std::vector<RunPlan> plans = plans_of(experiment);
    course::make_writable_folder(folder);
    std::vector<RunRecord> records;
    Countdown countdown(plans);
    int found = 0;
    for (std::size_t k = 0; k < plans.size(); ++k) {
        RunRecord record;
        if (load(folder, plans[k], course::device_name(), record)) {
            ++found;
            countdown.skip(plans[k]);
        } else {
            countdown.start(plans[k], k + 1, plans.size());
            record = measure(plans[k], drop, [](int) {});
            save(folder, record);
            countdown.finish(plans[k]);
        }
        records.push_back(record);
    }
    if (found > 0)
        std::fprintf(stderr, "%d of %zu runs were done before: %s\n", found, plans.size(), folder.c_str());
    return records;
}

course::Table table_of_sizes(const std::vector<RunRecord>& records) {
    course::Table table(
        "Time of a step (median of the runs, and their quartiles)",
        {"particles", "model", "runs", "ms per step", "quartiles (ms)", "dt (ms)", "s per simulated s",
         "interactions per particle", "most neighbours", "fullest cell"});
    for (const int exponent : sizes_of(records))
        for (const Model model : {Model::spring_mass, Model::sph}) {
            const std::vector<RunRecord> repeats = of_size(records, model, exponent);
            const course::Timing time = timing_of(repeats);
            double partners = 0;
            std::uint32_t most = 0, fullest = 0, count = 0;
            for (const RunRecord& r : repeats)
                for (const Sample& s : r.samples) {
                    partners += s.mean_partners;
                    most = std::max(most, s.most_neighbours);
                    fullest = std::max(fullest, s.fullest_cell);
                    ++count;
                }
            table.row(
                {1u << exponent, name_of(model), repeats.size(), 1e3 * time.median_s,
                 course::format_number(1e3 * time.low_s) + " to " + course::format_number(1e3 * time.high_s),
                 1e3 * repeats[0].dt_s, time.median_s / repeats[0].dt_s, partners / count, most, fullest});
        }
    return table;
}

course::Table table_of_passes(const std::vector<RunRecord>& records, int exponent) {
    course::Table table("Where a step's time goes, 2^" + std::to_string(exponent) + " particles",
                        {"model", "pass", "ms per step", "part"});
    for (const Model model : {Model::spring_mass, Model::sph}) {
        const std::vector<RunRecord> repeats = of_size(records, model, exponent);
        double all = 0;
        for (const auto& [name, seconds] : repeats[0].passes) all += seconds;
        for (std::size_t k = 0; k < repeats[0].passes.size(); ++k) {
            std::vector<double> seconds;
            for (const RunRecord& r : repeats)
                if (k < r.passes.size()) seconds.push_back(r.passes[k].second);
            const double median = course::timing_of(seconds).median_s;
            table.row({name_of(model), repeats[0].passes[k].first, 1e3 * median, median / all});
        }
    }
    return table;
}

void draw(course::Program& program, const RunPlan& settings, std::uint32_t particles) {
    const auto context = course::make_headless_context();
    const course::ProgramOptions& options = program.options;
    RunPlan plan = settings;
    plan.exponent = 0;
    while ((2u << plan.exponent) <= particles) ++plan.exponent;
    const Drop drop = along_the_left_wall();
    const std::vector<double> moments_s = {0.15, 0.3, 0.6, 1.2};
    course::Progress progress("pictures", 2 * (long(moments_s.size()) + (kStills - 1) * kStepsPerStill));
    long done = 0;
    std::vector<course::Image> side_by_side(2 * moments_s.size());
    for (const Model model : {Model::spring_mass, Model::sph}) {
        plan.model = model;
        const auto told = [&] { progress.update(++done); };
        const std::vector<course::Image> stills =
            at_moments(plan, drop, moments_s, options.width / 2, options.height / 2, told);
        for (std::size_t k = 0; k < stills.size(); ++k)
            side_by_side[2 * k + (model == Model::sph)] = stills[k];
        std::vector<course::Image> lapse = time_lapse(plan, drop, options.width, options.height, told);
        for (course::Image& still : lapse) still = course::half_size(still);
        const std::string file =
            std::string("time_lapse_") + (model == Model::sph ? "sph" : "spring_mass") + ".png";
        course::save_png(options.out / file, course::contact_sheet(lapse, 3));
        program.result().picture(file, name_of(model) + ": a still each 100 steps, row by row");
    }
    course::save_png(options.out / "side_by_side.png", course::contact_sheet(side_by_side, 2));
    program.result().picture("side_by_side.png",
                             "Left spring-mass, right SPH, " + std::to_string(plan.particles()) +
                                 " particles, 0.15, 0.3, 0.6 and 1.2 s after the gate is gone");
}

}  // namespace

int main(int argc, char** argv) {
    course::Program program(
        "11_water_compared", "Two waters compared",
        "The same block of particles as marbles and as SPH water: what a step of each costs "
        "as the number grows, and why.");
    program.options.particles = 16384;
    program.options.steps = 0;
    program.scenes = {"drop", "dam_break"};
    Choices choices;
    program.option("--min-exponent", choices.min_exponent, "the smallest size is 2 to the power of this");
    program.option("--max-exponent", choices.max_exponent,
                   "the largest (0: 19 on a GPU, 15 on the simulator)");
    program.option("--runs", choices.runs, "repeats of each size (0: 50 on a GPU, 2 on the simulator)");
    program.option("--samples", choices.samples, "looks at the particles in each run");
    program.option("--stiffness", choices.stiffness, "factor on both models' stiffness");
    program.option("--dt-factor", choices.dt_factor, "factor on both models' time step");
    program.option("--draw", choices.draw, "spheres, or none (numbers alone, no OpenGL)");
    declare_studies(program);
    return program.run(argc, argv, [&] {
        size_for_the_machine(choices, program.options.steps);
        const Experiment experiment = make_experiment(program.options, choices);
        course::require_memory(
            std::ldexp(double(sph::Water::bytes_per_particle(true)) + 200, experiment.max_exponent));
        if (program.options.explain) {
            std::printf("%s", explain(experiment, choices.draw != "none").c_str());
            return;
        }
        program.result().device = course::device_name();
        const std::vector<RunRecord> records =
            make_runs(experiment, drop_of(program.options.scene), program.options.out / "runs");
        program.result().table(table_of_sizes(records));
        program.result().table(table_of_passes(records, experiment.max_exponent));
        program.result().note(answer_crossover(records));
        for (const Model model : {Model::spring_mass, Model::sph})
            program.result().note(answer_crowding(of_size(records, model, experiment.max_exponent)));
        if (choices.draw != "none") draw(program, experiment.run, program.options.particles);
    });
}
