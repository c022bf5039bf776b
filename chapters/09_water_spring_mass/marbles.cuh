/// @file
/// A body of marbles: its arrays on the device, and the passes of one time step in their order.
#pragma once
#include <utility>
#include <vector>

#include "09_water_spring_mass/check_input.h"
#include "09_water_spring_mass/contact.cuh"
#include "09_water_spring_mass/neighbour_list.cuh"
#include "common/device_buffer.h"

namespace spring_mass {

inline __host__ __device__ glm::vec3 as_vec3(float3 v) {
    return {v.x, v.y, v.z};
}

//! [kick_drift_kernel]
/// One thread per marble: first half of the leapfrog step, v += dt/2 a, then x += dt v. And a look at how far
/// the marble has come since the neighbour list was made.
template <bool kDrag>
__global__ void kick_drift_kernel(float4* position, float4* half_velocity, std::uint32_t* outdated,
                                  const float4* velocity, const float4* acceleration,
                                  const float4* listed_position, float drag_per_s, float half_skin_m,
                                  float dt_s, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    glm::vec3 v = grid::xyz(velocity[i]);
    if constexpr (kDrag) v -= 0.5f * dt_s * drag_per_s * v;
    v += 0.5f * dt_s * grid::xyz(acceleration[i]);
    const glm::vec3 x = grid::xyz(position[i]) + dt_s * v;
    position[i] = make_float4(x.x, x.y, x.z, 0.0f);
    half_velocity[i] = make_float4(v.x, v.y, v.z, 0.0f);
    const glm::vec3 moved = x - grid::xyz(listed_position[i]);
    if (!(glm::dot(moved, moved) <= half_skin_m * half_skin_m)) atomicExch(outdated, 1u);
}
//! [kick_drift_kernel]

/// All that the second pass reads and writes, given to the kernel as one argument.
struct ContactPass {
    float4 *velocity, *acceleration;         ///< written
    const float4 *position, *half_velocity;  ///< read; places are those of the new step
    NeighbourList list;
    Material material;
    Box box;
    std::uint32_t n;
};

//! [contact_kernel]
/// One thread per marble: the forces of all that touch it, at the new places and with the velocities in the
/// middle of the step; then the second half kick, v += dt/2 a. Velocities are read in one array and written
/// to another, since a neighbour may still have to read them.
template <bool kShear, bool kAttraction, bool kDrag>
__global__ void contact_kernel(ContactPass pass, float dt_s) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= pass.n) return;
    const Material& material = pass.material;
    const glm::vec3 x = grid::xyz(pass.position[i]), v = grid::xyz(pass.half_velocity[i]);
    const float touching = material.diameter_m * material.diameter_m;
    glm::vec3 force = wall_force<kShear>(material, as_vec3(pass.box.low_m), as_vec3(pass.box.high_m), x, v);
    const auto touches = [&](std::uint32_t j) {
        const glm::vec3 apart = x - grid::xyz(pass.position[j]);
        return glm::dot(apart, apart) < touching;
    };
    pass.list.for_each_near(i, touches, [&](std::uint32_t j) {
        force += pair_force<kShear, kAttraction>(material, x - grid::xyz(pass.position[j]),
                                                 v - grid::xyz(pass.half_velocity[j]), i < j);
    });
    const glm::vec3 a = force / material.mass_kg + material.gravity_m_per_s2;
    glm::vec3 v_new = v + 0.5f * dt_s * a;
    // Drag of this half kick acts on the velocity at its end. Taken from the velocity before it, it would be
    // the drag of half a step ago, and cost leapfrog its second order.
    if constexpr (kDrag) v_new /= 1.0f + 0.5f * dt_s * material.drag_per_s;
    pass.velocity[i] = make_float4(v_new.x, v_new.y, v_new.z, 0.0f);
    pass.acceleration[i] = make_float4(a.x, a.y, a.z, 0.0f);
}
//! [contact_kernel]

constexpr float kDefaultSkin = 0.4f;  ///< in diameters; study `skin`

