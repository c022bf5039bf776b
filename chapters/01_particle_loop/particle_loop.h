/// @file
/// A fountain as a loop over particles: emission, gravity, linear drag, bounce, and the same state kept in
/// two layouts. Lengths in metres, times in seconds, y points up, the floor is the plane y = 0.
///
/// What is `constexpr` here is plain arithmetic on its arguments. Chapter 03 calls exactly these functions
/// from the GPU (nvcc takes constexpr functions into device code with --expt-relaxed-constexpr).
#pragma once
#include <Random123/philox.h>

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

/// Chapter 01: a fountain as a loop over particles.
namespace particle_loop {

constexpr int kMaxJets = 16;

/// Everything that makes one fountain differ from another. A plain struct: it is copied to the GPU as it is.
struct Fountain {
    float dt_s = 0.004f;
    float gravity_m_per_s2 = 9.81f;
    float drag_per_s = 0.35f;      ///< k of the linear drag a = -k v
    float restitution = 0.4f;      ///< vertical speed after a bounce / before it
    float floor_grip = 0.6f;       ///< horizontal speed after a bounce / before it
    float lifetime_s = 2.4f;       ///< then the droplet starts again at the nozzle
    float spread_m_per_s = 0.25f;  ///< largest deviation from a jet's velocity, on each axis
    glm::vec3 nozzle_m{0.0f, 0.25f, 0.0f};
    int jet_count = 0;
    glm::vec3 jet_m_per_s[kMaxJets]{};  ///< velocity with which a droplet leaves jet 0, 1, ...
    std::uint64_t seed = 1;
};

/// A droplet: what the array of structs has n of.
struct Particle {
    glm::vec3 position_m{0.0f};
    glm::vec3 velocity_m_per_s{0.0f};
};

// ------------------------------------------------------------------------------------------ one droplet

//! [acceleration]
/// Gravity and linear drag: a = g - k v.
constexpr glm::vec3 acceleration(const Fountain& fountain, glm::vec3 velocity) {
    return glm::vec3(0.0f, -fountain.gravity_m_per_s2, 0.0f) - fountain.drag_per_s * velocity;
}
//! [acceleration]

//! [move]
/// One time step of one droplet in flight: semi-implicit Euler, then the floor.
constexpr void move(const Fountain& fountain, glm::vec3& position, glm::vec3& velocity) {
    velocity += fountain.dt_s * acceleration(fountain, velocity);
    position += fountain.dt_s * velocity;  // the new velocity: that is what makes it semi-implicit

    // The floor, without a branch: choose two factors, then multiply always. A branch on data keeps some
    // compilers from moving 4, 8 or 16 droplets with one instruction.
    const bool below = position.y < 0.0f;
    const float bounce = below ? -fountain.restitution : 1.0f;
    const float grip = below ? fountain.floor_grip : 1.0f;
    position.y *= bounce;
    velocity *= glm::vec3(grip, bounce, grip);
}
//! [move]

/// Eight random numbers in [0, 1).
struct Uniforms {
    float u[8];
};

/// The upper 24 bits of a random word as a float in [0, 1): a float holds 24 bits, so this is exact.
constexpr float to_unit_interval(std::uint32_t word) {
    return float(word >> 8) * 0x1p-24f;
}

//! [random_start]
/// The numbers that decide one life of one droplet. Philox is a hash with a key, not a sequence: the same
/// (seed, id, generation) gives the same life, whoever asks, in whatever order.
inline Uniforms random_start(std::uint64_t seed, std::uint32_t id, std::uint32_t generation) {
    const r123::Philox4x32::key_type key{{std::uint32_t(seed), std::uint32_t(seed >> 32)}};
    Uniforms start{};
    for (std::uint32_t block = 0; block < 2; ++block) {
        const r123::Philox4x32::ctr_type words = r123::Philox4x32()({{id, generation, block, 0}}, key);
        for (int k = 0; k < 4; ++k) start.u[4 * block + k] = to_unit_interval(words.v[k]);
    }
    return start;
}
//! [random_start]

//! [emit]
/// Starts a life: picks a jet, shakes its velocity a little, and lets the droplet fly for a random part of
/// the step. (All droplets of one step exactly in the nozzle would fly as one shell, and be seen as one.)
/// @return the droplet's age in seconds
// Always inlined: a call would want the fountain in memory, and every thread of a kernel would copy it there.
[[gnu::always_inline]] constexpr float emit(const Fountain& fountain, const Uniforms& r, glm::vec3& position,
                                            glm::vec3& velocity) {
    const int jet = int(r.u[0] * float(fountain.jet_count));
    // The sum of two uniform numbers is small more often than large: a jet is densest in its middle.
    const glm::vec3 deviation{r.u[1] + r.u[2] - 1.0f, r.u[3] + r.u[4] - 1.0f, r.u[5] + r.u[6] - 1.0f};
    velocity = fountain.jet_m_per_s[jet] + fountain.spread_m_per_s * deviation;
    const float age_s = r.u[7] * fountain.dt_s;
    position = fountain.nozzle_m + age_s * velocity;
    return age_s;
}
//! [emit]

// ------------------------------------------------------------------------------------- who starts when

/// Steps of one life: at least one, and at most as many as can be counted (a time step of 0: endless life).
constexpr std::uint32_t life_steps(const Fountain& fountain) {
    const float steps = fountain.lifetime_s / fountain.dt_s + 0.5f;
    if (!(steps >= 1.0f)) return 1u;
    return steps < 0x1p32f ? std::uint32_t(steps) : 0xffffffffu;  // beyond, the conversion is undefined
}

/// What one step does to which droplets.
struct StepPlan {
    std::uint32_t moving = 0;           ///< droplets 0 ... moving - 1 are in flight
    std::uint32_t first = 0, last = 0;  ///< droplets first ... last - 1 start a new life
    std::uint32_t generation = 0;       ///< that life's number

