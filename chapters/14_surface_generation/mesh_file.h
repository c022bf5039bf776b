/// @file
/// A mesh as a file that Blender, MeshLab and others read: PLY (binary, small) or OBJ (text, readable).
#pragma once
#include <charconv>
#include <cstring>
#include <filesystem>
#include <string>

#include "14_surface_generation/mesh.h"
#include "common/errors.h"
#include "common/files.h"

namespace surface {

/// @throws course::BadInput if a number of the mesh is not one, or an index points nowhere: no program could
/// read that
inline void check_mesh(const Mesh& mesh) {
    const auto finite = [](const float4& v) {
        return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
    };
    for (const auto* list : {&mesh.position, &mesh.normal})
        for (const float4& v : *list)
            if (!finite(v)) throw course::BadInput("the mesh has a vertex that is not a number: not written");
    if (!mesh.normal.empty() && mesh.normal.size() != mesh.position.size())
        throw course::BadInput("the mesh has normals for some of its vertices only: not written");
    for (std::uint32_t i : mesh.index)
        if (i >= mesh.position.size())
            throw course::BadInput("the mesh has a triangle without corners: not written");
}

//! [ply]
/// Polygon File Format, 1.0: a header of text, then numbers as they lie in memory, lowest byte first. The
/// file is complete or not there. @throws course::BadInput if it can't be written
inline void save_ply(const std::filesystem::path& path, const Mesh& mesh) {
    check_mesh(mesh);
    const bool normals = !mesh.normal.empty();
    std::string file =
        "ply\nformat binary_little_endian 1.0\ncomment lengths in m\nelement vertex " +
        std::to_string(mesh.position.size()) + "\nproperty float x\nproperty float y\nproperty float z\n" +
        (normals ? "property float nx\nproperty float ny\nproperty float nz\n" : "") + "element face " +
        std::to_string(mesh.triangles()) + "\nproperty list uchar uint vertex_indices\nend_header\n";
    const auto add = [&file](const void* bytes, std::size_t count) {
        file.append(static_cast<const char*>(bytes), count);
    };
    for (std::size_t i = 0; i < mesh.position.size(); ++i) {
        add(&mesh.position[i], 3 * sizeof(float));
        if (normals) add(&mesh.normal[i], 3 * sizeof(float));
    }
    for (std::size_t t = 0; t < mesh.triangles(); ++t) {
        file += char(3);  // corners of this face
        add(&mesh.index[3 * t], 3 * sizeof(std::uint32_t));
    }
    course::write_file(path, file);
}
//! [ply]

//! [obj]
/// Wavefront OBJ: a line a vertex, a normal, a face. Faces count from 1.
inline void save_obj(const std::filesystem::path& path, const Mesh& mesh) {
    check_mesh(mesh);
    std::string file = "# lengths in m\n";
    const auto add_vector = [&file](const char* what, const float4& v) {
        file += what;
        for (const float x : {v.x, v.y, v.z}) {
            char digits[32];  // the shortest that reads back as the same float, in any language's notation
            const auto end = std::to_chars(digits, digits + sizeof digits, x).ptr;
            file += ' ';
            file.append(digits, end);
        }
        file += '\n';
    };
    for (const float4& v : mesh.position) add_vector("v", v);
    for (const float4& v : mesh.normal) add_vector("vn", v);
    for (std::size_t t = 0; t < mesh.triangles(); ++t) {
        file += 'f';
        for (int k = 0; k < 3; ++k) {
            const std::string number = std::to_string(mesh.index[3 * t + k] + 1ull);
            file += ' ' + number + (mesh.normal.empty() ? "" : "//" + number);
        }
        file += '\n';
    }
    course::write_file(path, file);
}
//! [obj]

}  // namespace surface
