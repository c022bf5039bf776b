/// @file
/// What a run computes and what it leaves out: the answer to --explain, which tests hold against the truth.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "10_water_sph/run.cuh"
#include "14_surface_generation/device_mesh.cuh"

namespace surface {

/// What becomes of the particles.
enum class Drawing { none, points, spheres, surface };

/// Everything that a run of this chapter's program depends on.
struct Settings {
    sph::Settings water;      ///< its `drawing` says what chapter 10 draws: nothing, if the surface is drawn
    SurfaceSettings surface;  ///< the spacing is the water's
    Drawing drawing = Drawing::surface;
};

using Launches = std::vector<std::pair<std::string, int>>;

//! [launches]
/// Kernels of Surface::build() in their order, for the particles of the last build. (A scan takes a level
/// more when what is scanned gets longer, so the list depends on them.)
inline Launches launches_of_build(const Surface& surface) {
    Launches launches{{"bounds_walk_kernel", 1}};
    if (surface.brick_count() == 0) return launches;
    const auto add = [&](const char* kernel, int count = 1) { launches.push_back({kernel, count}); };
    const auto scan = [&](std::uint32_t n) {
        const int levels = grid::ExclusiveScan::levels(n + 1);  // with the sum at the end
        add("chunk_sums_kernel", levels);
        add("scan_chunks_kernel", levels);
    };
    const auto sort = [&](const CellGrid& cells) {
        add("count_kernel");
        scan(cells.cell_count() + 1);  // with the limbo
        add("scatter_kernel");
        add("sort_cells_kernel");
        add("grid::gather_kernel");
    };
    const bool anisotropic = surface.settings().kind == FieldKind::anisotropic;
    if (anisotropic) {
        sort(surface.blobs().neighbour_cells());
        add("blob_kernel");
    } else {
        add("round_blob_kernel");
    }
    sort(surface.blobs().cells());
    if (anisotropic) add("grid::gather_kernel");  // of the stretches
    const Bricks& bricks = surface.bricks();
    add(surface.settings().sparse ? "mark_regions_kernel" : "mark_all_regions_kernel");
    scan(bricks.region_count());
    add("keep_marked_kernel");
    add(surface.settings().sparse ? "mark_bricks_kernel" : "mark_all_bricks_kernel");
    scan(kRegionBricks * bricks.regions());
    add("keep_marked_kernel");
    add("locate_kernel");
    add("neighbours_kernel");
    add(anisotropic                                         ? "field_kernel<FieldKind::anisotropic>"
        : surface.settings().kind == FieldKind::zhu_bridson ? "field_kernel<FieldKind::zhu_bridson>"
                                                            : "field_kernel<FieldKind::colour>");
    add("inside_kernel");
    add("classify_kernel");
    scan(bricks.count() * kBrickRows);
    add("keep_marked_kernel");
    const std::uint32_t crossed = surface.marching_cubes().crossed_rows();
    if (crossed == 0) return launches;
    add("count_rows_kernel");
    scan(crossed);
    scan(crossed);
    return launches;
}

/// Kernels of Surface::write() after that.
inline Launches launches_of_write(const Surface& surface, Normals normals) {
    if (surface.size().triangles == 0) return {};
    return {{normals == Normals::none ? "vertices_kernel<false>" : "vertices_kernel<true>", 1},
            {"triangles_kernel", 1}};
}
//! [launches]

/// "a, b x 2, c" and how many that are together.
inline std::string list_launches(const Launches& launches) {
    int total = 0;
    std::string text;
    for (const auto& [name, count] : launches) {
        if (count == 0) continue;
        text += (text.empty() ? "" : ", ") + name + (count > 1 ? " x " + std::to_string(count) : "");
        total += count;
    }
    return std::to_string(total) + " kernels: " + text;
}

/// @param surface  built for the start, or nullptr if this run makes none
inline std::string explain(const Settings& settings, const Surface* surface) {
    std::string text = "each time step: chapter 10's\n";
    if (surface) {
        const Normals normals = settings.drawing == Drawing::surface ? Normals::from_field : Normals::none;
        text += "each surface: " + list_launches(launches_of_build(*surface)) + "\n";
        text += "each mesh: " + list_launches(launches_of_write(*surface, normals)) + "\n";
        text += "at the start: " + std::to_string(surface->brick_count()) + " bricks of " +
                std::to_string(kBrickNodes) + " nodes, " + std::to_string(surface->size().vertices) +
                " vertices, " + std::to_string(surface->size().triangles) + " triangles; " +
                std::to_string(surface->bytes()) + " bytes of device memory for all but the mesh\n";
        text += "each vertex: " + std::string(normals == Normals::none ? "16" : "32") +
                " bytes; each triangle: 12 bytes\n";
        if (surface->settings().kind != FieldKind::anisotropic)
            text += "left out: the blobs' stretches, their two arrays and one of two sorts\n";
        if (surface->settings().sparse) text += "left out: bricks that no particle reaches\n";
        if (normals == Normals::none) text += "left out: normals (compiled out of vertices_kernel)\n";
    } else {
        text += "left out: blobs, bricks, field, marching cubes and mesh, with all their arrays\n";
    }
    if (settings.drawing == Drawing::surface) text += "left out: chapter 10's spheres and their buffers\n";
    if (settings.drawing == Drawing::points) text += "left out: lighting and shadows\n";
    if (settings.drawing == Drawing::none) text += "left out: OpenGL, its context and all its objects\n";
    return text;
}

}  // namespace surface
