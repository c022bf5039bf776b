// The part of Program that runs studies and stability maps instead of the program's body.
#include <cstdio>

#include "common/errors.h"
#include "common/files.h"
#include "common/program.h"

namespace course {

namespace {

/// The pair whose question has that name. @throws BadInput naming those there are
template <class List>
auto& find_question(const List& list, const std::string& kind, const std::string& name) {
    std::string names;
    for (const auto& entry : list) {
        if (entry.first.name == name) return entry;
        names += (names.empty() ? "" : ", ") + entry.first.name;
    }
    throw BadInput("there is no " + kind + " '" + name +
                   "': " + (names.empty() ? "this program has none" : "choose one of " + names));
}

/// The first columns of the rows, and only digits that carry information.
void print_rows(const Study& study) {
    Table table(study.question.question + "\nerror: " + study.question.error_kind,
                {"method", study.question.parameter, "n", "error", "seconds", "spread"});
    for (const StudyRow& row : study.rows()) {
        const Timing& t = row.per_step;
        table.row({row.method, row.value, row.n, row.error, t.median_s * row.steps,
                   format_number(100 * (t.high_s - t.low_s) / t.median_s) + " %"});
    }
    table.print();
    std::printf("Times: %s, %s; spread: between the quartiles of the repeats.\n", study.backend.c_str(),
                study.device.c_str());
}

void print_rows(const StabilityMap& map) {
    Table table(map.question.question + "\nstable: " + map.question.criterion,
                {"method", map.question.stiffness, "measured limit", "theory", "measured / theory"});
    const StabilityRow* last = nullptr;
    for (const StabilityRow& row : map.rows()) {
        const bool same_column = last && last->method == row.method && last->stiffness == row.stiffness;
        last = &row;
        if (!same_column)
            table.row({row.method, row.stiffness, row.measured_limit, row.theory_limit,
                       row.measured_limit / row.theory_limit});
    }
    table.print();
}

}  // namespace

void Program::study(StudyQuestion question, std::function<void(Study&)> measure) {
    studies_.emplace_back(std::move(question), std::move(measure));
}
void Program::stability(StabilityQuestion question, std::function<void(StabilityMap&)> measure) {
    stability_maps_.emplace_back(std::move(question), std::move(measure));
}

bool Program::measures() const {
    return !study_.empty() || !stability_.empty();
}

void Program::list_studies() const {
    for (const auto& [question, measure] : studies_)
        std::printf("study %s: %s\n", question.name.c_str(), question.question.c_str());
    for (const auto& [question, measure] : stability_maps_)
        std::printf("stability %s: %s\n", question.name.c_str(), question.question.c_str());
    if (studies_.empty() && stability_maps_.empty()) std::fprintf(stderr, "this program has no studies\n");
}

void Program::check_measures() const {
    if (!study_.empty() && !stability_.empty()) throw BadInput("--study and --stability exclude each other");
    if (measures() && (options.window || options.explain))
        throw BadInput("--study and --stability measure only: no --window, no --explain");
    if (!study_.empty()) find_question(studies_, "study", study_);
    if (!stability_.empty()) find_question(stability_maps_, "stability map", stability_);
}

void Program::measure() {
    const auto save = [&](const auto& measured, const std::string& name) {
        print_rows(measured);
        write_file(options.out / (name + ".json"), measured.json());
        write_file(options.out / (name + ".csv"), measured.csv());
        if (!options.csv.empty()) write_file(options.csv, measured.csv());
    };
    if (!study_.empty()) {
        const auto& [question, measure] = find_question(studies_, "study", study_);
        Study study(question, chapter_, options.quick);
        measure(study);
        save(study, "study_" + study_);
    } else {
        const auto& [question, measure] = find_question(stability_maps_, "stability map", stability_);
        StabilityMap map(question, chapter_, options.quick);
        measure(map);
        save(map, "stability_" + stability_);
    }
}

}  // namespace course
