// Timing, rows of studies and limits of stability: what every chapter's measurement stands on.
#include <cmath>
#include <stdexcept>

#include "common/study.h"
#include "tests/support/course_test.h"

namespace {

course::Timing seconds(double s) {
    return {s, s, s, 5};
}

course::StabilityMap a_map() {
    return {{"map", "Which?", "criterion", "theory", "k"}, "00_test", false};
}

}  // namespace

TEST_CASE("a timing is the median, between its quartiles") {
    const course::Timing t = course::timing_of({5, 1, 4, 2, 3});
    CHECK(t.median_s == 3);
    CHECK(t.low_s == 2);
    CHECK(t.high_s == 4);
    CHECK(t.repeats == 5);
    CHECK(t.per(2).median_s == 1.5);
    CHECK(course::timing_of({7}).median_s == 7);
}

TEST_CASE("work is timed as often as asked, and once before") {
    int calls = 0;
    CHECK(course::time_work(4, [&] { ++calls; }).repeats == 4);
    CHECK(calls == 5);
}

TEST_CASE("a study writes the documented columns") {
    course::Study study({"s", "Which?", "metres, against the formula", "dt_s"}, "00_test", true);
    study.device = "a processor, with a comma";
    study.add({"Euler", 0.1, 1000, 1e-3, seconds(2e-6), 10});
    CHECK(study.csv() ==
          "study,method,parameter,value,n,error,error_kind,seconds_per_step,backend,device,steps,seconds_low,"
          "seconds_high,repeats\n"
          "s,Euler,dt_s,0.1,1000,0.001,\"metres, against the formula\",2e-06,cpu,\"a processor, with a "
          "comma\",10,"
          "2e-06,2e-06,5\n");
    study.add({"Euler", 1, 1000, NAN, seconds(2e-6), 1});
    CHECK(study.csv().find(",nan,") != std::string::npos);
}

TEST_CASE("a row needs a time and an error that is not negative") {
    course::Study study({"s", "Which?", "m", "dt_s"}, "00_test", false);
    CHECK_THROWS_AS(study.add({"Euler", 0.1, 1, -1e-3, seconds(1), 1}), std::logic_error);
    CHECK_THROWS_AS(study.add({"Euler", 0.1, 1, 1e-3, {}, 1}), std::logic_error);
    CHECK(study.rows().empty());
}

TEST_CASE("a limit of stability is found between the steps tried") {
    course::StabilityMap map = a_map();
    const double limit = map.column("m", 4, 2, {0.5, 1, 1.5}, 10, [](double dt) { return dt < 2.345; });
    CHECK(std::abs(limit - 2.345) < 1e-3);  // the bracket 2 ... 3 halved ten times
    CHECK(map.rows().size() == 13);
    for (const course::StabilityRow& row : map.rows()) {
        CHECK(row.stable == (row.dt < 2.345));
        CHECK(row.measured_limit == limit);
        CHECK(row.theory_limit == 2);
    }
    CHECK(map.csv().rfind("stability,method,dt,stiffness,stable,measured_limit,theory_limit\nmap,m,1,4,1,",
                          0) == 0);
}

TEST_CASE("where all steps are stable there is no limit, where none is it is 0") {
    course::StabilityMap map = a_map();
    CHECK(std::isinf(map.column("m", 1, 1, {0.5, 1, 2}, 5, [](double) { return true; })));
    CHECK(map.column("m", 2, 1, {0.5, 1, 2}, 5, [](double) { return false; }) == 0);
    CHECK(map.rows().size() == 6);  // nothing to halve
}

TEST_CASE("an island of stability beyond the limit is not the limit") {
    course::StabilityMap map = a_map();
    const double limit =
        map.column("m", 1, 1, {0.5, 1, 2, 4}, 0, [](double dt) { return dt < 0.7 || dt == 2; });
    CHECK(limit == std::sqrt(0.5 * 1.0));
}
