/// @file
/// What this chapter measures: `--study NAME`.
#pragma once
#include <random>

#include "14_surface_generation/errors_of_ball.h"
#include "14_surface_generation/known_fields.cuh"
#include "14_surface_generation/surface_cpu.h"
#include "common/gpu_timer.h"
#include "common/program.h"
#include "common/study.h"

namespace surface {

/// Time of a build and of the mesh that follows.
template <class Maker, class Build>
course::Timing time_surface(int repeats, Maker& maker, DeviceMesh& mesh, Build build) {
    return course::time_work(repeats, [&] {
        build();
        mesh.take(maker);
        CUDA_CHECK(cudaDeviceSynchronize());
    });
}

// ------------------------------------------------------------------------------------- marching cubes alone

//! [study_ball]
/// A field that is known exactly: what is left is the error of marching cubes.
inline void study_ball(course::Study& study) {
    course::on_device(study);
    const std::vector<int> sizes =
        study.quick ? std::vector<int>{17, 33, 65, 97} : std::vector<int>{17, 25, 33, 49, 65, 97, 129, 193};
    study.expect(int(7 * sizes.size()));
    const CaseTable table = make_case_table();
    for (const int n : sizes) {
        const glm::vec3 centre{0.0123f, 0.0371f, -0.0217f};
        KnownField field = known_ball(n, BallField::distance, centre);
        DenseField dense{glm::ivec3(n), glm::vec3(-1.5f), 3 / float(n - 1), {}};
        for (int k = 0; k < n * n * n; ++k)
            dense.value.push_back(
                1 -
                glm::length(dense.origin_m + dense.spacing_m * glm::vec3(item_of(k, dense.nodes)) - centre));
        const int repeats = study.quick ? 5 : 15;
        DeviceMesh plain(Normals::none), with_normals;
        const course::Timing kernels = time_surface(repeats, field, plain, [&] { field.build(); });
        const course::Timing normals = time_surface(repeats, field, with_normals, [&] { field.build(); });
        const course::Timing serial = course::time_work(repeats, [&] { cubes_cpu(dense, 0, table); });
        const BallErrors errors = errors_of_ball(with_normals.download(), centre, 1);
        const BallErrors serial_errors = errors_of_ball(cubes_cpu(dense, 0, table), centre, 1);
        const double cells = std::pow(n - 1.0, 3);
        study.add({"area, serial", double(n), cells, serial_errors.area, serial});
        study.add({"area, four kernels", double(n), cells, errors.area, kernels});
        study.add({"volume, serial", double(n), cells, serial_errors.volume, serial});
        study.add({"volume, four kernels", double(n), cells, errors.volume, kernels});
        study.add({"Hausdorff, serial", double(n), cells, serial_errors.hausdorff, serial});
        study.add({"Hausdorff, four kernels", double(n), cells, errors.hausdorff, kernels});
        study.add({"normals, four kernels", double(n), cells, errors.normal, normals});
    }
}
//! [study_ball]

// ------------------------------------------------------------------------------------- from particles

/// A ball of particles, each moved by up to a fifth of the spacing, as water at rest has it.
inline std::vector<float4> particle_ball(double radius_m, double spacing_m) {
    std::mt19937 random(14);
    std::uniform_real_distribution<double> shift(-0.2 * spacing_m, 0.2 * spacing_m);
    std::vector<float4> position;
    const int reach = int(radius_m / spacing_m) + 1;
    for (int z = -reach; z < reach; ++z)
        for (int y = -reach; y < reach; ++y)
            for (int x = -reach; x < reach; ++x) {
                const glm::dvec3 at = spacing_m * (glm::dvec3(x, y, z) + 0.5);
                if (glm::length(at) > radius_m) continue;
                const double dx = shift(random), dy = shift(random), dz = shift(random);
                position.push_back(make_float4(float(at.x + dx), float(at.y + dy), float(at.z + dz), 0));
            }
    return position;
}

inline const char* name_of(FieldKind kind) {
    return kind == FieldKind::colour        ? "colour field"
           : kind == FieldKind::zhu_bridson ? "Zhu and Bridson"
                                            : "anisotropic";
}
constexpr FieldKind kAllKinds[] = {FieldKind::colour, FieldKind::zhu_bridson, FieldKind::anisotropic};

//! [study_field]
/// A ball of water: what is left when marching cubes has no error any more is the error of the field.
inline void study_field(course::Study& study) {
    course::on_device(study);
    const std::vector<float> resolutions =
        study.quick ? std::vector<float>{0.5f, 1, 2} : std::vector<float>{0.5f, 0.75f, 1, 1.5f, 2, 3, 4};
    study.expect(int(3 * 4 * resolutions.size()));
    const double radius_m = 0.25, spacing_m = 0.02;
    const std::vector<float4> position = particle_ball(radius_m, spacing_m);
    const course::DeviceBuffer<float4> particles(position);
    for (const FieldKind kind : kAllKinds)
        for (const float resolution : resolutions) {
            SurfaceSettings settings;
            settings.kind = kind;
            settings.particle_spacing_m = float(spacing_m);
            settings.nodes_per_spacing = resolution;
            Surface surface(settings);
            DeviceMesh mesh;
            const course::Timing time = time_surface(study.quick ? 3 : 7, surface, mesh, [&] {
                surface.build(particles.data(), std::uint32_t(position.size()));
            });
            const BallErrors errors = errors_of_ball(mesh.download(), glm::dvec3(0), radius_m);
            const double n = double(position.size());
            const std::string method = std::string(", ") + name_of(kind);
            study.add({"area" + method, resolution, n, errors.area, time});
            study.add({"volume" + method, resolution, n, errors.volume, time});
            study.add({"Hausdorff" + method, resolution, n, errors.hausdorff, time});
            study.add({"normals" + method, resolution, n, errors.normal, time});
        }
}
//! [study_field]

// ------------------------------------------------------------------------------------------ what it costs

//! [study_box]
/// Two balls of water that move apart. The box around them grows, their surface does not.
inline void study_box(course::Study& study) {
    course::on_device(study);
    const std::vector<double> distances = study.quick
                                              ? std::vector<double>{0.1, 0.4, 1.6}
                                              : std::vector<double>{0.1, 0.2, 0.4, 0.8, 1.6, 3.2, 6.4};
    const double dense_end = study.quick ? 0.5 : 1;  // beyond, the dense grid takes seconds
    study.expect(int(distances.size()) + 2);
    const std::vector<float4> ball = particle_ball(0.1, 0.02);
    double answer_m2 = 0;
    for (const double distance_m : distances) {
        std::vector<float4> position = ball;
        for (float4 p : ball) {  // apart along all three axes
            p.x += float(distance_m + 0.2);
            p.y += float(distance_m);
            p.z += float(distance_m);
            position.push_back(p);
        }
        const course::DeviceBuffer<float4> particles(position);
        for (const bool sparse : {true, false}) {
            if (!sparse && distance_m > dense_end) continue;
            SurfaceSettings settings;
            settings.kind = FieldKind::colour;
            settings.sparse = sparse;
            Surface surface(settings);
            DeviceMesh mesh;
            const course::Timing time = time_surface(study.quick ? 3 : 9, surface, mesh, [&] {
                surface.build(particles.data(), std::uint32_t(position.size()));
            });
            const double area_m2 = measure(mesh.download()).area_m2;
            if (answer_m2 == 0) answer_m2 = area_m2;
            const glm::dvec3 nodes = glm::dvec3(surface.bricks().lattice().bricks) * double(kBrick);
            study.add({sparse ? "sparse" : "dense", nodes.x * nodes.y * nodes.z, double(position.size()),
                       std::fabs(area_m2 / answer_m2 - 1), time});
        }
    }
}
//! [study_box]

/// A cube of more and more particles, at the resolution the program uses.
inline void study_size(course::Study& study) {
    course::on_device(study);
    const std::vector<int> edges =
        study.quick ? std::vector<int>{8, 16, 24} : std::vector<int>{8, 12, 16, 24, 32, 48};
    study.expect(int(3 * edges.size()));
    for (const FieldKind kind : kAllKinds)
        for (const int edge : edges) {
            std::vector<float4> position;
            for (int k = 0; k < edge * edge * edge; ++k) {
                const glm::vec3 p = 0.02f * (glm::vec3(item_of(k, glm::ivec3(edge))) + 0.5f);
                position.push_back(make_float4(p.x, p.y, p.z, 0));
            }
            const course::DeviceBuffer<float4> particles(position);
            SurfaceSettings settings;
            settings.kind = kind;
            Surface surface(settings);
            DeviceMesh mesh;
            const course::Timing time = time_surface(study.quick ? 3 : 7, surface, mesh, [&] {
                surface.build(particles.data(), std::uint32_t(position.size()));
            });
            const double volume_m3 = std::pow(0.02 * edge, 3);
            study.add({name_of(kind), double(position.size()), double(position.size()),
                       std::fabs(measure(mesh.download()).volume_m3 / volume_m3 - 1), time});
        }
}

inline void declare_studies(course::Program& program) {
    program.study({"ball", "How exact is marching cubes, and what do its four kernels cost?",
                   "area, volume, distance: relative; normals: rms angle (radians)", "nodes",
                   course::StudyPlot::error_against_time, true},
                  study_ball);
    program.study({"field", "Which field finds the ball that the particles fill, at which resolution?",
                   "area, volume, distance: relative; normals: rms angle (radians)", "nodes_per_spacing",
                   course::StudyPlot::error_against_time, true},
                  study_field);
    program.study({"box", "What does a larger box cost, if the water in it stays the same?",
                   "area: relative difference from that of the smallest box", "nodes_in_box",
                   course::StudyPlot::time_against_value, false, true},
                  study_box);
    program.study({"size", "What does more water cost?", "volume: relative", "particles",
                   course::StudyPlot::time_against_value, false, true},
                  study_size);
}

}  // namespace surface
