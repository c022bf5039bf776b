/// @file
/// The velocity-vortex fire: vortons stir the air, and chapter 07's particles go with it.
#pragma once
#include "07_fire_particles/flame.cuh"
#include "08_fire_vortex/vortons.cuh"

namespace vortex {

/// What makes a vortex fire out of a fire.
struct VortexModel {
    std::uint32_t vortons = 2048;
    VortonPhysics physics;
    fire::ParticleKind birth;        ///< where vortons are born, and how long they live
    float heat_m4_per_s2 = 0;        ///< of a newborn vorton: buoyancy x volume
    float birth_turn_rad_per_s = 0;  ///< of a newborn vorton's core, any way round: what breaks the symmetry
    float hot_m_per_s2 = 1;          ///< buoyancy of gas that is all flame...
    float burn_out_per_s = 0;        ///< ...and how much faster than in there a flame ages in cold air
    float reach_m = 10;  ///< the grid ends there, and vortons farther from their birthplace start again
    FarField far_field;  ///< the default is the study's conclusion
    Stepping stepping = Stepping::euler;
    float cell_m = 0.06f;
    std::uint32_t max_cells = 32768;
    BallPath ball;
    float mirror_m = 0;  ///< see Flow: how far up the ground is felt; 0: there is no ground
};

//! [rebirth]
/// One thread per vorton: whose life is over, or who got lost, starts again at the emitter. A newborn carries
/// a vorton's share of the hot gas and hardly any spin: the gas will give it spin.
inline __global__ void rebirth_kernel(VortonState state, std::uint32_t* generation, VortexModel model,
                                      std::uint64_t seed, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    glm::vec3 x = xyz(state.position[i]);
    const bool lost = glm::length(x - model.birth.emitter.centre_m) > model.reach_m;
    if (state.position[i].w > 0 && !lost) {
        if (model.mirror_m > 0 && x.y < 0) state.position[i].y = 0;  // what a finite dt has pushed through
        return;
    }
    const std::uint32_t life = ++generation[i];
    const particle_loop::Uniforms r = first_kernels::random_start_on_device(seed, i, life);
    const fire::Birth b = fire::birth(model.birth, r);
    // Any direction, evenly: height evenly in -1 ... 1, and an angle round the axis.
    const float up = 2 * r.u[2] - 1, angle = 6.2831853f * r.u[3], flat = std::sqrt(1 - up * up);
    const float core3 = model.physics.core_m * model.physics.core_m * model.physics.core_m;
    const float size = model.birth_turn_rad_per_s * core3 / float(2.5 / (4 * kPi));
    state.position[i] = make_float4(b.position_m.x, b.position_m.y, b.position_m.z, b.life_s);
    state.strength[i] = make_float4(size * flat * std::cos(angle), size * up, size * flat * std::sin(angle),
                                    model.heat_m4_per_s2);
}
//! [rebirth]

//! [flames]
/// One thread per particle: a step of its life in the flow. Where the gas is cold a flame burns out sooner:
/// that is what tears a fire into tongues.
template <bool kBall>
__global__ void vortex_flame_kernel(fire::FlameArrays a, std::uint32_t n, fire::Fire fire, Flow flow,
                                    float hot_m_per_s2, float burn_out_per_s, float dt_s) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const float4 x = a.position[i], v = a.velocity[i];
    fire::FlameParticle p{xyz(x), xyz(v), x.w, v.w, a.generation[i]};
    const auto air = [&](glm::vec3 x_m) { return flow.along_path<kBall>(x_m, dt_s); };
    fire::advance_in(air, fire, i, dt_s, p);
    if (flow.mirror_m > 0 && p.position_m.y < 0) p.position_m.y = 0;
    if constexpr (kBall) push_out(flow.ball, p.position_m);
    const bool flame = i < fire.kind[0].count;  // smoke and sparks do not burn
    if (flame && p.age_s > 0) {
        const float hot = sample(flow.field, flow.grid, p.position_m).w / hot_m_per_s2;
        p.age_s += dt_s * burn_out_per_s * fmaxf(0.0f, 1 - hot);
    }
    a.position[i] = make_float4(p.position_m.x, p.position_m.y, p.position_m.z, p.age_s);
    a.velocity[i] = make_float4(p.velocity_m_per_s.x, p.velocity_m_per_s.y, p.velocity_m_per_s.z, p.life_s);
    a.generation[i] = p.generation;
}
//! [flames]

