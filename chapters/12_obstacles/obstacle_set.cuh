/// @file
/// The obstacles of a scene: where they are, what they do to particles in a step, and what that does to them.
#pragma once
#include <cstdio>
#include <string>
#include <vector>

#include "12_obstacles/contact.cuh"
#include "12_obstacles/path.h"
#include "common/device_buffer.h"
#include "common/errors.h"

namespace obstacles {

enum class Control {
    path,  ///< moves as written, whatever hits it
    hand,  ///< follows a hand, no faster than the scene allows
    free   ///< has a mass, and moves as particles and gravity push it: momentum goes both ways
};

struct Obstacle {
    Solid solid;
    Surface surface;
    Control control = Control::path;
    Path path;           ///< a free one starts where its path starts
    double mass_kg = 0;  ///< of a free one
};

/// What the obstacles have to know of the particles and their tank.
struct Setting {
    std::uint32_t particles = 0;
    double particle_mass_kg = 1;
    float gap_m = 0;  ///< particle centres stay that far from an obstacle
    glm::vec3 low_m{-1e30f}, high_m{1e30f};
    glm::dvec3 gravity_m_per_s2{0};
    double dt_s = 1e-3;
    double fastest_m_per_s = 1e30;  ///< no obstacle moves faster
    const char* why_fastest = "";   ///< half a sentence for who tries to
    bool measure_forces = false;    ///< add up impulses also on obstacles that do not feel them
};

/// A moving obstacle crosses at most so many of its own half sizes in a step. fp32 has seven digits: beyond
/// that, rounding of the way is no longer small against the gap.
constexpr double kMostSizesPerStep = 1000;

/// @throws course::BadInput naming what is wrong with an obstacle
inline void check(const Obstacle& obstacle, const Setting& setting) {
    const auto want = [](bool good, const char* sentence, double value) {
        char text[256];
        std::snprintf(text, sizeof text, sentence, value);
        if (!good) throw course::BadInput(text);
    };
    const glm::vec3 half = obstacle.solid.half_size_m;
    const float smallest = std::fmin(half.x, std::fmin(half.y, half.z));
    const float largest = std::fmax(half.x, std::fmax(half.y, half.z));
    // Squares of sizes must neither vanish nor overflow in fp32; NaN fails both.
    want(smallest >= 1e-6f, "an obstacle must be at least 1e-6 m in radius or half its edge, not %g m",
         smallest);
    want(largest <= 1e6f, "an obstacle must be at most 1e6 m in radius or half its edge, not %g m", largest);
    const Surface& surface = obstacle.surface;
    want(surface.restitution >= 0 && surface.restitution <= 1, "the restitution must be 0 to 1, not %g",
         surface.restitution);
    want(surface.friction >= 0 && surface.friction <= 1e6f, "the friction must be 0 or above, not %g",
         surface.friction);
    const Path& path = obstacle.path;
    const double fastest = path.fastest_m_per_s();
    want(std::isfinite(fastest) && std::isfinite(glm::length(path.start_m)),
         "an obstacle's path must be finite, not %g", fastest);
    for (const Leg& leg : path.legs) {
        want(leg.duration_s >= 0 && std::isfinite(leg.duration_s),
             "a leg of a path must last 0 s or more, not %g s", leg.duration_s);
        const double a = glm::length(leg.acceleration_m_per_s2);
        want(std::isfinite(a), "an obstacle's acceleration must be finite, not %g m/s^2", a);
    }
    if (path.repeats) {
        const double jump = glm::length(path.after_legs().velocity_m_per_s - path.start_velocity_m_per_s);
        want(jump <= 1e-9 * (1 + fastest),
             "a path that repeats must end as fast as it starts, not with %g m/s more", jump);
    }
    if (obstacle.control == Control::free)
        want(obstacle.mass_kg > 0 && std::isfinite(obstacle.mass_kg),
             "a free obstacle's mass must be above 0, not %g kg", obstacle.mass_kg);
    char text[256];
    std::snprintf(text, sizeof text, "an obstacle moves at %g m/s, over the limit of %g m/s: %s", fastest,
                  setting.fastest_m_per_s, setting.why_fastest);
    if (!(fastest <= setting.fastest_m_per_s)) throw course::BadInput(text);
    const double limit = kMostSizesPerStep * smallest / setting.dt_s;
    std::snprintf(
        text, sizeof text,
        "an obstacle moves at %g m/s, over the limit of %g m/s: %g of its half sizes in a step of %g s",
        fastest, limit, kMostSizesPerStep, setting.dt_s);
    if (!(fastest <= limit)) throw course::BadInput(text);
}

/// Obstacles at work. In each step: move(), then the model's step with contact() between its drift and its
/// forces, then finish().
class ObstacleSet {
  public:
    /// @throws course::BadInput naming what is wrong with an obstacle
    ObstacleSet(const std::vector<Obstacle>& obstacles, const Setting& setting)
        : obstacles_(obstacles), setting_(setting), two_way_(setting.measure_forces) {
        if (obstacles.size() > std::size_t(kMaxObstacles))
            throw course::BadInput("at most " + std::to_string(kMaxObstacles) + " obstacles, not " +
                                   std::to_string(obstacles.size()));
        if (!(setting.dt_s > 0)) throw course::BadInput("the time step must be above 0");
        now_.count = int(obstacles.size());
        now_.dt_s = float(setting.dt_s);
        now_.low_m = setting.low_m;
        now_.high_m = setting.high_m;
        for (int k = 0; k < now_.count; ++k) {
            const Obstacle& o = obstacles[k];
            check(o, setting);
            motion_.push_back(o.path.at(0));
            hand_m_.push_back(motion_[k].position_m);
            two_way_ = two_way_ || o.control == Control::free;
            now_.obstacle[k].solid = inflated(o.solid, setting.gap_m);
            now_.obstacle[k].surface = o.surface;
            now_.obstacle[k].from_m = now_.obstacle[k].to_m = motion_[k].position_m;
        }
        received_.assign(obstacles.size(), glm::dvec3(0));
        pass_.mass_kg = setting.particle_mass_kg;
        if (!two_way_) return;  // nobody feels anything: nothing is kept or added up
        impulse_ = course::DeviceBuffer<Impulse>(std::size_t(setting.particles) * now_.count);
        pass_.impulse = impulse_.data();
        add_impulses_.emplace_back(setting.particles);
        for (int k = 0; k < now_.count; ++k) {
            count_hits_.emplace_back(setting.particles);
            pass_.hits[k] = count_hits_[k].result();
            if (obstacles[k].control == Control::free)
                pass_.weight[k] = float(setting.particle_mass_kg / obstacles[k].mass_kg);
        }
    }

