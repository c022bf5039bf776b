#include "common/report/conclusion.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "common/result.h"

namespace course::report {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kAsFast = 1.15;  // times closer than this are called equal: noise is about as large

std::string power_of_ten(int exponent) {
    return exponent == 0 ? "1" : "1e" + std::to_string(exponent);
}

/// "a", "a and b", "a, b and c"
std::string listed(const std::vector<std::string>& words) {
    std::string text;
    for (std::size_t k = 0; k < words.size(); ++k)
        text += (k == 0 ? "" : k + 1 == words.size() ? " and " : ", ") + words[k];
    return text;
}

std::string times(double ratio) {
    char text[32];
    std::snprintf(text, sizeof text, ratio < 10 ? "%.1f" : "%.0f", ratio);
    return text;
}

/// Steps of a staircase: for each point that has the smallest error so far, its time, from fast to slow.
std::vector<Point> best_points(const Line& line) {
    std::vector<Point> points;
    for (const Point& point : line.points)
        if (std::isfinite(point.error)) points.push_back(point);
    std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) {
        return a.seconds != b.seconds ? a.seconds < b.seconds : a.error < b.error;
    });
    std::vector<Point> best;
    for (const Point& point : points)
        if (best.empty() || point.error < best.back().error) best.push_back(point);
    return best;
}

double smallest_error(const Line& line) {
    const std::vector<Point> best = best_points(line);
    return best.empty() ? kInfinity : best.back().error;
}

struct Entry {
    std::string method;
    double seconds;
};

/// The methods that have a time, the fastest first.
std::vector<Entry> ranking(const std::vector<Line>& lines,
                           const std::function<double(const Line&)>& seconds) {
    std::vector<Entry> entries;
    for (const Line& line : lines)
        if (const double time = seconds(line); std::isfinite(time)) entries.push_back({line.method, time});
    std::stable_sort(entries.begin(), entries.end(),
                     [](const Entry& a, const Entry& b) { return a.seconds < b.seconds; });
    return entries;
}

/// "leapfrog is the cheapest, 2.1 times cheaper than RK4 and 9.0 times than Euler"
std::string compared(const std::vector<Entry>& ranked, const std::string& superlative,
                     const std::string& comparative) {
    std::string text = ranked.front().method;
    const Entry& second = ranked[1];
    const double ratio = second.seconds / ranked.front().seconds;
    text += ratio < kAsFast ? " and " + second.method + " are the " + superlative + " and about equal"
                            : " is the " + superlative + ", " + times(ratio) + " times " + comparative +
                                  " than " + second.method;
    if (ranked.size() > 2)
        text += "; " + ranked.back().method + " takes " +
                times(ranked.back().seconds / ranked.front().seconds) + " times as long";
    return text;
}

/// One sentence per method whose error has a floor: with more time it gets worse again.
std::string floors(const std::vector<Line>& lines) {
    std::vector<std::string> found;
    for (const Line& line : lines) {
        const double best = smallest_error(line);
        const auto slowest =
            std::max_element(line.points.begin(), line.points.end(),
                             [](const Point& a, const Point& b) { return a.seconds < b.seconds; });
        if (slowest->error > 2 * best && std::isfinite(best))
            found.push_back(line.method + " (" + format_number(best) + ")");
    }
    if (found.empty()) return "";
    return " More time makes the error worse again, beyond its best, for " + listed(found) + ".";
}

std::string error_conclusion(const StudyData& study) {
    double best = kInfinity, worst = 0;
    for (const Line& line : study.lines)
        for (const Point& point : line.points)
            if (std::isfinite(point.error) && point.error > 0) {
                best = std::min(best, point.error);
                worst = std::max(worst, point.error);
            }
    if (!std::isfinite(best)) return "No run had an error that could be measured.";

    struct Decade {
        int exponent;
        std::vector<Entry> ranked;
    };
    std::vector<Decade> decades;  // from coarse to fine
    for (int k = int(std::ceil(std::log10(worst))); k >= int(std::ceil(std::log10(best) - 1e-9)); --k) {
        const auto ranked = ranking(
            study.lines, [&](const Line& line) { return seconds_for_error(line, std::pow(10.0, k)); });
        if (!ranked.empty()) decades.push_back({k, ranked});
    }
    if (study.lines.size() < 2 || decades.empty()) {
        const Line& line = study.lines.front();
        const std::vector<Point> points = best_points(line);
        return line.method + ": from an error of " + format_number(points.front().error) + " in " +
               format_number(points.front().seconds) + " s to " + format_number(points.back().error) +
               " in " + format_number(points.back().seconds) + " s." + floors(study.lines);
    }

    // The error that says most: the finest that the most methods reach, at least two of them.
    const Decade* main = nullptr;
    for (const Decade& decade : decades)
        if (decade.ranked.size() >= 2 && (!main || decade.ranked.size() >= main->ranked.size()))
            main = &decade;
    std::string text;
    if (main)
        text = "For an error of " + power_of_ten(main->exponent) + ", " +
               compared(main->ranked, "cheapest", "cheaper") + ". ";

    // Who wins where, as stretches of decades with one winner.
    std::vector<std::string> stretches;
    for (std::size_t k = 0; k < decades.size();) {
        std::size_t end = k;
        const std::string& winner = decades[k].ranked.front().method;
        while (end + 1 < decades.size() && decades[end + 1].ranked.front().method == winner) ++end;
        stretches.push_back(winner + (end == k ? " at " + power_of_ten(decades[k].exponent)
                                               : " from " + power_of_ten(decades[k].exponent) + " to " +
                                                     power_of_ten(decades[end].exponent)));
        k = end + 1;
    }
    if (stretches.size() > 1)
        text += "The cheapest by error: " + listed(stretches) + ". ";
    else
        text += decades.front().ranked.front().method + " is the cheapest at every error from " +
                power_of_ten(decades.front().exponent) + " to " + power_of_ten(decades.back().exponent) +
                ". ";

    std::vector<std::string> alone;
    for (const Entry& entry : decades.back().ranked) alone.push_back(entry.method);
    if (alone.size() < study.lines.size())
        text += "Only " + listed(alone) + (alone.size() == 1 ? " gets" : " get") + " to " +
                power_of_ten(decades.back().exponent) + ".";
    return text + floors(study.lines);
}

