// Chapter 10: the grid and the sorted passes against somebody else's program. LAMMPS has an SPH of its own
// (pair style sph/taitwater); here its pair terms run over this course's cells, and must give its numbers.
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "05_spatial_grid/counting_sort.cuh"
#include "common/device_buffer.h"
#include "tests/support/course_test.h"

namespace {

template <class T>
using Vec = glm::vec<3, T>;

// The scene: pair_coeff * * 1.0 100 0.1 2.6, walls of fix wall/harmonic, gravity 1 along -z, mass 1.
constexpr double kRestDensity = 1, kSoundSpeed = 100, kViscosity = 0.1, kSupport = 2.6;
constexpr double kWallStiffness = 2 * 1000, kWallReach = 0.5, kStep = 0.0025;
constexpr double kWidthX = 16, kWidthY = 8;  // walls at 0 and there; along z only at 0
constexpr double kPi = 3.14159265358979323846;

/// p / rho^2, by Tait's equation with an exponent of 7.
template <class T>
__device__ T pressure_term(T rho) {
    const T ratio = rho / T(kRestDensity), cube = ratio * ratio * ratio;
    const T stiffness = T(kSoundSpeed * kSoundSpeed * kRestDensity / 7);
    return stiffness * (cube * cube * ratio - T(1)) / (rho * rho);
}

template <class T>
__device__ T wall_push(T distance) {
    return distance < T(kWallReach) ? T(kWallStiffness) * (T(kWallReach) - distance) : T(0);
}

/// One thread per particle, particles sorted by cell: the force on it and the rate of its density, by
/// LAMMPS's pair terms (Lucy's kernel; viscosity of Monaghan for pairs that approach), walls and gravity.
template <class T>
__global__ void pair_kernel(Vec<T>* force, T* density_rate, const Vec<T>* position, const Vec<T>* velocity,
                            const T* density, grid::CellRanges ranges, grid::CellGrid cells,
                            std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const Vec<T> x = position[i];
    const T h = T(kSupport), own_term = pressure_term(density[i]);
    Vec<T> f(wall_push(x.x) - wall_push(T(kWidthX) - x.x), wall_push(x.y) - wall_push(T(kWidthY) - x.y),
             wall_push(x.z) - T(1));
    T rate = 0;
    grid::for_each_row(cells, glm::vec3(x), [&](std::uint32_t first_cell, std::uint32_t last_cell) {
        for (std::uint32_t k = ranges.cell_first[first_cell]; k < ranges.cell_last[last_cell]; ++k) {
            const Vec<T> d = x - position[k], v = velocity[i] - velocity[k];
            const T r = sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
            if (k == i || !(r < h)) continue;
            // dW/dr / r of Lucy's kernel.
            const T slope = T(-315 / (4 * kPi)) * (h - r) * (h - r) / (h * h * h * h * h * h * h);
            const T approach = v.x * d.x + v.y * d.y + v.z * d.z;
            const T drag = approach < 0 ? -T(kViscosity) * T(2 * kSoundSpeed) * h * approach /
                                              (r * r + T(0.01) * h * h) / (density[i] + density[k])
                                        : T(0);
            f -= (own_term + pressure_term(density[k]) + drag) * slope * d;
            rate += approach * slope;
        }
    });
    force[i] = f;
    density_rate[i] = rate;
}

/// One thread per particle: half a kick of velocity and density, the velocity a whole step ahead for the
/// terms that depend on it, and the drift.
template <class T>
__global__ void first_half_kernel(Vec<T>* position, Vec<T>* velocity, Vec<T>* velocity_ahead, T* density,
                                  const Vec<T>* force, const T* density_rate, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    const T dt = T(kStep), half = T(0.5) * dt;
    density[i] += half * density_rate[i];
    velocity_ahead[i] = velocity[i] + dt * force[i];
    velocity[i] += half * force[i];
    position[i] += dt * velocity[i];
}

template <class T>
__global__ void second_half_kernel(Vec<T>* velocity, T* density, const Vec<T>* force, const T* density_rate,
                                   std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    velocity[i] += T(0.5 * kStep) * force[i];
    density[i] += T(0.5 * kStep) * density_rate[i];
}

/// One thread per particle: the place as the grid takes it.
template <class T>
__global__ void to_float4_kernel(float4* coarse, const Vec<T>* position, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i < n) coarse[i] = make_float4(float(position[i].x), float(position[i].y), float(position[i].z), 0);
}

