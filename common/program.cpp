#include "common/program.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cmath>
#include <cstdio>

#include "common/errors.h"
#include "common/files.h"

namespace course {

struct Program::Parser {
    CLI::App app;
    long long particles = 0, steps = 0;  // read wide, so that an out-of-range number can be named
};

Program::Program(std::string chapter, std::string title, std::string sentence)
    : chapter_(std::move(chapter)),
      title_(std::move(title)),
      sentence_(std::move(sentence)),
      parser_(std::make_unique<Parser>()) {
    options.out = std::filesystem::path("out") / chapter_;
}
Program::~Program() = default;

void Program::option(const std::string& name, float& value, const std::string& help) {
    parser_->app.add_option(name, value, help)->capture_default_str();
}
void Program::option(const std::string& name, int& value, const std::string& help) {
    parser_->app.add_option(name, value, help)->capture_default_str();
}
void Program::option(const std::string& name, std::string& value, const std::string& help) {
    parser_->app.add_option(name, value, help)->capture_default_str();
}
void Program::flag(const std::string& name, bool& value, const std::string& help) {
    parser_->app.add_flag(name, value, help);
}

void Program::parse(int argc, char** argv) {
    CLI::App& app = parser_->app;
    app.description(title_ + ": " + sentence_);
    app.name(std::filesystem::path(argv[0]).filename().string());
    parser_->particles = options.particles;
    parser_->steps = options.steps;
    if (!scenes.empty() && options.scene.empty()) options.scene = scenes.front();
    app.add_option("--particles", parser_->particles, "number of particles")->capture_default_str();
    app.add_option("--steps", parser_->steps, "number of time steps")->capture_default_str();
    app.add_option("--dt", options.dt_s, "time step in seconds (0: chosen from the stability limit)")
        ->capture_default_str();
    app.add_option("--seed", options.seed, "seed of the random numbers")
        ->capture_default_str()
        ->check([](const std::string& text) {  // strtoull would turn -1 into 2^64 - 1
            const bool number = !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
            errno = 0;
            if (number) std::strtoull(text.c_str(), nullptr, 10);
            return number && errno == 0 ? std::string{}
                                        : "must be a whole number from 0 to 2^64 - 1, not " + text;
        });
    if (!scenes.empty()) {
        std::string names;
        for (const std::string& scene : scenes) names += (names.empty() ? "" : ", ") + scene;
        app.add_option("--scene", options.scene, "one of: " + names)->capture_default_str();
    }
    app.add_option("--out", options.out, "folder for pictures and results")->capture_default_str();
    app.add_flag("--window", options.window, "open a window instead of writing pictures");
    app.add_option("--width", options.width, "picture width in pixels")->capture_default_str();
    app.add_option("--height", options.height, "picture height in pixels")->capture_default_str();
    app.add_option("--csv", options.csv, "also write the first table to this file");
    app.add_flag("--explain", options.explain, "say what is computed and what is left out, then stop");
    const auto has_a_name = [](const std::string& text) {
        return text.empty() ? std::string("needs a name") : std::string{};
    };
    app.add_option("--study", study_, "measure error against run time instead: see --list-studies")
        ->check(has_a_name);
    app.add_option("--stability", stability_, "measure which time steps are stable instead")
        ->check(has_a_name);
    app.add_flag("--list-studies", list_studies_, "name the studies and the stability maps, then stop");
    app.add_flag("--quick", options.quick, "studies and stability maps with fewer and smaller points");
    app.parse(argc, argv);
    command_ = "ch" + chapter_;
    for (int k = 1; k < argc; ++k) command_ += std::string(" ") + argv[k];
}

void Program::check() const {
    const auto want = [](bool good, const std::string& sentence) {
        if (!good) throw BadInput(sentence);
    };
    want(parser_->particles >= 1 && parser_->particles <= 0x7fffffff,
         "--particles must be from 1 to 2147483647, not " + std::to_string(parser_->particles));
    want(parser_->steps >= 0 && parser_->steps <= 0x7fffffff,
         "--steps must be from 0 to 2147483647, not " + std::to_string(parser_->steps));
    want(std::isfinite(options.dt_s) && options.dt_s >= 0,
         "--dt must be a positive number of seconds (or 0 for the program's choice), not " +
             std::to_string(options.dt_s));
    want(options.width >= 16 && options.width <= 16384, "--width must be from 16 to 16384 pixels");
    want(options.height >= 16 && options.height <= 16384, "--height must be from 16 to 16384 pixels");
    bool known = scenes.empty();
    std::string names;
    for (const std::string& scene : scenes) {
        known = known || scene == options.scene;
        names += (names.empty() ? "" : ", ") + scene;
    }
    check_measures();
    want(known, "there is no scene '" + options.scene + "': choose one of " + names);
}

namespace {

/// A full disk must not pass for success. @throws BadInput
void finish_output() {
    if (std::fflush(stdout) != 0 || std::ferror(stdout))
        throw BadInput("standard output could not be written (is the disk full?)");
}

}  // namespace

int Program::run(int argc, char** argv, const std::function<void()>& body) {
    try {
        parse(argc, argv);
        check();
        if (list_studies_) {
            list_studies();
            finish_output();
            return 0;
        }
        options.particles = std::uint32_t(parser_->particles);
        options.steps = int(parser_->steps);
        if (!options.explain) {
            make_writable_folder(options.out);
            if (!options.csv.empty()) {
                const std::filesystem::path folder = options.csv.parent_path();
                make_writable_folder(folder.empty() ? "." : folder);
            }
        }
        result_ = std::make_unique<Result>(chapter_, title_, sentence_, options.out);
        if (measures()) {
            measure();
        } else {
            body();
            if (!options.explain && !options.window) result_->save(command_, options.csv);
        }
        finish_output();
        return 0;
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return parser_->app.exit(error);  // --help
        std::fprintf(stderr, "error: %s (--help lists the options)\n", error.what());
        return 2;
    } catch (const BadInput& error) {
        std::fprintf(stderr, "error: %s\n", error.what());
        return 2;
    } catch (const Unstable& error) {
        std::fprintf(stderr, "error: %s\n", error.what());
        try {
            if (!measures()) {
                result_->note(std::string("Stopped: ") + error.what());
                result_->save(command_, options.csv);
            }
        } catch (const std::exception& second) {
            std::fprintf(stderr, "error: %s\n", second.what());
        }
        return 3;
    } catch (const std::bad_alloc&) {
        std::fprintf(stderr, "error: this machine has not the memory for %u particles\n", options.particles);
        return 2;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "error: %s\n", error.what());
        return 1;
    }
}

void require_memory(double bytes) {
    const double here = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
    if (bytes > here)
        throw BadInput("this needs " + format_number(bytes / (1 << 30)) +
                       " GiB of memory, and the machine has " + format_number(here / (1 << 30)) +
                       " GiB: ask for fewer particles");
}

Progress::Progress(std::string what, long total)
    : what_(std::move(what)), total_(total > 0 ? total : 1), terminal_(isatty(2)) {}

Progress::~Progress() {
    if (terminal_ && shown_percent_ >= 0) std::fprintf(stderr, "\r\033[K");
}

void Progress::update(long done) {
    const long percent = 100 * done / total_;
    // A log file gets a line each quarter, a terminal a line that changes.
    if (percent == shown_percent_ ||
        (!terminal_ && percent / 25 == shown_percent_ / 25 && shown_percent_ >= 0))
        return;
    shown_percent_ = percent;
    std::fprintf(stderr, terminal_ ? "\r%s: %ld %%" : "%s: %ld %%\n", what_.c_str(), percent);
}

}  // namespace course
