// Exercise 12.2: a spinning ball, against the laws that a bounce can't break.
#include "ex2_spin.cuh"

#include <cmath>
#include <random>
#include <vector>

#include "tests/support/course_test.h"

namespace {

using obstacles::SpinningBall;
using obstacles::Surface;

std::vector<float> numbers(glm::vec3 v) {
    return {v.x, v.y, v.z};
}

/// A ball that flies and turns, and a particle that comes at it.
struct Meeting {
    SpinningBall ball;
    float particle_kg = 0.2f;
    glm::vec3 x, v;

    explicit Meeting(int number, Surface surface) {
        std::mt19937 random(100 + number);
        std::uniform_real_distribution<float> part(-1, 1);
        const auto vector = [&] {
            const float a = part(random), b = part(random), c = part(random);
            return glm::vec3(a, b, c);
        };
        ball.middle_m = vector();
        ball.velocity_m_per_s = vector();
        ball.spin_rad_per_s = 5.0f * vector();
        ball.radius_m = 0.3f;
        ball.mass_kg = 0.7f;
        ball.surface = surface;
        const glm::vec3 normal = glm::normalize(vector());
        x = ball.middle_m + ball.radius_m * normal;
        v = ball.velocity_m_per_s - 4.0f * normal + vector();
    }
    glm::vec3 momentum() const { return particle_kg * v + ball.mass_kg * ball.velocity_m_per_s; }
    /// About the origin: of the particle, of the ball's flight, and of its spin.
    glm::vec3 angular_momentum() const {
        return particle_kg * glm::cross(x, v) +
               ball.mass_kg * glm::cross(ball.middle_m, ball.velocity_m_per_s) +
               0.4f * ball.mass_kg * ball.radius_m * ball.radius_m * ball.spin_rad_per_s;
    }
};

}  // namespace

TEST_CASE("the surface moves with the ball and with its spin") {
    course::set_hint(1);
    SpinningBall ball;
    ball.middle_m = {1, 2, 3};
    ball.velocity_m_per_s = {0.5f, 0, 0};
    ball.spin_rad_per_s = {0, 4, 0};
    // A turn about y moves what is on the z side towards +x, and what is on the x side towards -z.
    course::check_equal(numbers(surface_velocity(ball, {1, 2, 3.25f})), {1.5f, 0, 0}, "velocity", "axis");
    course::check_equal(numbers(surface_velocity(ball, {1.25f, 2, 3})), {0.5f, 0, -1}, "velocity", "axis");
    course::check_equal(numbers(surface_velocity(ball, {1, 2.25f, 3})), {0.5f, 0, 0}, "velocity", "axis");
}

TEST_CASE("momentum stays") {
    course::set_hint(2);
    std::vector<float> got, expected;
    for (int number = 0; number < 20; ++number) {
        Meeting meeting(number, {0.6f, 0.4f});
        const glm::vec3 before = meeting.momentum();
        obstacles::spinning_bounce(meeting.ball, meeting.particle_kg, meeting.x, meeting.v);
        for (float p : numbers(before)) expected.push_back(p);
        for (float p : numbers(meeting.momentum())) got.push_back(p);
    }
    course::check_close(got, expected, {2e-6}, "momentum", "component");  // fp32: roundings of 1 kg m/s
}

TEST_CASE("angular momentum stays") {
    course::set_hint(3);
    std::vector<float> got, expected;
    for (int number = 0; number < 20; ++number) {
        Meeting meeting(number, {0.6f, 0.4f});
        const glm::vec3 before = meeting.angular_momentum();
        obstacles::spinning_bounce(meeting.ball, meeting.particle_kg, meeting.x, meeting.v);
        for (float p : numbers(before)) expected.push_back(p);
        for (float p : numbers(meeting.angular_momentum())) got.push_back(p);
    }
    course::check_close(got, expected, {5e-6}, "angular momentum",
                        "component");  // fp32: as above, more terms
}

TEST_CASE("the particle leaves as fast as the restitution says, and sideways with a rough surface") {
    course::set_hint(2);
    // Head on, at a heavy ball that spins about y; the particle comes along -z.
    for (const float friction : {0.0f, 0.25f}) {
        SpinningBall ball;
        ball.mass_kg = 1e6f;
        ball.radius_m = 0.5f;
        ball.spin_rad_per_s = {0, 100, 0};
        ball.surface = {0.5f, friction};
        glm::vec3 v(0, 0, -4);
        obstacles::spinning_bounce(ball, 0.001f, {0, 0, 0.5f}, v);
        // Normal impulse 6 a kg; Coulomb gives up to a quarter of that sideways, and the surface moves at 50
        // m/s.
        course::check_close(numbers(v), {6 * friction, 0, 2}, {2e-6}, "velocity", "axis");
    }
}

TEST_CASE("without friction the spin stays; with it, a glancing hit starts one") {
    course::set_hint(3);
    for (const float friction : {0.0f, 0.5f}) {
        SpinningBall ball;
        ball.radius_m = 0.5f;
        ball.mass_kg = 3;
        ball.surface = {0, friction};
        glm::vec3 v(2, 0, -1);
        obstacles::spinning_bounce(ball, 1, {0, 0, 0.5f}, v);
        // Normal impulse 1 kg m/s * 3/4; friction's is half of that, along x, at the arm 0.5 m along z: about
        // y. I = 0.4 * 3 * 0.25 = 0.3 kg m^2.
        course::check_close(numbers(ball.spin_rad_per_s), {0, friction * 0.75f * 0.5f / 0.3f, 0}, {1e-6},
                            "spin", "axis");
    }
}
