/// @file
/// The three questions of the experiment, answered from its records: where does one model overtake the
/// other, do particles crowd, and does the time follow the crowd?
#pragma once
#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "11_water_compared/analysis.h"
#include "11_water_compared/record.h"
#include "common/result.h"
#include "common/timing.h"

namespace compared {

inline std::vector<RunRecord> of_size(const std::vector<RunRecord>& records, Model model, int exponent) {
    std::vector<RunRecord> found;
    for (const RunRecord& r : records)
        if (r.plan.model == model && r.plan.exponent == exponent) found.push_back(r);
    return found;
}

/// Seconds per step of all repeats of a size: the median, and the quartiles.
inline course::Timing timing_of(const std::vector<RunRecord>& repeats) {
    std::vector<double> seconds;
    for (const RunRecord& r : repeats) seconds.push_back(r.seconds_per_step);
    return course::timing_of(std::move(seconds));
}

/// Sizes of which there is at least one run of each model, ascending.
inline std::vector<int> sizes_of(const std::vector<RunRecord>& records) {
    std::vector<int> sizes;
    for (const RunRecord& r : records)
        if (std::find(sizes.begin(), sizes.end(), r.plan.exponent) == sizes.end() &&
            !of_size(records, Model::sph, r.plan.exponent).empty() &&
            !of_size(records, Model::spring_mass, r.plan.exponent).empty())
            sizes.push_back(r.plan.exponent);
    std::sort(sizes.begin(), sizes.end());
    return sizes;
}

//! [answer_crossover]
/// Which model has the cheaper step, and where that changes.
inline std::string answer_crossover(const std::vector<RunRecord>& records) {
    std::vector<double> n, spring, sph;
    for (const int exponent : sizes_of(records)) {
        n.push_back(double(1u << exponent));
        spring.push_back(timing_of(of_size(records, Model::spring_mass, exponent)).median_s);
        sph.push_back(timing_of(of_size(records, Model::sph, exponent)).median_s);
    }
    if (n.empty()) return "No size was measured with both models.";
    const std::vector<double> places = crossings(n, spring, sph);
    const auto times = [&](std::size_t k) { return course::format_number(sph[k] / spring[k]); };
    if (places.empty()) {
        const bool spring_is_faster = spring[0] < sph[0];
        std::string text = "No crossover: a step of " +
                           name_of(spring_is_faster ? Model::spring_mass : Model::sph) +
                           " is cheaper at every size measured";
        text += " (SPH / spring-mass: " + times(0);
        if (n.size() > 1) text += " at the smallest, " + times(n.size() - 1) + " at the largest";
        return text + ").";
    }
    std::string text = "Crossover at";
    for (std::size_t k = 0; k < places.size(); ++k)
        text += (k ? " and" : "") + (" 2^" + course::format_number(std::log2(places[k])));
    return text + " particles; below the first, " +
           name_of(spring[0] < sph[0] ? Model::spring_mass : Model::sph) + " is cheaper.";
}
//! [answer_crossover]

//! [answer_crowding]
/// Do particles crowd as time goes on, and does the time of a step follow? Over the samples of all repeats of
/// one size.
inline std::string answer_crowding(const std::vector<RunRecord>& repeats) {
    if (repeats.empty() || repeats[0].samples.size() < 3) return "Too few samples to say.";
    const auto mean_of = [&](auto value, std::size_t first, std::size_t last) {
        double sum = 0;
        for (const RunRecord& r : repeats)
            for (std::size_t k = first; k < last; ++k) sum += value(r.samples[k]);
        return sum / double((last - first) * repeats.size());
    };
    const std::size_t count = repeats[0].samples.size(), tenth = std::max<std::size_t>(1, count / 10);
    const auto change = [&](auto value) {
        const double before = mean_of(value, 0, tenth), after = mean_of(value, count - tenth, count);
        return course::format_number(before) + " to " + course::format_number(after);
    };
    std::vector<double> partners, seconds;
    for (const RunRecord& r : repeats)
        for (const Sample& s : r.samples) {
            partners.push_back(s.mean_partners);
            seconds.push_back(s.seconds);
        }
    const LineFit fit = fit_line(partners, seconds);
    return name_of(repeats[0].plan.model) + ", 2^" + std::to_string(repeats[0].plan.exponent) +
           ": from the first tenth of the run to the last, neighbours within two spacings go from " +
           change([](const Sample& s) { return s.mean_neighbours; }) + ", the fullest cell from " +
           change([](const Sample& s) { return double(s.fullest_cell); }) +
           ", interactions per particle from " + change([](const Sample& s) { return s.mean_partners; }) +
           ", milliseconds per step from " + change([](const Sample& s) { return 1e3 * s.seconds; }) +
           "; interactions explain " + course::format_number(std::round(100 * fit.explained)) +
           " % of the variation of the time.";
}
//! [answer_crowding]

}  // namespace compared