/// What a file of tests/data/10_water_sph holds, a line a particle: x y z vx vy vz [fx fy fz] rho [drho].
struct State {
    std::vector<Vec<double>> position, velocity, force;
    std::vector<double> density, density_rate;
};

State read_state(const std::string& name) {
    std::ifstream file(std::string(COURSE_DATA_DIR) + "/10_water_sph/" + name);
    State state;
    std::string line;
    std::getline(file, line);  // the names of the columns
    const bool with_forces = line.find("fx") != std::string::npos;
    while (std::getline(file, line)) {
        std::istringstream numbers(line);
        const auto triple = [&numbers] {
            Vec<double> v;
            numbers >> v.x >> v.y >> v.z;
            return v;
        };
        double value;
        state.position.push_back(triple());
        state.velocity.push_back(triple());
        if (with_forces) state.force.push_back(triple());
        numbers >> value;
        state.density.push_back(value);
        if (with_forces) {
            numbers >> value;
            state.density_rate.push_back(value);
        }
        REQUIRE(!numbers.fail());
    }
    REQUIRE(state.position.size() == 512);
    return state;
}

/// That water, in single or double precision, over chapter 05's counting sort and rows of cells.
template <class T>
class TaitWater {
  public:
    explicit TaitWater(const State& start)
        : n_(std::uint32_t(start.position.size())),
          cells_(
              grid::make_grid({0, 0, 0}, {kWidthX, kWidthY, 16}, float(kSupport), grid::max_cells_for(n_))),
          sort_(n_, cells_.cell_count()),
          coarse_(n_),
          position_(as<Vec<T>>(start.position)),
          velocity_(as<Vec<T>>(start.velocity)),
          velocity_ahead_(as<Vec<T>>(start.velocity)),
          force_(n_),
          density_(as<T>(start.density)),
          density_rate_(n_),
          id_(n_) {
        std::vector<std::uint32_t> ids(n_);
        for (std::uint32_t i = 0; i < n_; ++i) ids[i] = i;
        id_.upload(ids);
        compute();
    }

    void step() {
        first_half_kernel<T><<<blocks(), kThreads>>>(position_.data(), velocity_.data(),
                                                     velocity_ahead_.data(), density_.data(), force_.data(),
                                                     density_rate_.data(), n_);
        CUDA_CHECK(cudaGetLastError());
        compute();
        second_half_kernel<T><<<blocks(), kThreads>>>(velocity_.data(), density_.data(), force_.data(),
                                                      density_rate_.data(), n_);
        CUDA_CHECK(cudaGetLastError());
    }

    State state() const {
        return {by_id<Vec<double>>(position_), by_id<Vec<double>>(velocity_), by_id<Vec<double>>(force_),
                by_id<double>(density_), by_id<double>(density_rate_)};
    }

  private:
    static constexpr std::uint32_t kThreads = 128;
    std::uint32_t blocks() const { return grid::blocks_for(n_, kThreads); }

    template <class To, class From>
    static std::vector<To> as(const std::vector<From>& values) {
        return std::vector<To>(values.begin(), values.end());
    }

