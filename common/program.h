/// @file
/// What every chapter program has in common: its options, its exit codes, its progress line.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/result.h"
#include "common/study.h"

namespace course {

/// The options all programs share. A chapter sets its defaults before Program::run.
struct ProgramOptions {
    std::uint32_t particles = 4096;  ///< 1 and up
    int steps = 100;                 ///< 0 and up
    float dt_s = 0;                  ///< time step in seconds; 0: the program picks it
    std::uint64_t seed = 1;
    std::string scene;               ///< one of the program's scenes
    std::filesystem::path out;       ///< folder for pictures and result.json; default out/NN_topic
    bool window = false;             ///< interactive, instead of pictures
    int width = 1280, height = 720;  ///< of pictures, in pixels
    std::filesystem::path csv;       ///< the first table goes there too, if given
    bool explain = false;            ///< print what the scene computes and what it leaves out, then stop
    bool quick = false;              ///< studies and stability maps with fewer and smaller points
};

/// One chapter's program: declare options, then `return program.run(argc, argv, body)` from main.
class Program {
  public:
    /// @param chapter  folder name, e.g. "05_spatial_grid"
    /// @param title    what it is called in the gallery
    /// @param sentence what it shows, in one sentence
    Program(std::string chapter, std::string title, std::string sentence);
    ~Program();

    ProgramOptions options;
    std::vector<std::string> scenes;  ///< allowed values of --scene; the first is the default

    // Options of this chapter alone. The variable's value is the default; `help` names the unit.
    void option(const std::string& name, float& value, const std::string& help);
    void option(const std::string& name, int& value, const std::string& help);
    void option(const std::string& name, std::string& value, const std::string& help);
    void flag(const std::string& name, bool& value, const std::string& help);

    /// A measurement of error against run time that `--study NAME` runs instead of the program.
    void study(StudyQuestion question, std::function<void(Study&)> measure);
    /// A map of stable time steps that `--stability NAME` runs instead of the program.
    void stability(StabilityQuestion question, std::function<void(StabilityMap&)> measure);

    /// Parses, checks, makes the output folder, calls `body`, and turns errors into a sentence and an exit
    /// code: 0 done, 1 unexpected error, 2 bad input, 3 unstable.
    int run(int argc, char** argv, const std::function<void()>& body);

    /// The result that belongs to this run; valid inside body. Saved when body returns or the run is
    /// Unstable.
    Result& result() { return *result_; }

  private:
    void parse(int argc, char** argv);
    void check() const;
    bool measures() const;  ///< is a study or a stability map asked for?
    void check_measures() const;
    void measure();
    void list_studies() const;

    struct Parser;
    std::string chapter_, title_, sentence_, command_;
    std::unique_ptr<Parser> parser_;
    std::unique_ptr<Result> result_;
    std::vector<std::pair<StudyQuestion, std::function<void(Study&)>>> studies_;
    std::vector<std::pair<StabilityQuestion, std::function<void(StabilityMap&)>>> stability_maps_;
    std::string study_, stability_;  ///< the one asked for, if any
    bool list_studies_ = false;
};

/// For programs that would fill the host's memory: asked first, the answer is a sentence, and nobody is
/// killed.
/// @throws BadInput if the machine has less than `bytes` of memory altogether
void require_memory(double bytes);

/// A line on standard error that tells how far a long computation is.
class Progress {
  public:
    Progress(std::string what, long total);
    ~Progress();
    void update(long done);  ///< cheap enough to call on each step

  private:
    std::string what_;
    long total_, shown_percent_ = -1;
    bool terminal_;
};

}  // namespace course
