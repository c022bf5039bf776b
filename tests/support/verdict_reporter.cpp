// The reporter of all the course's tests. Per failing case: its name, the first failure only (the ones after
// it are mostly its consequences), the seed, and the hint to ask for. The last line is always "verdict: ...":
// a program that ends without it (a crash, an early exit) has not been judged, whatever its exit code.
#include <doctest/doctest.h>

#include <cstdlib>
#include <iostream>
#include <sstream>
#include <string>

#include "tests/support/test_case_notes.h"

namespace course {

Tally& tally() {
    static Tally tally;
    return tally;
}

namespace {

std::string relative_to_course(const std::string& file) {
    const std::string root = COURSE_SOURCE_DIR "/";
    return file.compare(0, root.size(), root) == 0 ? file.substr(root.size()) : file;
}

std::string describe(const doctest::AssertData& check) {
    const std::string call = std::string(doctest::assertString(check.m_at)) + "( " + check.m_expr + " )";
    if ((check.m_at & doctest::assertType::is_normal) == 0) {
        return call + (check.m_threw ? " threw " + std::string(check.m_exception.c_str()) : " did not throw");
    }
    if (check.m_threw) return call + " threw " + check.m_exception.c_str();
    return call + " is wrong: " + check.m_decomp.c_str();
}

class VerdictReporter : public doctest::IReporter {
  public:
    explicit VerdictReporter(const doctest::ContextOptions& options)
        : options_(options), out_(*options.cout) {}

    void test_case_start(const doctest::TestCaseData& test_case) override {
        test_case_ = &test_case;
        first_failure_.clear();
        n_failures_ = 0;
        test_case_notes() = {};
    }

    void log_assert(const doctest::AssertData& check) override {
        if (check.m_failed) add_failure(check.m_file, check.m_line, describe(check));
    }

    void log_message(const doctest::MessageData& message) override {
        if (message.m_severity & doctest::assertType::is_warn) {
            out_ << "note: " << message.m_string << "\n";
        } else {
            add_failure(message.m_file, message.m_line, message.m_string.c_str());
        }
    }

    void test_case_exception(const doctest::TestCaseException& exception) override {
        if (test_case_notes().skip_reason) return;
        add_failure(test_case_->m_file.c_str(), static_cast<int>(test_case_->m_line),
                    std::string("ended by an exception: ") + exception.error_string.c_str());
    }

    void test_case_end(const doctest::CurrentTestCaseStats& stats) override {
        const bool skipped = test_case_notes().skip_reason && n_failures_ == 0;
        if (skipped) {
            ++tally().skipped;
            out_ << "skipped: " << test_case_->m_name << ": " << *test_case_notes().skip_reason << "\n";
            return;
        }
        if (stats.testCaseSuccess && stats.numAssertsCurrentTest == 0) {
            add_failure(test_case_->m_file.c_str(), static_cast<int>(test_case_->m_line),
                        "this case checks nothing");
        }
        if (stats.testCaseSuccess && n_failures_ == 0) {
            ++tally().passed;
            return;
        }
        ++tally().failed;
        print_failure();
    }

    void test_run_end(const doctest::TestRunStats&) override {
        const Tally& t = tally();
        const int n = t.passed + t.failed + t.skipped;
        if (n == 0) out_ << "no test case matches the filter\n";
        out_ << "verdict: " << n << (n == 1 ? " case, " : " cases, ") << t.passed << " passed, " << t.failed
             << " failed, " << t.skipped << " skipped" << std::endl;
    }

    void report_query(const doctest::QueryData& query) override {
        tally().listed_only = true;
        if (!options_.list_test_cases) return;
        for (unsigned i = 0; i < query.num_data; ++i) out_ << query.data[i]->m_name << "\n";
    }

    void test_run_start() override {}
    void test_case_reenter(const doctest::TestCaseData&) override {}
    void subcase_start(const doctest::SubcaseSignature&) override {}
    void subcase_end() override {}
    void test_case_skipped(const doctest::TestCaseData&) override {}

  private:
    void add_failure(const std::string& file, int line, const std::string& what) {
        if (++n_failures_ > 1) return;
        std::ostringstream text;
        text << what << "\n";
        for (int i = 0; i < get_num_active_contexts(); ++i) {  // INFO(...) and CAPTURE(...) of the test
            get_active_contexts()[i]->stringify(&text);
            text << "\n";
        }
        text << "checked at " << relative_to_course(file) << ":" << line;
        first_failure_ = text.str();
    }

    void print_failure() {
        const TestCaseNotes& notes = test_case_notes();
        out_ << "FAILED: " << test_case_->m_name << "\n";
        std::istringstream lines(first_failure_);
        for (std::string line; std::getline(lines, line);) out_ << "  " << line << "\n";
        if (n_failures_ > 1) out_ << "  and " << n_failures_ - 1 << " more failed checks in this case\n";
        if (notes.seed) out_ << "  seed " << *notes.seed << "\n";
        if (const char* exercise = std::getenv("COURSE_EXERCISE")) {  // set by ./course check
            out_ << "  hint: ./course hint " << exercise;
            if (notes.hint) out_ << " " << *notes.hint;
            out_ << "\n";
        }
    }

    const doctest::ContextOptions& options_;
    std::ostream& out_;
    const doctest::TestCaseData* test_case_ = nullptr;
    std::string first_failure_;
    int n_failures_ = 0;
};

REGISTER_REPORTER("verdict", 1, VerdictReporter);

}  // namespace
}  // namespace course