    bool empty() const { return now_.count == 0; }
    int size() const { return now_.count; }
    bool two_way() const { return two_way_; }
    const Obstacle& obstacle(int k) const { return obstacles_[k]; }
    const Motion& motion(int k) const { return motion_[k]; }
    const Obstacles& now() const { return now_; }
    const Setting& setting() const { return setting_; }
    /// Of all particles on obstacle k in the last step, in kg m/s. Only where two_way().
    glm::dvec3 impulse(int k) const { return received_[k]; }
    std::size_t bytes_per_particle() const {
        return two_way_ ? sizeof(Impulse) * std::size_t(now_.count) : 0;
    }
    /// For passes that push particles in another way: n elements for each obstacle; nullptr if nobody feels
    /// it.
    Impulse* impulses() { return pass_.impulse; }

    /// Where a hand wants obstacle k to be. It follows as fast as the scene allows.
    void lead(int k, glm::dvec3 to_m) { hand_m_[k] = to_m; }

    //! [move]
    /// All obstacles to where they are at the end of this step.
    void move() {
        ++steps_;
        const double dt = setting_.dt_s;
        for (int k = 0; k < now_.count; ++k) {
            const Motion before = motion_[k];
            Motion& now = motion_[k];
            bool even = true;
            switch (obstacles_[k].control) {
                case Control::path:
                    now = obstacles_[k].path.at(double(steps_) * dt);
                    even = false;
                    break;
                case Control::hand:
                    now = towards(now, hand_m_[k]);
                    break;
                case Control::free:  // leapfrog, as the particles: half a kick, then the drift
                    now.velocity_m_per_s += 0.5 * dt * setting_.gravity_m_per_s2;
                    now.position_m += dt * now.velocity_m_per_s;
                    stay_in_tank(now, obstacles_[k].solid);
                    break;
            }
            Moving& o = now_.obstacle[k];
            o.from_m = before.position_m;
            o.to_m = now.position_m;
            // A hand and a leapfrog step have one velocity all through the step; a path has one at each end.
            o.from_m_per_s = even ? now.velocity_m_per_s : before.velocity_m_per_s;
            o.to_m_per_s = now.velocity_m_per_s;
        }
    }
    //! [move]