/// State of n marbles on the device. Move-only.
class Marbles {
  public:
    /// @param position, velocity  w is ignored. Positions lie in the box.
    /// @param skin  of the neighbour list, in diameters
    /// @throws course::BadInput if the material, the box or a marble is not what a run can start from
    Marbles(const Material& material, const Box& box, const std::vector<float4>& position,
            const std::vector<float4>& velocity, float skin = kDefaultSkin)
        : material_(checked(material, box, position, velocity, skin)),
          box_(box),
          skin_m_(skin * material.diameter_m),
          n_(std::uint32_t(position.size())),
          cells_(fixed_grid()),
          sort_(n_, cells_.cell_count()),
          position_(position),
          listed_position_(n_),
          velocity_(n_),
          half_velocity_(velocity),
          acceleration_(n_),
          id_(n_),
          sorted_id_(n_),
          neighbour_(NeighbourList::place(n_)),
          neighbour_count_(n_),
          outdated_(1) {
        std::vector<std::uint32_t> ids(n_);
        for (std::uint32_t i = 0; i < n_; ++i) ids[i] = i;
        id_.upload(ids);
        outdated_.upload({0u});
        if (n_ == 0) return;
        make_list();
        launch_contacts(0);  // the acceleration at the start; velocities become those given
    }

    //! [step]
    /// One leapfrog step (kick, drift, kick).
    void step(float dt_s) {
        if (n_ == 0) return;
        launch_kick_drift(dt_s);
        if (list_is_outdated()) make_list();
        launch_contacts(dt_s);
    }
    //! [step]

    /// Marbles are kept sorted by cell; ids()[k] is the number that the marble at place k was made with.
    std::uint32_t size() const { return n_; }
    const float4* position() const { return position_.data(); }
    const float4* velocity() const { return velocity_.data(); }
    float4* position() { return position_.data(); }
    float4* velocity() { return velocity_.data(); }
    const course::DeviceBuffer<float4>& positions() const { return position_; }
    const course::DeviceBuffer<float4>& velocities() const { return velocity_; }
    const course::DeviceBuffer<float4>& accelerations() const { return acceleration_; }
    const course::DeviceBuffer<std::uint32_t>& ids() const { return id_; }
    const Material& material() const { return material_; }
    const Box& box() const { return box_; }
    NeighbourList list() const {
        return {neighbour_.data(), neighbour_count_.data(), listed_position_.data(), sort_.ranges(), cells_};
    }
    const course::DeviceBuffer<std::uint32_t>& list_lengths() const { return neighbour_count_; }
    std::uint32_t lists_made() const { return lists_made_; }
    std::uint32_t cell_count() const { return cells_.cell_count(); }
    std::size_t cell_bytes() const { return sort_.cell_bytes(); }

    bool has_shear() const { return material_.tangential_damping_per_s > 0; }
    bool has_attraction() const { return material_.attraction_N_per_m > 0; }
    bool has_drag() const { return material_.drag_per_s > 0; }

    /// Bytes of device memory per marble, the grid's cells not counted.
    static constexpr std::size_t kBytesPerMarble = 5 * sizeof(float4) + 2 * sizeof(std::uint32_t) +  // state
                                                   2 * sizeof(std::uint32_t) +  // cell and order
                                                   (1 + NeighbourList::kCapacity) * sizeof(std::uint32_t);

  private:
    static constexpr std::uint32_t kThreads = 128;
    std::uint32_t blocks() const { return grid::blocks_for(n_, kThreads); }

    /// Before any member is made: a grid for a diameter of 0 would never be done.
    static const Material& checked(const Material& material, const Box& box,
                                   const std::vector<float4>& position, const std::vector<float4>& velocity,
                                   float skin) {
        check_material(material);
        check_skin(skin);
        check_box(box, material.diameter_m);
        check_particles(position, velocity, box);
        return material;
    }

    float reach_m() const { return material_.diameter_m + skin_m_; }

    /// The box does not move, so neither does the grid: no pass over the marbles to find their bounds.
    grid::CellGrid fixed_grid() const {
        return grid::make_grid(as_vec3(box_.low_m), as_vec3(box_.high_m), reach_m(), grid::max_cells_for(n_));
    }

