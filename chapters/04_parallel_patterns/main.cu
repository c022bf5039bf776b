// Chapter 04: five patterns, each in several versions: what they ask of memory, and on a GPU how long they
// take.
#include <cstdio>

#include "04_parallel_patterns/pictures.h"
#include "04_parallel_patterns/studies.cuh"
#include "common/program.h"

using namespace patterns;

namespace {

constexpr std::uint32_t kMostElements = 1u << 24;
constexpr int kRepeats = 20;  // on a GPU: medians of so many runs

void explain(std::uint32_t n, std::uint64_t seed) {
    const Input input = random_input(n, seed);
    std::printf("%u elements; what each version launches, and asks of global memory for each element\n", n);
    for (const Version& version : all_versions()) {
        std::printf("%s, %s: ", version.pattern.c_str(), version.name.c_str());
        if (version.is_library()) {
            std::printf("one call; its kernels are its own affair\n");
            continue;
        }
        const Cost cost = version.cost(input);
        std::printf("%llu %s, %.3g loads, %.3g stores, %.3g atomics\n", (unsigned long long)cost.launches,
                    cost.launches == 1 ? "kernel" : "kernels", double(cost.loads) / n,
                    double(cost.stores) / n, double(cost.atomics) / n);
    }
    std::printf("Left out: no particles that move, so no time step; no window.\n");
}

/// Every version runs once and is checked; on a GPU it is timed as well.
course::Table table_of(const std::vector<Version>& versions, const Input& input, bool on_gpu) {
    std::vector<std::string> columns{"pattern", "version", "launches",       "loads",    "stores",  "MB",
                                     "atomics", "shared",  "shared atomics", "barriers", "warp ops"};
    if (on_gpu) columns.insert(columns.end(), {"ms", "GB/s"});
    course::Table table(
        "What " + std::to_string(input.n()) +
            " elements cost. MB: of loads and stores of global memory. shared: loads and stores of "
            "shared memory.",
        columns);
    course::Progress progress("running every version", long(versions.size()));
    long done = 0;
    for (const Version& version : versions) {
        const Run run = version.prepare(input);
        run.work();
        require_right(version, run);
        std::vector<course::Cell> row{version.pattern, version.name};
        double megabytes = 0;
        if (version.is_library()) {
            row.insert(row.end(), 9, "-");
        } else {
            const Cost c = version.cost(input);
            megabytes = double(c.bytes) / 1e6;
            row.insert(
                row.end(),
                {std::size_t(c.launches), std::size_t(c.loads), std::size_t(c.stores), megabytes,
                 std::size_t(c.atomics), std::size_t(c.shared_loads + c.shared_stores),
                 std::size_t(c.shared_atomics), std::size_t(c.barriers), std::size_t(c.warp_operations)});
        }
        if (on_gpu) {
            const double ms = course::median_milliseconds(kRepeats, run.work);
            row.push_back(ms);
            row.push_back(megabytes > 0 ? course::Cell(megabytes / ms) : course::Cell(""));
        }
        table.row(row);
        progress.update(++done);
    }
    return table;
}

/// The sum that everybody knows, and nobody gets.
course::Table tenths_table() {
    constexpr std::uint32_t kTimes = 10000000;
    const std::vector<float> tenths(kTimes, 0.1f);
    const double exact = double(kTimes) * double(0.1f);  // 24 bits times 24 bits: fits into a double
    course::Table table("0.1f added up ten million times; exact is " + std::to_string(exact),
                        {"method", "sum", "error"});
    for (const Summation& way : summations(tenths)) {
        const double sum = way.sum();
        char text[32];
        std::snprintf(text, sizeof text, "%.4f", sum);
        table.row({way.name, text, std::abs(sum - exact) / exact});
    }
    return table;
}

void show(course::Program& program) {
    const course::ProgramOptions& o = program.options;
    course::Result& result = program.result();
    result.device = course::device_name();
    const bool on_gpu = course::is_gpu();
    const std::vector<Version> versions = all_versions();
    const Input input = random_input(o.particles, o.seed);

    course::save_png(o.out / "steps.png", draw_steps(o.seed, o.width, o.height));
    result.picture("steps.png", "The tree of a reduction, and the doubling steps of a scan");
    course::save_png(o.out / "traffic.png", draw_traffic(versions, input, o.width, o.height));
    result.picture("traffic.png", "What every version asks of global memory");
    result.table(table_of(versions, input, on_gpu));
    result.table(tenths_table());
    result.note(
        "Every version gives what the CPU reference gives, and so does Thrust, whose accesses are not "
        "counted.");
    if (!on_gpu) result.note("Counts, not times: on the CUDA simulator a barrier costs what it costs a CPU.");
}

void declare_studies(course::Program& program) {
    using course::StudyPlot;
    program.study(
        {"summation", "Which way to add floats gives how many digits, in what time?",
         "relative error of the sum against the exact one", "n", StudyPlot::error_against_time, false, true},
        study_summation);
    // How long a barrier takes on the simulator is nobody's question: there the measure is the counts.
    if (!course::is_gpu()) return;
    const std::string exact = "elements that differ from the CPU's result (0: all are exact)";
    program.study(
        {"reduce", "Which sum is fast, for how many elements?", exact, "n", StudyPlot::time_against_value},
        study_reduce);
    program.study(
        {"scan", "Which scan is fast, for how many elements?", exact, "n", StudyPlot::time_against_value},
        study_scan);
    program.study({"histogram", "What does it cost when all elements want the same bin?", exact,
                   "share_in_one_bin", StudyPlot::time_against_value},
                  study_histogram);
    program.study({"compact", "Which compaction is fast, and what does order cost?", exact, "n",
                   StudyPlot::time_against_value},
                  study_compact);
    program.study({"bounds", "What does the CAS loop of the bounds cost against a tree?", exact, "n",
                   StudyPlot::time_against_value},
                  study_bounds);
}

}  // namespace

int main(int argc, char** argv) {
    course::Program program("04_parallel_patterns", "Parallel patterns",
                            "Reduction, scan, histogram, compaction and bounds: what each version costs");
    program.options.particles = 1u << 20;
    declare_studies(program);
    return program.run(argc, argv, [&] {
        const course::ProgramOptions& o = program.options;
        if (o.window) throw course::BadInput("--window: this chapter draws pictures only; 06 opens one");
        if (o.particles > kMostElements)
            throw course::BadInput(
                "--particles (here: elements) must be from 1 to 16777216 in this chapter, not " +
                std::to_string(o.particles));
        if (o.explain) return explain(o.particles, o.seed);
        show(program);
    });
}
