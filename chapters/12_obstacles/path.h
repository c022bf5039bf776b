/// @file
/// How an obstacle moves: on a path written before the run, by a hand, or as the particles push it.
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace obstacles {

/// Where something is, how fast it moves, and how that changes. In double: a small step of a slow obstacle is
/// not to be lost.
struct Motion {
    glm::dvec3 position_m{0}, velocity_m_per_s{0}, acceleration_m_per_s2{0};
};

/// A part of a path, at constant acceleration.
struct Leg {
    double duration_s;
    glm::dvec3 acceleration_m_per_s2;
};

//! [path]
/// A path of legs. After the last one it goes on at the speed it has then, or begins again, from where it has
/// come to.
struct Path {
    glm::dvec3 start_m{0}, start_velocity_m_per_s{0};
    std::vector<Leg> legs;
    bool repeats = false;

    /// The two integrals of a constant acceleration, leg by leg: no time step, hence no error of one.
    Motion at(double time_s) const {
        Motion now{start_m, start_velocity_m_per_s, {}};
        double left_s = time_s;
        if (repeats && duration_s() > 0) {
            const double rounds = std::floor(time_s / duration_s());
            const Motion end = after_legs();
            now.position_m += rounds * (end.position_m - start_m);
            left_s -= rounds * duration_s();
        }
        for (const Leg& leg : legs) {
            const double in_leg_s = std::min(left_s, leg.duration_s);
            now = along(now, leg.acceleration_m_per_s2, in_leg_s);
            left_s -= in_leg_s;
            if (left_s <= 0) return now;
        }
        return along(now, glm::dvec3(0), left_s);
    }
    //! [path]

    double duration_s() const {
        double sum_s = 0;
        for (const Leg& leg : legs) sum_s += leg.duration_s;
        return sum_s;
    }

    //! [fastest]
    /// Within a leg the velocity is a straight line through velocity space, and no point of a line segment is
    /// farther from the origin than both its ends: the fastest moment is where two legs meet.
    double fastest_m_per_s() const {
        Motion now{start_m, start_velocity_m_per_s, {}};
        double fastest = glm::length(now.velocity_m_per_s);
        for (const Leg& leg : legs) {
            now = along(now, leg.acceleration_m_per_s2, leg.duration_s);
            fastest = std::max(fastest, glm::length(now.velocity_m_per_s));
        }
        return fastest;
    }
    //! [fastest]

    Motion after_legs() const {
        Motion now{start_m, start_velocity_m_per_s, {}};
        for (const Leg& leg : legs) now = along(now, leg.acceleration_m_per_s2, leg.duration_s);
        return now;
    }

  private:
    static Motion along(const Motion& from, glm::dvec3 a, double t) {
        return {from.position_m + t * from.velocity_m_per_s + 0.5 * t * t * a, from.velocity_m_per_s + t * a,
                a};
    }
};

}  // namespace obstacles