    //! [contact]
    /// Particles that have met an obstacle in this step go where it sends them. Without obstacles nothing is
    /// launched.
    /// @param velocity  the one each particle has moved with; in and out
    template <class Clock>
    void contact(float4* position, float4* velocity, std::uint32_t n, Clock clock) {
        if (empty() || n == 0) return;
        const std::uint32_t blocks = patterns::blocks_for(n, kThreads);
        if (two_way_) {
            for (int k = 0; k < now_.count; ++k)
                if (pass_.weight[k] > 0) count_hits_[k](Hits<Clock>{position, velocity, now_, clock, k}, n);
            contact_kernel<Clock, true><<<blocks, kThreads>>>(position, velocity, now_, clock, pass_, n);
        } else {
            contact_kernel<Clock, false><<<blocks, kThreads>>>(position, velocity, now_, clock, pass_, n);
        }
        CUDA_CHECK(cudaGetLastError());
    }
    //! [contact]

    //! [finish]
    /// Free obstacles get what the particles have lost: to the last bit of a double. Waits for the device.
    void finish(std::uint32_t n) {
        if (!two_way_) return;
        for (int k = 0; k < now_.count; ++k) {
            add_impulses_[0](static_cast<const Impulse*>(pass_.impulse + std::size_t(k) * n), n);
            const Impulse sum = add_impulses_[0].download();
            received_[k] = {sum.x, sum.y, sum.z};
            if (obstacles_[k].control != Control::free) continue;
            motion_[k].velocity_m_per_s +=
                received_[k] / obstacles_[k].mass_kg + 0.5 * setting_.dt_s * setting_.gravity_m_per_s2;
        }
    }
    //! [finish]

    static constexpr std::uint32_t kThreads = 128;

  private:
    /// One step of a hand: to where it points, or as far as the fastest speed takes it.
    Motion towards(const Motion& now, glm::dvec3 to_m) const {
        const double most_m = std::min(setting_.fastest_m_per_s, 1e30) * setting_.dt_s;
        glm::dvec3 way = to_m - now.position_m;
        const double length = glm::length(way);
        if (length > most_m) way *= most_m / length;
        return {now.position_m + way, way / setting_.dt_s, {}};
    }
    /// The tank's walls stop a free obstacle. (What they take of its momentum is the tank's.)
    void stay_in_tank(Motion& now, const Solid& solid) const {
        for (int axis = 0; axis < 3; ++axis) {
            const double low = setting_.low_m[axis] + solid.half_size_m[axis];
            const double high = setting_.high_m[axis] - solid.half_size_m[axis];
            const double inside = std::clamp(now.position_m[axis], low, std::max(low, high));
            if (inside == now.position_m[axis]) continue;
            now.position_m[axis] = inside;
            now.velocity_m_per_s[axis] = 0;
        }
    }

    std::vector<Obstacle> obstacles_;
    Setting setting_;
    Obstacles now_;
    std::vector<Motion> motion_;
    std::vector<glm::dvec3> hand_m_, received_;
    std::uint64_t steps_ = 0;
    bool two_way_ = false;
    TwoWay pass_{};
    course::DeviceBuffer<Impulse> impulse_;
    std::vector<patterns::TreeReduction<patterns::Sum<std::uint32_t>>> count_hits_;
    std::vector<patterns::TreeReduction<AddImpulses>> add_impulses_;
};

}  // namespace obstacles
