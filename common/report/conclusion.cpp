#include "common/report/conclusion.h"

#include <algorithm>
#include <cctype>
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

/// "a", "a and b", "a, b and c"; where a word has a comma itself: "a; b, float; c"
std::string listed(const std::vector<std::string>& words) {
    bool commas = false;
    for (const std::string& word : words) commas = commas || word.find(',') != std::string::npos;
    std::string text;
    for (std::size_t k = 0; k < words.size(); ++k)
        text += (k == 0 ? "" : commas ? "; " : k + 1 == words.size() ? " and " : ", ") + words[k];
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
    return " Smallest errors, beyond which more time makes it worse again: " + listed(found) + ".";
}

/// Slope of log(y) over log(x), by least squares; infinite if there is no spread in x.
double slope(const std::vector<Point>& points, double Point::*x_of, double Point::*y_of) {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (const Point& point : points) {
        if (!(point.*x_of > 0 && point.*y_of > 0)) continue;
        const double u = std::log(point.*x_of), v = std::log(point.*y_of);
        n += 1, x += u, y += v, xx += u * u, xy += u * v;
    }
    const double spread = n * xx - x * x;
    return spread > 1e-9 ? (n * xy - x * y) / spread : kInfinity;
}

std::string fixed(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f", value);
    return text;
}

/// Of a line that has no rival.
std::string alone_conclusion(const Line& line) {
    const std::vector<Point> points = best_points(line);
    if (points.empty()) return "No run had an error that could be measured.";
    const Point &first = points.front(), &last = points.back();
    if (points.size() == 1)
        return "An error of " + format_number(first.error) + " in " + format_number(first.seconds) +
               " s is its best.";
    const std::string law = last.seconds < 1.5 * first.seconds
                                ? "the error falls and the time hardly grows."
                                : "the error falls as the time to the power " +
                                      fixed(slope(points, &Point::seconds, &Point::error)) + ".";
    return "From an error of " + format_number(first.error) + " in " + format_number(first.seconds) +
           " s to " + format_number(last.error) + " in " + format_number(last.seconds) + " s: " + law +
           floors({line});
}

/// Of two methods: how many times as long the first takes as the second to get an error of at most 1 and 3 of
/// each decade. Only where one of them has a point above: beyond, both would stand with their fastest run.
std::string ratios(const Line& first, const Line& second, double worst, double best) {
    const auto has_above = [](const Line& line, double error) {
        const std::vector<Point> points = best_points(line);
        return !points.empty() && points.front().error >= error;
    };
    std::string text;
    for (int k = int(std::ceil(std::log10(worst))); k >= int(std::floor(std::log10(best))); --k)
        for (const int digit : {3, 1}) {
            const double error = digit * std::pow(10.0, k);
            const double ratio = seconds_for_error(first, error) / seconds_for_error(second, error);
            if (!(has_above(first, error) || has_above(second, error)) || !(ratio > 0 && ratio < kInfinity))
                continue;
            text += (text.empty() ? "" : ", ") + times(ratio) + " at " +
                    (digit == 1 ? power_of_ten(k) : format_number(error));
        }
    if (text.empty()) return "";
    return "Time of " + first.method + " / time of " + second.method + ", for at most that error: " + text +
           ". ";
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
    if (study.lines.size() < 2) return alone_conclusion(study.lines.front());

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
    std::string stretches;
    for (std::size_t k = 0; k < decades.size();) {
        std::size_t end = k;
        const std::string& winner = decades[k].ranked.front().method;
        while (end + 1 < decades.size() && decades[end + 1].ranked.front().method == winner) ++end;
        stretches += (k == 0 ? "" : "; ") + power_of_ten(decades[k].exponent) +
                     (end == k ? "" : " to " + power_of_ten(decades[end].exponent)) + ": " + winner;
        k = end + 1;
    }
    text += "The cheapest, by error: " + stretches + ". ";
    if (study.lines.size() == 2) text += ratios(study.lines[0], study.lines[1], worst, best);

    std::vector<std::string> alone;
    for (const Entry& entry : decades.back().ranked) alone.push_back(entry.method);
    if (alone.size() < study.lines.size())
        text += "Only " + listed(alone) + (alone.size() == 1 ? " gets" : " get") + " to " +
                power_of_ten(decades.back().exponent) + ".";
    return text + floors(study.lines);
}

