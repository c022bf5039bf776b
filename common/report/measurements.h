/// @file
/// Studies and stability maps as the report reads them back from the JSON that the programs wrote.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace course::report {

/// One row of a study, with the time of the whole computation.
struct Point {
    double value, n, error;                     ///< error: infinite where the run was unstable
    double seconds, seconds_low, seconds_high;  ///< median and quartiles
};

/// The rows of one method, in the order they were measured.
struct Line {
    std::string method;
    std::vector<Point> points;
};

/// What every measurement says of itself.
struct Origin {
    std::string chapter, name, question, backend, device;
    bool quick = false;
};

struct StudyData {
    Origin origin;
    std::string error_kind, parameter;
    bool error_against_time = true;    ///< else time against the parameter
    bool lines_are_cases = false;      ///< "CASE, METHOD": only methods of the same case compete
    bool values_are_problems = false;  ///< methods are compared at equal value of the parameter
    std::vector<Line> lines;
};

/// One time step tried.
struct Cell {
    double dt;
    bool stable;
};

/// All time steps tried at one stiffness.
struct Column {
    double stiffness, measured_limit, theory_limit;  ///< measured: infinite if nothing was unstable
    std::vector<Cell> cells;                         ///< by ascending dt
};

struct MethodMap {
    std::string method;
    std::vector<Column> columns;  ///< by ascending stiffness
};

struct StabilityData {
    Origin origin;
    std::string criterion, theory, stiffness, dt;  ///< the last two: names of the axes
    std::vector<MethodMap> maps;
};

/// @throws std::exception if the file is not what Study::json or StabilityMap::json writes
StudyData load_study(const std::filesystem::path& file);
StabilityData load_stability(const std::filesystem::path& file);

}  // namespace course::report