    void compute() {
        to_float4_kernel<T><<<blocks(), kThreads>>>(coarse_.data(), position_.data(), n_);
        CUDA_CHECK(cudaGetLastError());
        sort_.build(coarse_.data(), cells_, n_);
        gather(position_);
        gather(velocity_);
        gather(velocity_ahead_);
        gather(density_);
        gather(id_);
        pair_kernel<T><<<blocks(), kThreads>>>(force_.data(), density_rate_.data(), position_.data(),
                                               velocity_ahead_.data(), density_.data(), sort_.ranges(),
                                               cells_, n_);
        CUDA_CHECK(cudaGetLastError());
    }

    template <class V>
    void gather(course::DeviceBuffer<V>& values) {
        course::DeviceBuffer<V> sorted(n_);
        grid::gather_kernel<<<blocks(), kThreads>>>(sorted.data(), values.data(), sort_.order(), n_);
        CUDA_CHECK(cudaGetLastError());
        std::swap(values, sorted);
    }

    template <class To, class From>
    std::vector<To> by_id(const course::DeviceBuffer<From>& buffer) const {
        const std::vector<From> values = buffer.download();
        const std::vector<std::uint32_t> ids = id_.download();
        std::vector<To> sorted(n_);
        for (std::uint32_t k = 0; k < n_; ++k) sorted[ids[k]] = To(values[k]);
        return sorted;
    }

    std::uint32_t n_;
    grid::CellGrid cells_;
    grid::CountingSort sort_;
    course::DeviceBuffer<float4> coarse_;
    course::DeviceBuffer<Vec<T>> position_, velocity_, velocity_ahead_, force_;
    course::DeviceBuffer<T> density_, density_rate_;
    course::DeviceBuffer<std::uint32_t> id_;
};

}  // namespace

TEST_CASE("LAMMPS's forces: the sums over the grid are those of another program") {
    const State expected = read_state("sph_step_0.txt");
    const State fine = TaitWater<double>(expected).state(), coarse = TaitWater<float>(expected).state();
    // The file has 12 digits: 5e-12 of values up to 40.
    course::check_close(fine.force, expected.force, {1e-10}, "force in double");
    course::check_close(fine.density_rate, expected.density_rate, {1e-11}, "density rate in double");
    // fp32: a coordinate near 16 is rounded by 5e-7, and a wall multiplies that by 2000.
    course::check_close(coarse.force, expected.force, {2e-3}, "force in float");
    // Rounded coordinates and velocities: 80 terms of 0.1, each off by a few 1e-7.
    course::check_close(coarse.density_rate, expected.density_rate, {1e-6}, "density rate in float");
}

TEST_CASE("LAMMPS's trajectory: 200 steps of its water, in double and in float") {
    const State start = read_state("sph_step_0.txt");
    TaitWater<double> fine(start);
    TaitWater<float> coarse(start);
    int step = 0;
    for (const int until : {50, 200}) {
        for (; step < until; ++step) {
            fine.step();
            coarse.step();
        }
        const State expected = read_state("sph_step_" + std::to_string(until) + ".txt");
        const State f = fine.state(), c = coarse.state();
        // In double, what is left is the file's rounding to 12 digits: 5e-12 of coordinates from 10 to 16.
        course::check_close(f.position, expected.position, {1e-11}, "position in double");
        course::check_close(f.velocity, expected.velocity, {1e-11}, "velocity in double");
        course::check_close(f.density, expected.density, {1e-11}, "density in double");
        // In float, coordinates near 16 are rounded by 5e-7, and so a wall's push by 1e-3. That acceleration
        // over the whole time t = 0.0025 until moves a particle by 1e-3 t^2 / 2 and changes its velocity by
        // 1e-3 t. Density follows the velocity: some 80 neighbours, each with up to 0.1 of the difference.
        const double t = kStep * until;
        course::check_close(c.position, expected.position, {1e-3 * t * t / 2}, "position in float");
        course::check_close(c.velocity, expected.velocity, {1e-3 * t}, "velocity in float");
        course::check_close(c.density, expected.density, {1e-3 * t * t}, "density in float");
    }
}