    constexpr bool starts(std::uint32_t id) const { return id >= first && id < last; }
    constexpr bool waits(std::uint32_t id) const { return id >= moving && !starts(id); }  ///< not born yet
};

//! [plan_step]
/// A droplet lives L steps and n droplets share them evenly, so step s of a round starts those with
/// s n / L <= id < (s + 1) n / L: a contiguous slice, known without looking at any droplet. Steps are
/// counted, never summed as seconds: 0.001f added a million times is 991, not 1000.
constexpr StepPlan plan_step(const Fountain& fountain, std::uint32_t n, std::uint32_t step) {
    const std::uint32_t life = life_steps(fountain);
    const std::uint64_t in_round = step % life;  // 64 bits: s n may be over 2^32
    StepPlan plan;
    plan.first = std::uint32_t(in_round * n / life);
    plan.last = std::uint32_t((in_round + 1) * n / life);
    plan.generation = step / life;
    plan.moving = plan.generation == 0 ? plan.first : n;  // in the first round the later ones wait
    return plan;
}
//! [plan_step]

/// Droplets that have left the nozzle once `steps` steps are done.
constexpr std::uint32_t born_after(const Fountain& fountain, std::uint32_t n, std::uint32_t steps) {
    return steps == 0 ? 0u : steps >= life_steps(fountain) ? n : plan_step(fountain, n, steps - 1).last;
}

// ------------------------------------------------------------------------------------------- the loops

//! [loop_aos]
/// The first `count` droplets, kept as an array of structs: x y z vx vy vz, x y z vx vy vz, ...
inline void move_all(std::vector<Particle>& particles, std::uint32_t count, const Fountain& fountain) {
    for (std::uint32_t i = 0; i < count; ++i)
        move(fountain, particles[i].position_m, particles[i].velocity_m_per_s);
}
//! [loop_aos]

//! [arrays]
/// The same state as a struct of arrays: x x x ..., y y y ..., and so on.
struct ParticleArrays {
    std::vector<float> x_m, y_m, z_m, vx_m_per_s, vy_m_per_s, vz_m_per_s;

