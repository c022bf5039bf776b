// Exercise 01.2: who is left, against a filter written with a second array.
#include "ex2_remove_landed.h"

#include <algorithm>
#include <random>

#include "tests/support/course_test.h"

using namespace particle_loop;

namespace {

/// Droplet number k, recognisable by each of its numbers but its height.
Particle droplet(int k, float y_m) {
    const float id = float(k);
    return {{id, y_m, 1000 + id}, {2000 + id, 3000 + id, 4000 + id}};
}

/// Droplets at these heights, the first `count` of them alive: who is left, and are all their numbers theirs?
void check_removal(const std::vector<float>& heights_m, int count) {
    const int n = int(heights_m.size());
    ParticleArrays particles(n);
    for (int k = 0; k < n; ++k) particles.store(k, droplet(k, heights_m[k]));
    std::vector<int> expected;  // numbers of the droplets that stay
    for (int k = 0; k < count; ++k)
        if (!(heights_m[k] < 0)) expected.push_back(k);

    const int left = remove_landed(particles, count);
    CHECK_MESSAGE(left == int(expected.size()),
                  "of " << count << " droplets, " << left << " are left, expected " << expected.size());
    if (left < 0 || left > n) return;

    std::vector<int> got;
    std::vector<float> numbers, own_numbers;
    for (int i = 0; i < left; ++i) {
        const Particle p = particles.load(i);
        got.push_back(int(p.position_m.x));
        const int k = std::clamp(int(p.position_m.x), 0, n - 1);
        const Particle own = droplet(k, heights_m[k]);
        for (const Particle* q : {&p, &own})
            for (const float number : {q->position_m.x, q->position_m.y, q->position_m.z,
                                       q->velocity_m_per_s.x, q->velocity_m_per_s.y, q->velocity_m_per_s.z})
                (q == &p ? numbers : own_numbers).push_back(number);
    }
    std::sort(got.begin(), got.end());
    course::check_equal(got, expected, "number of the droplet", "remaining droplet");
    course::check_equal(numbers, own_numbers, "x y z vx vy vz", "number");
    for (int k = count; k < n; ++k)
        CHECK_MESSAGE(particles.load(k).velocity_m_per_s.z == 4000 + k,
                      "droplet " << k << " behind count was changed");
}

}  // namespace

TEST_CASE("some below, some not") {
    course::set_hint(1);
    check_removal({1, -1, 2, 3, -1, 4}, 6);
    check_removal({-1, 2}, 2);
}

TEST_CASE("several below in a row, also at the end") {
    course::set_hint(2);
    check_removal({1, -1, -1, 2, 3, -1, -1}, 7);
    check_removal({-1, -1, -1}, 3);
    check_removal({1, 2, -1}, 3);
}

TEST_CASE("exactly on the floor, none at all, nobody below") {
    course::set_hint(3);
    check_removal({0, -0.0f, -1e-30f, 1}, 4);
    check_removal({}, 0);
    check_removal({1, 2, 3}, 3);
}

TEST_CASE("fewer alive than the arrays hold") {
    course::set_hint(3);
    check_removal({1, -1, 2, 5, -5, 6}, 3);
    check_removal({-1, -1, 2, 5}, 0);
}

TEST_CASE("10000 droplets, half of them below") {
    course::set_seed(12);
    std::mt19937 random(12);
    std::uniform_real_distribution<float> height(-1, 1);
    std::vector<float> heights_m(10000);
    for (float& y : heights_m) y = height(random);
    check_removal(heights_m, 9000);
}