/// At the largest value: the methods that no other one beats in both time and error, the fastest first.
std::string front_conclusion(const StudyData& study) {
    double largest = 0;
    for (const Line& line : study.lines)
        for (const Point& point : line.points) largest = std::max(largest, point.value);
    struct Candidate {
        std::string method;
        Point point;
    };
    std::vector<Candidate> all;
    for (const Line& line : study.lines)
        for (const Point& point : line.points)
            if (point.value == largest && std::isfinite(point.error)) all.push_back({line.method, point});
    std::sort(all.begin(), all.end(),
              [](const Candidate& a, const Candidate& b) { return a.point.seconds < b.point.seconds; });
    std::string front, beaten;
    double least_error = kInfinity;
    for (const Candidate& c : all) {
        const std::string numbers = c.method + " (" + format_number(c.point.seconds) + " s, error " +
                                    format_number(c.point.error) + ")";
        if (c.point.error < least_error) {
            front += (front.empty() ? "" : "; ") + numbers;
            least_error = c.point.error;
        } else {
            beaten += (beaten.empty() ? "" : "; ") + numbers;
        }
    }
    return "At " + study.parameter + " = " + format_number(largest) +
           ", each of these is the cheapest for its error: " + front + "." +
           (beaten.empty() ? "" : " Slower and no more exact than one of them: " + beaten + ".");
}

/// "sorted grid: build" and "sorted grid: query" are parts of one method: their times add up.
std::vector<Line> sums_of_parts(const std::vector<Line>& lines) {
    std::vector<Line> sums;
    for (const Line& line : lines) {
        const std::string method = line.method.substr(0, line.method.find(": "));
        const auto found =
            std::find_if(sums.begin(), sums.end(), [&](const Line& sum) { return sum.method == method; });
        if (found == sums.end()) {
            sums.push_back({method, line.points});
            continue;
        }
        for (Point& total : found->points)
            for (const Point& point : line.points)
                if (point.value == total.value) total.seconds += point.seconds;
    }
    return sums;
}

std::string cost_conclusion(const StudyData& study) {
    double largest = 0, worst_error = 0;
    std::vector<std::string> slopes;
    for (const Line& line : study.lines) {
        for (const Point& point : line.points) {
            largest = std::max(largest, point.value);
            worst_error = std::max(worst_error, point.error);
        }
        const double growth = slope(line.points, &Point::value, &Point::seconds);
        if (std::isfinite(growth)) slopes.push_back(fixed(growth) + " (" + line.method + ")");
    }
    const std::vector<Line> methods = sums_of_parts(study.lines);
    const auto ranked = ranking(methods, [&](const Line& line) {
        for (const Point& point : line.points)
            if (point.value == largest) return point.seconds;
        return kInfinity;
    });
    std::string text;
    if (ranked.size() > 1)
        text = "At " + study.parameter + " = " + format_number(largest) + ", " +
               compared(ranked, "fastest", "faster") +
               (methods.size() < study.lines.size() ? " (parts added up). " : ". ");
    if (!slopes.empty())
        text += "Time grows as " + study.parameter + " to the power " + listed(slopes) + ". ";
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
    const auto of = [](const StudyData& data) {
        if (data.values_are_problems) return front_conclusion(data);
        return data.error_against_time ? error_conclusion(data) : cost_conclusion(data);
    };
    if (!study.lines_are_cases) return of(study);
    // "dam break, linear": methods are compared within their case, and cases with nothing.
    std::vector<std::pair<std::string, StudyData>> cases;
    for (const Line& line : study.lines) {
        const std::size_t comma = line.method.find(", ");
        const std::string name = line.method.substr(0, comma);
        auto found =
            std::find_if(cases.begin(), cases.end(), [&](const auto& one) { return one.first == name; });
        if (found == cases.end()) {
            found = cases.insert(found, {name, study});
            found->second.lines.clear();
        }
        found->second.lines.push_back(
            {comma == std::string::npos ? name : line.method.substr(comma + 2), line.points});
    }
    std::string text;
    for (const auto& [name, data] : cases) {
        std::string part = of(data);
        while (!part.empty() && part.back() == ' ') part.pop_back();
        text += (text.empty() ? "" : "\n") + (char(std::toupper(name[0])) + name.substr(1)) + ": " + part;
    }
    return text;
}

std::string conclusion(const StabilityData& data) {
    std::vector<std::pair<std::string, std::vector<std::string>>> sentences;  // and the methods they hold for
    for (const MethodMap& map : data.maps) {
        std::string text;
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
        if (highest > 0) {
            char range[64];
            std::snprintf(range, sizeof range, highest - lowest < 0.005 ? "%.2f" : "%.2f to %.2f", lowest,
                          highest);
            text += "the measured limit is " + std::string(range) + " of the theory's";
            if (lowest < 0.985)
                text +=
                    ": at " + data.stiffness + " = " + format_number(at) + " the theory promises too much";
            text += ". ";
        }
        if (open > 0)
            text += "Nothing was unstable in " + std::to_string(open) + " of " +
                    std::to_string(map.columns.size()) + " columns, up to " + format_number(tried) +
                    " times the theory's limit. ";
        if (never > 0) text += "No step tried was stable in " + std::to_string(never) + " columns. ";
        const auto same = std::find_if(sentences.begin(), sentences.end(),
                                       [&](const auto& sentence) { return sentence.first == text; });
        if (same == sentences.end())
            sentences.push_back({text, {map.method}});
        else
            same->second.push_back(map.method);
    }
    std::string all;
    for (const auto& [text, methods] : sentences) all += listed(methods) + ": " + text;
    return all;
}

}  // namespace course::report
