#include "common/study.h"

#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "common/program.h"

namespace course {

namespace {

/// All digits that a double needs, unlike format_number: rows are data, not text to be read.
std::string exact(double value) {
    if (std::isnan(value)) return "nan";
    if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", value);
    return text;
}

std::string processor_name() {
    std::ifstream file("/proc/cpuinfo");  // Linux; elsewhere there is no such file
    for (std::string line; std::getline(file, line);)
        if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
    return "CPU";
}

nlohmann::ordered_json start_json(const char* kind, const std::string& chapter, const std::string& name,
                                  const std::string& question) {
    nlohmann::ordered_json json;
    json["kind"] = kind;
    json["chapter"] = chapter;
    json["name"] = name;
    json["question"] = question;
    return json;
}

std::string finish(const nlohmann::ordered_json& json) {
    return json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace

Study::Study(StudyQuestion asked, std::string chapter, bool only_quick)
    : question(std::move(asked)), quick(only_quick), device(processor_name()), chapter_(std::move(chapter)) {}
Study::~Study() = default;

void Study::expect(int rows) {
    progress_ = std::make_unique<Progress>(question.name, rows);
    expected_ = rows;
    progress_->update(0);
}

void Study::add(const StudyRow& row) {
    if (row.error < 0) throw std::logic_error("study " + question.name + ": an error below 0");
    if (row.per_step.repeats < 1 || !(row.per_step.median_s > 0) || !(row.steps > 0))
        throw std::logic_error("study " + question.name + ": a row without a time");
    rows_.push_back(row);
    if (progress_) progress_->update(std::min(int(rows_.size()), expected_));
}

std::string Study::csv() const {
    Table table("", {"study", "method", "parameter", "value", "n", "error", "error_kind", "seconds_per_step",
                     "backend", "device", "steps", "seconds_low", "seconds_high", "repeats"});
    for (const StudyRow& row : rows_)
        table.row({question.name, row.method, question.parameter, exact(row.value), exact(row.n),
                   exact(row.error), question.error_kind, exact(row.per_step.median_s), backend, device,
                   exact(row.steps), exact(row.per_step.low_s), exact(row.per_step.high_s),
                   row.per_step.repeats});
    return table.csv();
}

std::string Study::json() const {
    nlohmann::ordered_json json = start_json("study", chapter_, question.name, question.question);
    json["error_kind"] = question.error_kind;
    json["parameter"] = question.parameter;
    json["plot"] =
        question.plot == StudyPlot::error_against_time ? "error_against_time" : "time_against_value";
    json["lines_are_cases"] = question.lines_are_cases;
    json["values_are_problems"] = question.values_are_problems;
    json["backend"] = backend;
    json["device"] = device;
    json["quick"] = quick;
    json["rows"] = nlohmann::ordered_json::array();
    for (const StudyRow& row : rows_)  // JSON has no infinity: an error that is not finite becomes null
        json["rows"].push_back({{"method", row.method},
                                {"value", row.value},
                                {"n", row.n},
                                {"error", row.error},
                                {"seconds_per_step", row.per_step.median_s},
                                {"steps", row.steps},
                                {"seconds_low", row.per_step.low_s},
                                {"seconds_high", row.per_step.high_s},
                                {"repeats", row.per_step.repeats}});
    return finish(json);
}

StabilityMap::StabilityMap(StabilityQuestion asked, std::string chapter, bool only_quick)
    : question(std::move(asked)), quick(only_quick), device(processor_name()), chapter_(std::move(chapter)) {}
StabilityMap::~StabilityMap() = default;

void StabilityMap::expect(int columns) {
    progress_ = std::make_unique<Progress>(question.name, columns);
    expected_ = columns;
    progress_->update(0);
}

double StabilityMap::column(const std::string& method, double stiffness, double theory_limit,
                            const std::vector<double>& factors, int bisections,
                            const std::function<bool(double)>& stable) {
    const std::size_t first_row = rows_.size();
    double largest_stable = 0, smallest_unstable = std::numeric_limits<double>::infinity();
    const auto try_out = [&](double dt) {
        const bool good = stable(dt);
        rows_.push_back({method, dt, stiffness, good, 0, theory_limit});
        return good;
    };
    for (const double factor : factors) {
        const double dt = factor * theory_limit;
        const bool good = try_out(dt);
        // The limit is where stability is lost first: an island of stability beyond it helps nobody.
        if (good && std::isinf(smallest_unstable)) largest_stable = dt;
        if (!good) smallest_unstable = std::min(smallest_unstable, dt);
    }
    const bool bracketed = largest_stable > 0 && std::isfinite(smallest_unstable);
    for (int k = 0; bracketed && k < bisections; ++k) {
        const double middle = std::sqrt(largest_stable * smallest_unstable);
        (try_out(middle) ? largest_stable : smallest_unstable) = middle;
    }
    const double limit = bracketed            ? std::sqrt(largest_stable * smallest_unstable)
                         : largest_stable > 0 ? std::numeric_limits<double>::infinity()
                                              : 0.0;
    for (std::size_t k = first_row; k < rows_.size(); ++k) rows_[k].measured_limit = limit;
    ++columns_;
    if (progress_) progress_->update(std::min(columns_, expected_));
    return limit;
}

std::string StabilityMap::csv() const {
    Table table("", {"stability", "method", "dt", "stiffness", "stable", "measured_limit", "theory_limit"});
    for (const StabilityRow& row : rows_)
        table.row({question.name, row.method, exact(row.dt), exact(row.stiffness), row.stable ? 1 : 0,
                   exact(row.measured_limit), exact(row.theory_limit)});
    return table.csv();
}

std::string StabilityMap::json() const {
    nlohmann::ordered_json json = start_json("stability", chapter_, question.name, question.question);
    json["criterion"] = question.criterion;
    json["theory"] = question.theory;
    json["stiffness"] = question.stiffness;
    json["dt"] = question.dt;
    json["backend"] = backend;
    json["device"] = device;
    json["quick"] = quick;
    json["rows"] = nlohmann::ordered_json::array();
    for (const StabilityRow& row : rows_)
        json["rows"].push_back({{"method", row.method},
                                {"dt", row.dt},
                                {"stiffness", row.stiffness},
                                {"stable", row.stable},
                                {"measured_limit", row.measured_limit},
                                {"theory_limit", row.theory_limit}});
    return finish(json);
}

}  // namespace course