/// Slope of log(seconds) over log(value), by least squares.
double growth(const Line& line) {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (const Point& point : line.points) {
        if (!(point.value > 0)) continue;
        const double u = std::log(point.value), v = std::log(point.seconds);
        n += 1, x += u, y += v, xx += u * u, xy += u * v;
    }
    const double spread = n * xx - x * x;
    return spread > 0 ? (n * xy - x * y) / spread : kInfinity;
}

std::string cost_conclusion(const StudyData& study) {
    double largest = 0, worst_error = 0;
    std::vector<std::string> slopes;
    for (const Line& line : study.lines) {
        for (const Point& point : line.points) {
            largest = std::max(largest, point.value);
            worst_error = std::max(worst_error, point.error);
        }
        char text[32];
        std::snprintf(text, sizeof text, "%.2f", growth(line));
        if (std::isfinite(growth(line))) slopes.push_back(text + (" for " + line.method));
    }
    const auto ranked = ranking(study.lines, [&](const Line& line) {
        for (const Point& point : line.points)
            if (point.value == largest) return point.seconds;
        return kInfinity;
    });
    std::string text;
    if (ranked.size() > 1)
        text = "At " + study.parameter + " = " + format_number(largest) + ", " +
               compared(ranked, "fastest", "faster") + ". ";
    if (!slopes.empty()) text += "Time grows as a power of " + study.parameter + ": " + listed(slopes) + ". ";
    return text + "Largest error: " + format_number(worst_error) + ".";
}

}  // namespace

double seconds_for_error(const Line& line, double error) {
    const std::vector<Point> best = best_points(line);
    for (std::size_t k = 0; k < best.size(); ++k) {
        if (best[k].error > error) continue;
        if (k == 0 || best[k].error <= 0) return best[k].seconds;
        const double step = std::log(best[k - 1].error / error) / std::log(best[k - 1].error / best[k].error);
        return best[k - 1].seconds * std::pow(best[k].seconds / best[k - 1].seconds, step);
    }
    return kInfinity;
}

std::string conclusion(const StudyData& study) {
    return study.error_against_time ? error_conclusion(study) : cost_conclusion(study);
}

std::string conclusion(const StabilityData& data) {
    std::string text;
    for (const MethodMap& map : data.maps) {
        double lowest = kInfinity, highest = 0, at = 0, tried = 0;
        int open = 0, never = 0;
        for (const Column& column : map.columns) {
            if (std::isinf(column.measured_limit)) {
                ++open;
                tried = std::max(tried, column.cells.back().dt / column.theory_limit);
                continue;
            }
            if (column.measured_limit == 0) {
                ++never;
                continue;
            }
            const double ratio = column.measured_limit / column.theory_limit;
            if (ratio < lowest) at = column.stiffness;
            lowest = std::min(lowest, ratio);
            highest = std::max(highest, ratio);
        }
        text += map.method + ": ";
        if (highest > 0) {
            char range[64];
            std::snprintf(range, sizeof range, highest - lowest < 0.005 ? "%.2f" : "%.2f to %.2f", lowest,
                          highest);
            text += "the measured limit is " + std::string(range) + " of the theory's";
            if (lowest < 0.985) text += ": at " + format_number(at) + " the theory promises too much";
            text += ". ";
        }
        if (open > 0)
            text += "Nothing was unstable in " + std::to_string(open) + " of " +
                    std::to_string(map.columns.size()) + " columns, up to " + format_number(tried) +
                    " times the theory's limit. ";
        if (never > 0) text += "No step tried was stable in " + std::to_string(never) + " columns. ";
    }
    return text;
}

}  // namespace course::report
