// Exercise 09.1: the clipped contact, against the closed form of its bounce and against the lesson's force
// where nothing is clipped.
#include "ex1_never_pulls.cuh"

#include <cmath>
#include <random>
#include <vector>

#include "tests/support/course_test.h"

namespace {

using glm::dvec3;
using spring_mass::MaterialOf;

MaterialOf<double> material_of(double normal_damping, double tangential_damping, double friction) {
    MaterialOf<double> material;
    material.diameter_m = 0.01;
    material.mass_kg = 1;
    material.stiffness_N_per_m = 2000;
    material.normal_damping_per_s = normal_damping;
    material.tangential_damping_per_s = tangential_damping;
    material.friction = friction;
    return material;
}

/// Restitution of two bodies of reduced mass 1 and omega = 1 that meet with speed 1, in small steps.
double bounce(double zeta) {
    MaterialOf<double> material = material_of(2 * zeta, 0, 0);
    material.stiffness_N_per_m = 1;
    const double dt = 1e-3;
    double overlap = 0, approach = -1;  // overlap grows as they approach
    for (int step = 0; step < 8000; ++step) {
        overlap -= dt * approach;
        if (overlap < 0) break;
        approach += dt * spring_mass::clipped_contact_force(material, dvec3(0, 1, 0), overlap,
                                                            dvec3(0, approach, 0), 1.0)
                             .y;
    }
    return approach;
}

struct Row {
    double zeta, restitution;
};
// Reference (tests/data/README.md, 3_contact single_collision): e_clipped.
const Row kRows[] = {{0.05, 0.8587581017750918}, {0.1, 0.7440793977217797},       {0.2, 0.5717400275847768},
                     {0.5, 0.2984360591922749},  {0.2154537, 0.5502832533560879}, {0.9, 0.15528274750168164}};

}  // namespace

TEST_CASE("a bounce of the clipped contact has the restitution of its closed form") {
    course::set_hint(1);
    std::vector<double> got, expected;
    for (const Row& row : kRows) {
        got.push_back(bounce(row.zeta));
        expected.push_back(row.restitution);
    }
    // First order in dt = 1e-3: the force is cut off somewhere within a step.
    course::check_close(got, expected, {3e-3}, "restitution", "damping ratio");
}

TEST_CASE("where the lesson's force pushes, nothing changes; where it pulls, nothing is left") {
    course::set_seed(9);
    course::set_hint(2);
    std::mt19937 random(9);
    std::uniform_real_distribution<double> unit(-1, 1);
    const MaterialOf<double> material = material_of(40, 20, 0.3);
    std::vector<dvec3> got, expected;
    int pulls = 0;
    for (int k = 0; k < 200; ++k) {
        const dvec3 normal = glm::normalize(dvec3(unit(random), unit(random), unit(random) + 1.5));
        const dvec3 velocity(unit(random), unit(random), unit(random));
        const double overlap = 0.01 * std::abs(unit(random)), mass = k % 2 ? 0.5 : 1;
        const dvec3 lesson = spring_mass::contact_force<true>(material, normal, overlap, velocity, mass);
        const double push = 2000 * overlap - mass * 40 * glm::dot(velocity, normal);
        pulls += push < 0;
        got.push_back(spring_mass::clipped_contact_force(material, normal, overlap, velocity, mass));
        expected.push_back(push > 0 ? lesson : dvec3(0));
    }
    REQUIRE(pulls > 20);
    course::check_close(got, expected, {1e-12}, "force (N)", "contact");  // the same few operations in double
}

TEST_CASE("marbles that do not slide are not braked, and nothing is divided by zero") {
    course::set_hint(2);
    const MaterialOf<double> material = material_of(10, 20, 0.3);
    std::vector<dvec3> got;
    for (const dvec3 velocity : {dvec3(0, 0, 0), dvec3(0, -1, 0)})
        got.push_back(spring_mass::clipped_contact_force(material, dvec3(0, 1, 0), 0.002, velocity, 0.5));
    course::check_close(got, {dvec3(0, 4, 0), dvec3(0, 9, 0)}, {1e-12}, "force (N)", "contact");
}

TEST_CASE("the damping for a wanted restitution") {
    course::set_hint(3);
    std::vector<double> got, expected;
    for (const Row& row : kRows) {
        got.push_back(spring_mass::clipped_damping_ratio(row.restitution));
        expected.push_back(row.zeta);
    }
    got.push_back(spring_mass::clipped_damping_ratio(1));
    expected.push_back(0);
    course::check_close(got, expected, {1e-6}, "damping ratio", "restitution");
}