//! [shade]
/// What the vortex model knows at each place, and particles that know nothing of each other do not.
enum class Known { vorticity, speed };

/// How it lights flames: from `low` times their light where it is 0, to `high` times from `full` on.
struct Shading {
    float low = 1, high = 1, full = 1;  ///< full: 1/s (vorticity) or m/s (speed)
    float slice_m = 1e30f;              ///< flames farther from the plane z = 0 stay dark
};

/// One thread per particle, and only when a picture is drawn. A flame burns where fuel meets air, and that is
/// where the gas rolls: the more vorticity, the brighter.
template <Known kKnown>
__global__ void shade_kernel(float* gain, const float4* position, std::uint32_t n, Flow flow,
                             Shading shading) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const glm::vec3 x = xyz(position[i]);
    glm::vec3 known;
    if constexpr (kKnown == Known::vorticity) {
        const float4 dx = slope(flow.field, flow.grid, x, {1, 0, 0});
        const float4 dy = slope(flow.field, flow.grid, x, {0, 1, 0});
        const float4 dz = slope(flow.field, flow.grid, x, {0, 0, 1});
        known = {dy.z - dz.y, dz.x - dx.z, dx.y - dy.x};
    } else {
        known = flow.at<false>(x);
    }
    const float t = fminf(1.0f, glm::length(known) / shading.full);
    const float lit = shading.low + (shading.high - shading.low) * t * t * (3 - 2 * t);
    gain[i] = std::abs(x.z) <= shading.slice_m ? lit : 0.0f;
}
//! [shade]

//! [watch]
/// One thread per element: the greatest speed, and the first element that is not finite.
struct Watch {
    std::uint32_t greatest_bits = 0;  ///< a float that is not negative sorts like its bits
    std::uint32_t first_bad = ~0u;
};
inline __global__ void watch_kernel(Watch* watch, const float4* position, const float4* vector,
                                    std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const float size = glm::length(xyz(vector[i]));
    if (!grid::is_finite(xyz(position[i])) || !(size < 1e30f))
        atomicMin(&watch->first_bad, i);
    else
        atomicMax(&watch->greatest_bits, __float_as_uint(size));
}
//! [watch]

/// @throws course::BadInput naming the first number that makes no sense
inline void check(const VortexModel& m) {
    const auto want = [](bool good, const std::string& sentence) {
        if (!good) throw course::BadInput(sentence);
    };
    const auto positive = [](float x) { return x > 0 && std::isfinite(x); };
    want(positive(m.physics.core_m),
         "a vorton's core must have a size above 0: without one it is a singularity");
    want(positive(m.reach_m), "the reach of the fire must be larger than 0 m");
    want(positive(m.cell_m), "the cells of the velocity grid must be larger than 0");
    want(positive(m.physics.decay_time_s) && positive(m.physics.cooling_time_s),
         "the times of decay and cooling must be above 0");
    want(positive(m.physics.max_turn_rad_per_s), "the greatest turn of a core must be above 0");
    want(positive(m.birth.life_s), "a vorton must live longer than 0 s");
    want(m.far_field.reach >= 1 && m.far_field.reach <= 64, "the reach must be 1 to 64 cells");
    want(m.max_cells >= kSmallestMaxCells && m.max_cells <= (1u << 24), "max_cells must be 125 to 2^24");
    want(m.ball.radius_m >= 0 && positive(m.ball.period_s), "a ball needs a radius and a period");
}