    //! [passes]
    void launch_kick_drift(float dt_s) {
        const float drag = material_.drag_per_s;
        if (has_drag())
            kick_drift_kernel<true><<<blocks(), kThreads>>>(
                position_.data(), half_velocity_.data(), outdated_.data(), velocity_.data(),
                acceleration_.data(), listed_position_.data(), drag, skin_m_ / 2, dt_s, n_);
        else
            kick_drift_kernel<false><<<blocks(), kThreads>>>(
                position_.data(), half_velocity_.data(), outdated_.data(), velocity_.data(),
                acceleration_.data(), listed_position_.data(), drag, skin_m_ / 2, dt_s, n_);
        CUDA_CHECK(cudaGetLastError());
    }

    /// The one word per step that the host has to see.
    bool list_is_outdated() {
        std::uint32_t outdated = 0;
        CUDA_CHECK(cudaMemcpy(&outdated, outdated_.data(), sizeof outdated, cudaMemcpyDeviceToHost));
        return outdated != 0;
    }

    /// Brings marbles of a cell together in memory, then lists who is near whom. Accelerations and the
    /// velocities of the step before are made anew, so they need not move.
    void make_list() {
        sort_.build(position_.data(), cells_, n_);
        gather(listed_position_, position_);
        CUDA_CHECK(cudaMemcpy(position_.data(), listed_position_.data(), position_.bytes(),
                              cudaMemcpyDeviceToDevice));
        gather(velocity_, half_velocity_);
        std::swap(velocity_, half_velocity_);
        gather(sorted_id_, id_);
        std::swap(id_, sorted_id_);
        list_kernel<<<blocks(), kThreads>>>(neighbour_.data(), neighbour_count_.data(), position_.data(),
                                            sort_.ranges(), cells_, reach_m(), n_);
        CUDA_CHECK(cudaGetLastError());
        CUDA_CHECK(cudaMemset(outdated_.data(), 0, sizeof(std::uint32_t)));
        ++lists_made_;
    }

    template <class T>
    void gather(course::DeviceBuffer<T>& sorted, const course::DeviceBuffer<T>& data) {
        grid::gather_kernel<<<blocks(), kThreads>>>(sorted.data(), data.data(), sort_.order(), n_);
        CUDA_CHECK(cudaGetLastError());
    }
    //! [passes]

    //! [launch_contacts]
    /// A term that the material lacks is not multiplied by zero: it is not in the kernel.
    void launch_contacts(float dt_s) {
        const ContactPass pass{velocity_.data(),
                               acceleration_.data(),
                               position_.data(),
                               half_velocity_.data(),
                               list(),
                               material_,
                               box_,
                               n_};
        const std::uint32_t blocks = this->blocks();
        switch (has_shear() + 2 * has_attraction() + 4 * has_drag()) {
            case 0:
                contact_kernel<false, false, false><<<blocks, kThreads>>>(pass, dt_s);
                break;
            case 1:
                contact_kernel<true, false, false><<<blocks, kThreads>>>(pass, dt_s);
                break;
            case 2:
                contact_kernel<false, true, false><<<blocks, kThreads>>>(pass, dt_s);
                break;
            case 3:
                contact_kernel<true, true, false><<<blocks, kThreads>>>(pass, dt_s);
                break;
            case 4:
                contact_kernel<false, false, true><<<blocks, kThreads>>>(pass, dt_s);
                break;
            case 5:
                contact_kernel<true, false, true><<<blocks, kThreads>>>(pass, dt_s);
                break;
            case 6:
                contact_kernel<false, true, true><<<blocks, kThreads>>>(pass, dt_s);
                break;
            case 7:
                contact_kernel<true, true, true><<<blocks, kThreads>>>(pass, dt_s);
                break;
        }
        CUDA_CHECK(cudaGetLastError());
    }
    //! [launch_contacts]

    Material material_;
    Box box_;
    float skin_m_;
    std::uint32_t n_;
    grid::CellGrid cells_;
    grid::CountingSort sort_;
    course::DeviceBuffer<float4> position_, listed_position_, velocity_, half_velocity_, acceleration_;
    course::DeviceBuffer<std::uint32_t> id_, sorted_id_, neighbour_, neighbour_count_, outdated_;
    std::uint32_t lists_made_ = 0;
};

}  // namespace spring_mass
