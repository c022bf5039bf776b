// Every chapter's program answers the questions about its studies in the same way.
#include <sstream>
#include <vector>

#include "tests/support/course_test.h"
#include "tests/support/run_program.h"

namespace {

std::vector<std::string> all_programs() {
    std::istringstream names(COURSE_PROGRAMS);
    std::vector<std::string> programs;
    for (std::string name; names >> name;) programs.push_back(name);
    return programs;
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("every program names its studies: at least one, each with a question") {
    REQUIRE(all_programs().size() >= 5);
    for (const std::string& program : all_programs()) {
        CAPTURE(program);
        const course::ProgramRun run = course::run_program(program, "--list-studies");
        CHECK(run.exit_code == 0);
        CHECK(run.output.rfind("study ", 0) == 0);
        std::istringstream lines(run.output);
        for (std::string line; std::getline(lines, line);) {
            CAPTURE(line);
            CHECK((line.rfind("study ", 0) == 0 || line.rfind("stability ", 0) == 0));
            CHECK(line.back() == '?');
        }
    }
}

TEST_CASE("a study that does not exist is a clear error in every program") {
    course::TemporaryFolder folder;
    const std::string out = " --out '" + folder.path().string() + "'";
    for (const std::string& program : all_programs()) {
        CAPTURE(program);
        const course::ProgramRun study = course::run_program(program, "--study no_such" + out);
        CHECK(study.exit_code == 2);
        CHECK(contains(study.output, "there is no study 'no_such': choose one of "));
        const course::ProgramRun map = course::run_program(program, "--stability no_such" + out);
        CHECK(map.exit_code == 2);
        CHECK(contains(map.output, "there is no stability map 'no_such'"));
        CHECK(course::run_program(program, "--study a --stability b" + out).exit_code == 2);
        CHECK(course::run_program(program, "--study ''" + out).exit_code == 2);
    }
    CHECK(std::filesystem::is_empty(folder.path()));  // nothing half-written
}

TEST_CASE("a full disk behind standard output is an error") {
    const course::ProgramRun run = course::run_program(all_programs().front(), "--list-studies >/dev/full");
    CHECK(run.exit_code == 2);
}