//! [VortexFire]
/// The vortons of a fire and their grid. The flame particles themselves are chapter 07's, and lie where their
/// owner wants them: in OpenGL's memory when they are drawn, in the device's when only numbers are wanted.
class VortexFire {
  public:
    /// Nothing burns yet: vortons are born one by one during the first steps, as the particles are.
    /// @param fire  kind 0 is the flame: it burns, and the grid follows it
    /// @throws course::BadInput if the model makes no sense
    VortexFire(const fire::Fire& fire, const VortexModel& model)
        : fire_(fire),
          model_((check(model), model)),
          n_(fire::particle_count(fire)),
          velocity_(model.vortons, model.max_cells, model.far_field),
          vorton_position_(model.vortons),
          vorton_strength_(std::vector<float4>(model.vortons, make_float4(0, 0, 0, 0))),
          vorton_generation_(std::vector<std::uint32_t>(model.vortons, 0)) {
        if (model.stepping == Stepping::midpoint) {
            halfway_position_ = course::DeviceBuffer<float4>(model.vortons);
            halfway_strength_ = course::DeviceBuffer<float4>(model.vortons);
        }
        // Cold and without spin a vorton does nothing: until its turn comes it may as well drift along.
        std::vector<float4> waiting(model.vortons);
        const glm::vec3 at = model.birth.emitter.centre_m;
        for (std::uint32_t i = 0; i < model.vortons; ++i)
            waiting[i] = make_float4(at.x, at.y, at.z, model.birth.life_s * (i + 0.5f) / model.vortons);
        vorton_position_.upload(waiting);
    }

    /// One step of vortons and flames. Waits for the device to tell the bounds of the fire: how many cells
    /// the grid has is decided here.
    /// @param flames particle_count(fire) elements each
    void step(fire::FlameArrays flames, float dt_s) {
        const float time_s = this->time_s(dt_s);
        const std::uint32_t flame_count = fire_.kind_count > 0 ? fire_.kind[0].count : 0;
        grid::Bounds box = around(grid::find_bounds(vorton_position_.data(), model_.vortons),
                                  grid::find_bounds(flames.position, flame_count));
        // One flame flung far away must not make all cells large: it reads the grid's rim.
        box.low_m = glm::max(box.low_m, model_.birth.emitter.centre_m - model_.reach_m);
        box.high_m = glm::min(box.high_m, model_.birth.emitter.centre_m + model_.reach_m);
        box.low_m.y = std::fmin(box.low_m.y, -model_.mirror_m);
        const Surroundings surroundings{fire_grid(box, model_.cell_m, model_.max_cells), fire_.wind, time_s,
                                        model_.ball.at(time_s), model_.mirror_m};
        flow_ = step_vortons(velocity_, vortons(), {halfway_position_.data(), halfway_strength_.data()},
                             model_.vortons, surroundings, model_.physics, model_.stepping, dt_s);
        if (model_.vortons > 0) {
            rebirth_kernel<<<grid::blocks_for(model_.vortons, kThreads), kThreads>>>(
                vortons(), vorton_generation_.data(), model_, ~fire_.seed, model_.vortons);
            CUDA_CHECK(cudaGetLastError());
        }
        if (n_ > 0) move_flames(flames, dt_s);
        ++steps_;
    }

    /// One number for each flame particle, for the renderer: see shade_kernel.
    template <Known kKnown = Known::vorticity>
    void shade(float* gain, const float4* flame_position, const Shading& shading) const {
        if (n_ == 0) return;
        shade_kernel<kKnown>
            <<<grid::blocks_for(n_, kThreads), kThreads>>>(gain, flame_position, n_, flow_, shading);
        CUDA_CHECK(cudaGetLastError());
    }

    /// @throws course::Unstable if a number is none, dt far over its limit, or gas faster than sound
    void check_state(fire::FlameArrays flames, float dt_s) const;

    VortonState vortons() { return {vorton_position_.data(), vorton_strength_.data()}; }
    const course::DeviceBuffer<float4>& vorton_positions() const { return vorton_position_; }
    const course::DeviceBuffer<float4>& vorton_strengths() const { return vorton_strength_; }
    std::uint32_t particles() const { return n_; }
    const VortexModel& model() const { return model_; }
    const Flow& flow() const { return flow_; }  ///< of the last step
    std::size_t grid_bytes() const { return velocity_.bytes(); }
    std::uint64_t steps() const { return steps_; }
    float time_s(float dt_s) const { return float(double(steps_) * dt_s); }  // counted, never summed

