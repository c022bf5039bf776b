/// @file
/// Particles of chapter 10 on the device, sorted by cell: what a kernel over the grid starts from.
#pragma once
#include <algorithm>
#include <utility>
#include <vector>

#include "10_water_sph/sph.cuh"
#include "common/device_buffer.h"

/// A box so far away that no particle feels its walls.
inline sph::Box far_box(float size_m) {
    return {{-size_m, -size_m, -size_m}, {size_m, size_m, size_m}};
}

/// nx * ny * nz points of spacing 1 m around the origin; i = x + nx (y + ny z).
inline std::vector<float4> unit_lattice(int nx, int ny, int nz) {
    std::vector<float4> points;
    for (int z = 0; z < nz; ++z)
        for (int y = 0; y < ny; ++y)
            for (int x = 0; x < nx; ++x)
                points.push_back(
                    make_float4(x - (nx - 1) * 0.5f, y - (ny - 1) * 0.5f, z - (nz - 1) * 0.5f, 0));
    return points;
}

/// Positions in the order of their cells, with the lesson's density. Other data of the particles is brought
/// into the same order by to_cells(), and results back into the caller's order by from_cells().
class SortedParticles {
  public:
    SortedParticles(const std::vector<float4>& position, const sph::Fluid& fluid, const sph::Box& box)
        : n(std::uint32_t(position.size())),
          cells(grid::make_grid({box.low_m.x, box.low_m.y, box.low_m.z},
                                {box.high_m.x, box.high_m.y, box.high_m.z}, fluid.support_m,
                                grid::max_cells_for(position.size()))),
          sort_(n, cells.cell_count()),
          density_(n) {
        const course::DeviceBuffer<float4> unsorted(position);
        sort_.build(unsorted.data(), cells, n);
        order_.resize(n);
        CUDA_CHECK(
            cudaMemcpy(order_.data(), sort_.order(), n * sizeof(std::uint32_t), cudaMemcpyDeviceToHost));
        position_ = to_cells(position);
        grid::ColumnBuffer columns(n);
        grid::gather_columns_kernel<<<blocks(), kThreads>>>(columns.columns(), unsorted.data(), sort_.order(),
                                                            n);
        CUDA_CHECK(cudaGetLastError());
        course::DeviceBuffer<float> pressure_term(n);
        sph::density_kernel<sph::EquationOfState::linear>
            <<<blocks(), kThreads>>>(density_.data(), pressure_term.data(), std::as_const(columns).columns(),
                                     ranges(), cells, fluid, box, n);
        CUDA_CHECK(cudaGetLastError());
    }

    template <class T>
    course::DeviceBuffer<T> to_cells(const std::vector<T>& values) const {
        std::vector<T> sorted(n);
        for (std::uint32_t place = 0; place < n; ++place) sorted[place] = values[order_[place]];
        return course::DeviceBuffer<T>(sorted);
    }
    template <class T>
    std::vector<T> from_cells(const course::DeviceBuffer<T>& sorted) const {
        const std::vector<T> in_cells = sorted.download();
        std::vector<T> values(n);
        for (std::uint32_t place = 0; place < n; ++place) values[order_[place]] = in_cells[place];
        return values;
    }

    const float4* position() const { return position_.data(); }
    const course::DeviceBuffer<float>& density() const { return density_; }
    grid::CellRanges ranges() const { return sort_.ranges(); }
    std::uint32_t blocks() const { return grid::blocks_for(n, kThreads); }

    static constexpr std::uint32_t kThreads = 128;
    const std::uint32_t n;
    const grid::CellGrid cells;

  private:
    grid::CountingSort sort_;
    course::DeviceBuffer<float4> position_;
    course::DeviceBuffer<float> density_;
    std::vector<std::uint32_t> order_;
};
