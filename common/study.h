/// @file
/// Error against run time, and limits of stability, measured by a program and written as rows that can be
/// plotted. Program::study and Program::stability declare them; `--study NAME` and `--stability NAME` run
/// them.
#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/timing.h"

namespace course {

class Progress;

/// What is drawn of a study. Both axes are logarithmic, and each method is a line.
enum class StudyPlot {
    error_against_time,  ///< where methods differ in error
    time_against_value,  ///< where all are exact, and the question is what the parameter costs
};

/// What a study asks, before it has an answer.
struct StudyQuestion {
    std::string name;        ///< of --study: lower case and underscores
    std::string question;    ///< one sentence, with a question mark
    std::string error_kind;  ///< what `error` means, against which answer, and in what unit
    std::string parameter;   ///< what is varied within a method: "dt_s", "support_in_spacings", "n"
    StudyPlot plot = StudyPlot::error_against_time;
    /// Method names are "CASE, METHOD", or only "CASE": cases are different problems, and a conclusion that
    /// one of them is cheaper would mean nothing. Only methods within a case are compared.
    bool lines_are_cases = false;
    /// Each value of the parameter is another problem (a size, a distance), not more effort for the same one:
    /// methods are compared at equal value.
    bool values_are_problems = false;
};

/// One measured point of a study.
struct StudyRow {
    std::string method;  ///< its line in the plot
    double value = 0;    ///< of the parameter
    double n = 1;        ///< particles, or elements
    double error = 0;    ///< at least 0; not finite where the run was unstable
    Timing per_step;     ///< of one step
    double steps = 1;    ///< that this point took: steps x per_step is its run time
};

/// The rows of one study, gathered while it runs.
class Study {
  public:
    Study(StudyQuestion question, std::string chapter, bool quick);
    ~Study();

    const StudyQuestion question;
    const bool quick;             ///< asked for fewer and smaller points: a look, not a measurement
    std::string backend = "cpu";  ///< or "simulator", "cuda" (on_device() in gpu_timer.h), "opengl"
    std::string device;           ///< the processor's name, until a chapter says otherwise

    /// So many rows will come: from now on, each one moves the progress line.
    void expect(int rows);
    /// @throws std::logic_error if the error is negative or nothing was timed
    void add(const StudyRow& row);
    const std::vector<StudyRow>& rows() const { return rows_; }

    /// The columns that docs and plots rely on: study,method,parameter,value,n,error,error_kind,
    /// seconds_per_step,backend,device; then steps,seconds_low,seconds_high,repeats (quartiles per step).
    std::string csv() const;
    /// The same and what the question was, for the report.
    std::string json() const;

  private:
    std::string chapter_;
    std::vector<StudyRow> rows_;
    std::unique_ptr<Progress> progress_;
    int expected_ = 0;
};

/// What a stability map asks.
struct StabilityQuestion {
    std::string name;           ///< of --stability
    std::string question;       ///< one sentence, with a question mark
    std::string criterion;      ///< when a run counts as stable
    std::string theory;         ///< where the theory's limit comes from
    std::string stiffness;      ///< what the column `stiffness` is, with its unit: "sound speed c (m/s)"
    std::string dt = "dt (s)";  ///< what the column `dt` is, with its unit
};

/// One run of a stability map, with the limits at its stiffness.
struct StabilityRow {
    std::string method;
    double dt = 0, stiffness = 0;
    bool stable = false;
    double measured_limit = 0;  ///< between the largest stable and the smallest unstable dt
    double theory_limit = 0;
};

/// Stable and unstable time steps of some methods over a range of stiffness.
class StabilityMap {
  public:
    StabilityMap(StabilityQuestion question, std::string chapter, bool quick);
    ~StabilityMap();

    const StabilityQuestion question;
    const bool quick;
    std::string backend = "cpu", device;

    void expect(int columns);  ///< so many columns will come
    /// Tries the time steps theory_limit x each of `factors`, then halves the interval between the largest
    /// stable one below the first unstable one `bisections` times; every run becomes a row.
    /// @param factors ascending; @param stable tells whether a run with this dt stays stable
    /// @returns the measured limit: infinite if every dt was stable, 0 if none was
    double column(const std::string& method, double stiffness, double theory_limit,
                  const std::vector<double>& factors, int bisections,
                  const std::function<bool(double dt)>& stable);
    const std::vector<StabilityRow>& rows() const { return rows_; }

    /// stability,method,dt,stiffness,stable,measured_limit,theory_limit
    std::string csv() const;
    std::string json() const;

  private:
    std::string chapter_;
    std::vector<StabilityRow> rows_;
    std::unique_ptr<Progress> progress_;
    int expected_ = 0, columns_ = 0;
};

}  // namespace course
