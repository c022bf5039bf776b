/// @file
/// What this chapter measures: the time of each method against the number of particles, and against crowding.
#pragma once
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <vector>

#include "05_spatial_grid/crowding.cuh"
#include "common/gpu_timer.h"
#include "common/study.h"

namespace grid {

/// Seconds of one call of `work`, by the host's clock: from the first launch until the device is done. Short
/// work is done several times in a row.
template <class Work>
course::Timing time_on_device(const course::Study& study, std::uint32_t n, Work&& work) {
    const int batch = std::max(1, int((1u << 14) / n));
    return course::time_work(study.quick ? 5 : 7,
                             [&] {
                                 for (int k = 0; k < batch; ++k) work();
                                 CUDA_CHECK(cudaDeviceSynchronize());
                             })
        .per(batch);
}

/// Processor time of one call, in ns per particle, median of five: all threads of the simulator together. It
/// hardly depends on what else the machine does, as seconds by the clock do.
template <class Work>
double processor_ns(std::uint32_t n, Work&& work) {
    std::vector<double> seconds;
    for (int k = 0; k < 5; ++k) {
        const std::clock_t before = std::clock();
        work();
        CUDA_CHECK(cudaDeviceSynchronize());
        seconds.push_back(double(std::clock() - before) / CLOCKS_PER_SEC);
    }
    return 1e9 * course::timing_of(seconds).median_s / n;
}

//! [add_methods]
/// Two rows of each method, its build (the bounds included, since particles move) and its query; brute force
/// builds nothing. Error: particles whose number of neighbours is not brute force's.
/// @param value  of the study's parameter
inline void add_methods(course::Study& study, Cloud& cloud, double value) {
    const std::uint32_t n = cloud.n, asked = asked_of_brute_force(n);
    std::vector<std::uint32_t> reference;
    for (const Method& method : methods(cloud)) {
        const bool brute_force = reference.empty();
        method.build();
        method.query();
        if (brute_force) reference = method.counts();
        const double wrong = different_counts(method.counts(), reference);
        const course::Timing query = time_on_device(study, n, method.query);
        if (brute_force) {  // asked for some only: scaled to all
            study.add({method.name, value, double(n), wrong, query.per(double(asked) / n)});
            continue;
        }
        const auto find_and_build = [&] {
            find_bounds(cloud.position.data(), n);
            method.build();
        };
        const course::Timing build = time_on_device(study, n, find_and_build);
        if (n > 1u << 14 && study.backend == "simulator") {
            std::printf("%u particles, %s: build %.0f, query %.0f ns of processor time each\n", n,
                        method.name.c_str(), processor_ns(n, find_and_build), processor_ns(n, method.query));
            std::fflush(stdout);
        }
        study.add({method.name + ": build", value, double(n), wrong, build});
        study.add({method.name + ": query", value, double(n), wrong, query});
    }
}
//! [add_methods]

constexpr int kRowsPerCloud = 9;

inline void study_neighbours(course::Study& study) {
    course::on_device(study);
    std::vector<std::uint32_t> sizes{1u << 10, 1u << 12, 1u << 14};
    if (!study.quick) sizes.insert(sizes.end(), {1u << 16, 1u << 17, 1u << 18});
    if (study.backend == "cuda") sizes.push_back(1u << 20);
    study.expect(int(sizes.size()) * kRowsPerCloud);
    for (const std::uint32_t n : sizes) {
        Cloud cloud(random_cloud(n, 1), radius_for_30(n));
        add_methods(study, cloud, n);
    }
}

inline void study_occupancy(course::Study& study) {
    course::on_device(study);
    const std::uint32_t n = study.quick ? 1u << 12 : 1u << 14;
    const float radius_m = radius_for_30(n);
    const std::vector<Crowd> all = crowds(n, 1, radius_m);
    study.expect(int(all.size()) * kRowsPerCloud);
    for (const Crowd& crowd : all) {
        Cloud cloud(crowd.position, radius_m);
        add_methods(study, cloud, crowding_of(crowd.position, cloud.cells, {}).fullest);
    }
}

}  // namespace grid