    explicit ParticleArrays(std::size_t n = 0)
        : x_m(n), y_m(n), z_m(n), vx_m_per_s(n), vy_m_per_s(n), vz_m_per_s(n) {}
    std::size_t size() const { return x_m.size(); }

    Particle load(std::size_t i) const {
        return {{x_m[i], y_m[i], z_m[i]}, {vx_m_per_s[i], vy_m_per_s[i], vz_m_per_s[i]}};
    }
    void store(std::size_t i, const Particle& p) {
        x_m[i] = p.position_m.x, y_m[i] = p.position_m.y, z_m[i] = p.position_m.z;
        vx_m_per_s[i] = p.velocity_m_per_s.x, vy_m_per_s[i] = p.velocity_m_per_s.y,
        vz_m_per_s[i] = p.velocity_m_per_s.z;
    }
};
//! [arrays]

//! [loop_soa]
/// The same for six arrays. Two promises let the compiler move 4, 8 or 16 droplets at once: `__restrict__`,
/// the arrays do not overlap (x[i] = ... never changes vy[i + 1]); and the fountain comes as a copy, which no
/// store can reach. Without both it must fear the worst, and goes one by one.
inline void move_all(float* __restrict__ x, float* __restrict__ y, float* __restrict__ z,
                     float* __restrict__ vx, float* __restrict__ vy, float* __restrict__ vz,
                     std::uint32_t count, Fountain fountain) {
    for (std::uint32_t i = 0; i < count; ++i) {
        glm::vec3 position{x[i], y[i], z[i]}, velocity{vx[i], vy[i], vz[i]};
        move(fountain, position, velocity);
        x[i] = position.x, y[i] = position.y, z[i] = position.z;
        vx[i] = velocity.x, vy[i] = velocity.y, vz[i] = velocity.z;
    }
}
//! [loop_soa]
inline void move_all(ParticleArrays& p, std::uint32_t count, const Fountain& fountain) {
    move_all(p.x_m.data(), p.y_m.data(), p.z_m.data(), p.vx_m_per_s.data(), p.vy_m_per_s.data(),
             p.vz_m_per_s.data(), count, fountain);
}

inline void store(std::vector<Particle>& particles, std::size_t i, const Particle& p) {
    particles[i] = p;
}
inline void store(ParticleArrays& particles, std::size_t i, const Particle& p) {
    particles.store(i, p);
}

//! [step]
/// One step of all droplets, in either layout.
template <class Particles>
void step(Particles& particles, const Fountain& fountain, std::uint32_t step_index) {
    const StepPlan plan = plan_step(fountain, std::uint32_t(particles.size()), step_index);
    move_all(particles, plan.moving, fountain);
    for (std::uint32_t i = plan.first; i < plan.last; ++i) {
        Particle p;
        emit(fountain, random_start(fountain.seed, i, plan.generation), p.position_m, p.velocity_m_per_s);
        store(particles, i, p);
    }
}
//! [step]

//! [count_above]
/// How many of the first `count` droplets are higher than `height_m`: a question that needs one of six
/// numbers.
inline std::uint32_t count_above(const std::vector<Particle>& particles, std::uint32_t count,
                                 float height_m) {
    std::uint32_t above = 0;
    for (std::uint32_t i = 0; i < count; ++i) above += particles[i].position_m.y > height_m;
    return above;
}
inline std::uint32_t count_above(const ParticleArrays& particles, std::uint32_t count, float height_m) {
    std::uint32_t above = 0;
    for (std::uint32_t i = 0; i < count; ++i) above += particles.y_m[i] > height_m;
    return above;
}
//! [count_above]

}  // namespace particle_loop
