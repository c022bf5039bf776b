#include "common/report/measurements.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace course::report {

namespace {

nlohmann::json parse(const std::filesystem::path& file, const std::string& kind) {
    std::ifstream stream(file);
    nlohmann::json json = nlohmann::json::parse(stream);
    if (json.at("kind") != kind) throw std::runtime_error("this is no " + kind);
    if (json.at("rows").empty()) throw std::runtime_error("it has no rows");
    return json;
}

Origin origin_of(const nlohmann::json& json) {
    return {json.at("chapter"), json.at("name"),   json.at("question"),
            json.at("backend"), json.at("device"), json.at("quick")};
}

/// JSON has no infinity; the programs write null for it.
double number(const nlohmann::json& value) {
    return value.is_null() ? std::numeric_limits<double>::infinity() : value.get<double>();
}

/// The element that `matches`, or a new one made by `make`.
template <class T, class Matches, class Make>
T& find_or_add(std::vector<T>& list, Matches&& matches, Make&& make) {
    const auto found = std::find_if(list.begin(), list.end(), matches);
    if (found != list.end()) return *found;
    list.push_back(make());
    return list.back();
}

}  // namespace

StudyData load_study(const std::filesystem::path& file) {
    const nlohmann::json json = parse(file, "study");
    StudyData study{origin_of(json),
                    json.at("error_kind"),
                    json.at("parameter"),
                    json.at("plot") == "error_against_time",
                    json.at("lines_are_cases"),
                    json.at("values_are_problems"),
                    {}};
    for (const auto& row : json.at("rows")) {
        const std::string method = row.at("method");
        Line& line = find_or_add(
            study.lines, [&](const Line& other) { return other.method == method; },
            [&] {
                return Line{method, {}};
            });
        const double steps = row.at("steps");
        line.points.push_back({number(row.at("value")), number(row.at("n")), number(row.at("error")),
                               steps * row.at("seconds_per_step").get<double>(),
                               steps * row.at("seconds_low").get<double>(),
                               steps * row.at("seconds_high").get<double>()});
    }
    return study;
}

StabilityData load_stability(const std::filesystem::path& file) {
    const nlohmann::json json = parse(file, "stability");
    StabilityData data{origin_of(json),      json.at("criterion"), json.at("theory"),
                       json.at("stiffness"), json.at("dt"),        {}};
    for (const auto& row : json.at("rows")) {
        const std::string method = row.at("method");
        const double stiffness = number(row.at("stiffness"));
        MethodMap& map = find_or_add(
            data.maps, [&](const MethodMap& other) { return other.method == method; },
            [&] {
                return MethodMap{method, {}};
            });
        Column& column = find_or_add(
            map.columns, [&](const Column& other) { return other.stiffness == stiffness; },
            [&] {
                return Column{
                    stiffness, number(row.at("measured_limit")), number(row.at("theory_limit")), {}};
            });
        column.cells.push_back({row.at("dt"), row.at("stable")});
    }
    for (MethodMap& map : data.maps) {
        std::sort(map.columns.begin(), map.columns.end(),
                  [](const Column& a, const Column& b) { return a.stiffness < b.stiffness; });
        for (Column& column : map.columns)
            std::sort(column.cells.begin(), column.cells.end(),
                      [](const Cell& a, const Cell& b) { return a.dt < b.dt; });
    }
    return data;
}

}  // namespace course::report