    static constexpr std::size_t kVortonBytes = 2 * sizeof(float4) + sizeof(std::uint32_t);
    static constexpr std::uint32_t kThreads = 64;

  private:
    void move_flames(fire::FlameArrays flames, float dt_s) {
        const std::uint32_t blocks = grid::blocks_for(n_, kThreads);
        if (flow_.ball.radius_m > 0)
            vortex_flame_kernel<true><<<blocks, kThreads>>>(flames, n_, fire_, flow_, model_.hot_m_per_s2,
                                                            model_.burn_out_per_s, dt_s);
        else
            vortex_flame_kernel<false><<<blocks, kThreads>>>(flames, n_, fire_, flow_, model_.hot_m_per_s2,
                                                             model_.burn_out_per_s, dt_s);
        CUDA_CHECK(cudaGetLastError());
    }

    fire::Fire fire_;
    VortexModel model_;
    std::uint32_t n_;
    std::uint64_t steps_ = 0;
    VelocityGrid velocity_;
    Flow flow_{};
    course::DeviceBuffer<float4> vorton_position_, vorton_strength_, halfway_position_, halfway_strength_;
    course::DeviceBuffer<std::uint32_t> vorton_generation_;
};
//! [VortexFire]

/// A step in which a core turns farther than that follows no circle any more: see the stability map.
constexpr float kMostTurn_rad = 2;

/// Sound in air. Nothing in a fire gets near it, unless the numbers have run away.
constexpr float kSoundSpeed_m_per_s = 343;

inline void VortexFire::check_state(fire::FlameArrays flames, float dt_s) const {
    const auto watch = [](const float4* position, const float4* vector, std::uint32_t n) {
        course::DeviceBuffer<Watch> seen(std::vector<Watch>(1));
        if (n > 0)
            watch_kernel<<<grid::blocks_for(n, kThreads), kThreads>>>(seen.data(), position, vector, n);
        CUDA_CHECK(cudaGetLastError());
        return seen.download()[0];
    };
    const auto complain = [&](const std::string& what) {
        const float turn = model_.physics.max_turn_rad_per_s;
        throw course::Unstable("step " + std::to_string(steps_) + ": " + what + ". dt is " +
                               std::to_string(dt_s) + " s; cores that turn by " + std::to_string(turn) +
                               " rad/s want less than " + std::to_string(1 / turn) + " s");
    };
    const Watch vorton = watch(vorton_position_.data(), vorton_strength_.data(), model_.vortons);
    const Watch flame = watch(flames.position, flames.velocity, n_);
    if (vorton.first_bad != ~0u)
        complain("vorton " + std::to_string(vorton.first_bad) +
                 " has a position or strength that is no number");
    if (flame.first_bad != ~0u)
        complain("particle " + std::to_string(flame.first_bad) +
                 " has a position or velocity that is no number");
    const auto number = [](std::uint32_t bits) {
        float value;
        static_assert(sizeof value == sizeof bits);
        __builtin_memcpy(&value, &bits, sizeof value);
        return value;
    };
    const float turned = dt_s * core_turn_rad_per_s(number(vorton.greatest_bits), model_.physics.core_m);
    if (turned > kMostTurn_rad)
        complain("a vorton's core turns by " + std::to_string(turned) + " rad in one step");
    const float speed = number(flame.greatest_bits);
    if (speed > kSoundSpeed_m_per_s) complain("a particle flies at " + std::to_string(speed) + " m/s");
}

/// Memory for flame particles that nobody draws.
class DeviceFlames {
  public:
    explicit DeviceFlames(const fire::Fire& fire)
        : position_(fire::particle_count(fire)), velocity_(position_.size()), generation_(position_.size()) {
        fire::launch_flame_clear(arrays(), fire);
    }
    fire::FlameArrays arrays() { return {position_.data(), velocity_.data(), generation_.data()}; }
    const course::DeviceBuffer<float4>& positions() const { return position_; }
    const course::DeviceBuffer<float4>& velocities() const { return velocity_; }

  private:
    course::DeviceBuffer<float4> position_, velocity_;
    course::DeviceBuffer<std::uint32_t> generation_;
};

}  // namespace vortex
