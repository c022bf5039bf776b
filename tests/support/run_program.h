/// \file
/// Runs one of the course's programs as a user would, for tests of its exit code and of its last words.
#pragma once

#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>

namespace course {

struct ProgramRun {
    int exit_code = -1;  ///< -1: it did not start, or a signal ended it
    std::string output;  ///< standard output and standard error
};

/// \param program its name, as `ch01_particle_loop`
/// \param arguments as typed in a shell
/// \param environment variables for it alone, as `CUDASIM_THREADS=1`
inline ProgramRun run_program(const std::string& program, const std::string& arguments,
                              const std::string& environment = "") {
    ProgramRun run;
    const std::string command =
        environment + " '" + COURSE_BIN_DIR + "/" + program + "' " + arguments + " 2>&1";
    FILE* pipe = popen(command.c_str(), "r");
    if (!pipe) return run;
    for (char text[256]; std::fgets(text, sizeof text, pipe);) run.output += text;
    const int status = pclose(pipe);
    if (WIFEXITED(status)) run.exit_code = WEXITSTATUS(status);
    return run;
}

/// A folder of its own for one test, gone with it.
class TemporaryFolder {
  public:
    TemporaryFolder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "course_test_XXXXXX").string();
        if (!mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder: " + pattern);
        path_ = pattern;
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

}  // namespace course
