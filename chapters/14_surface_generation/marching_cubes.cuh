/// @file
/// Marching cubes on bricks: classify, scan, compact, generate. Vertices are shared: each crossed edge of the
/// lattice has one, and it belongs to the edge's lower node.
#pragma once
#include <cuda_runtime.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "14_surface_generation/bricks.cuh"
#include "14_surface_generation/case_table.h"

namespace surface {

struct MeshSize {
    std::uint32_t vertices = 0, triangles = 0;
};

/// Where a mesh goes, in device memory.
struct MeshOut {
    float4* position;      ///< x, y, z in m, and 1
    float4* normal;        ///< length 1, away from the inside, and 0; nullptr: no normals wanted
    std::uint32_t* index;  ///< three a triangle, counter-clockwise as seen from outside
};

//! [inside]
/// One thread per row of nodes: a bit for each of the eight, set if the node is inside. NaN is not.
inline __global__ void inside_kernel(std::uint8_t* inside, const float* field, float iso,
                                     std::uint32_t rows) {
    const std::uint32_t r = blockIdx.x * blockDim.x + threadIdx.x;
    if (r >= rows) return;
    const float* node = field + std::size_t(r) * kBrick;
    std::uint32_t bits = 0;
#pragma omp simd reduction(| : bits)
    for (int i = 0; i < kBrick; ++i) bits |= (node[i] > iso ? 1u : 0u) << i;
    inside[r] = std::uint8_t(bits);
}
//! [inside]

//! [row_of]
/// Number of the row of nodes (y, z) of brick b, each from 0 to 8, in the brick or `side_x` (0 or 1) bricks
/// further along x. kNone where there is no brick: its nodes are outside.
inline __device__ std::uint32_t row_of(const std::uint32_t* around, std::uint32_t b, int side_x, int y,
                                       int z) {
    const int side_y = y / kBrick, side_z = z / kBrick;
    const std::uint32_t brick = around[kAround * b + (1 + side_x) + 3 * (1 + side_y) + 9 * (1 + side_z)];
    if (brick == kNone) return kNone;
    return brick * kBrickRows + kBrick * (z % kBrick) + y % kBrick;
}

/// Nine bits: the nodes of a row of cells along one of its four long edges.
inline __device__ std::uint32_t nine_nodes(const std::uint8_t* inside, const std::uint32_t* around,
                                           std::uint32_t b, int y, int z) {
    const std::uint32_t row = row_of(around, b, 0, y, z), next = row_of(around, b, 1, y, z);
    std::uint32_t bits = 0;
    if (row != kNone) bits = inside[row];
    if (next != kNone) bits |= (inside[next] & 1u) << kBrick;
    return bits;
}

/// The four long edges of a row of eight cells: at (y, z), (y + 1, z), (y, z + 1), (y + 1, z + 1).
struct CellRow {
    std::uint32_t nodes[4];
};
inline __device__ CellRow cell_row(const std::uint8_t* inside, const std::uint32_t* around, std::uint32_t r) {
    const std::uint32_t b = r / kBrickRows;
    const int y = int(r % kBrick), z = int(r / kBrick % kBrick);
    CellRow row;
    for (int k = 0; k < 4; ++k) row.nodes[k] = nine_nodes(inside, around, b, y + k % 2, z + k / 2);
    return row;
}
/// Which of its 256 cases cell i of the row is.
inline __device__ int case_of(const CellRow& row, int i) {
    int bits = 0;
    for (int k = 0; k < 4; ++k) bits |= int(row.nodes[k] >> i & 3u) << 2 * k;
    return bits;
}
//! [row_of]

//! [classify]
/// One thread per row of cells: does the surface pass through any of them? Most rows are all inside or all
/// outside, and that is four comparisons for eight cells.
inline __global__ void classify_kernel(std::uint32_t* crossed, const std::uint8_t* inside,
                                       const std::uint32_t* around, std::uint32_t rows) {
    const std::uint32_t r = blockIdx.x * blockDim.x + threadIdx.x;
    if (r >= rows) return;
    const CellRow row = cell_row(inside, around, r);
    const std::uint32_t any = row.nodes[0] | row.nodes[1] | row.nodes[2] | row.nodes[3];
    const std::uint32_t all = row.nodes[0] & row.nodes[1] & row.nodes[2] & row.nodes[3];
    crossed[r] = any != 0 && all != (2u << kBrick) - 1;
}
//! [classify]

/// What a crossed row makes. Bits 8 a + i of `edges`: the edge along axis a from node i has a vertex.
struct RowWork {
    std::uint32_t row, edges;
};

//! [count]
/// One thread per crossed row: its edges with a vertex, and how many vertices and triangles it makes.
inline __global__ void count_rows_kernel(RowWork* work, std::uint32_t* vertices, std::uint32_t* triangles,
                                         const std::uint32_t* crossed_rows, const std::uint8_t* inside,
                                         const std::uint32_t* around, const CaseTable* table,
                                         std::uint32_t n) {
    const std::uint32_t k = blockIdx.x * blockDim.x + threadIdx.x;
    if (k >= n) return;
    const CellRow row = cell_row(inside, around, crossed_rows[k]);
    const std::uint32_t own = row.nodes[0];
    // A bit is set where a node and its neighbour along the axis are not on the same side.
    const std::uint32_t edges =
        ((own ^ own >> 1) & 0xff) | ((own ^ row.nodes[1]) & 0xff) << 8 | ((own ^ row.nodes[2]) & 0xff) << 16;
    std::uint32_t count = 0;
    for (int i = 0; i < kBrick; ++i) count += table->triangles[case_of(row, i)];
    work[k] = {crossed_rows[k], edges};
    vertices[k] = __popc(edges);
    triangles[k] = count;
}
//! [count]

//! [vertex_number]
/// Vertices of a row are numbered in the order of its bits, so the number of the one on an edge is the number
/// of bits below: a scan of 24 elements in one instruction.
inline __device__ std::uint32_t vertex_number(std::uint32_t first, std::uint32_t edges, int axis, int i) {
    return first + __popc(edges & ((1u << (kBrick * axis + i)) - 1));
}
//! [vertex_number]

/// Gradient at a node by central differences, in units of the field per spacing.
inline __device__ glm::vec3 gradient(const float* field, const std::uint32_t* around, std::uint32_t b,
                                     glm::ivec3 node) {
    glm::vec3 slope;
    for (int axis = 0; axis < 3; ++axis) {
        glm::ivec3 step(0);
        step[axis] = 1;
        slope[axis] =
            0.5f * (node_value(field, around, b, node + step) - node_value(field, around, b, node - step));
    }
    return slope;
}

//! [crossing]
/// Where the field passes `iso` between two nodes, as a part of the way. It stays a little away from both:
/// where a node has the very value of iso, the vertices of all its edges would meet there and their triangles
/// would have no area. Three points inside three edges of a cube never lie on a line, so now all have one.
constexpr float kNearestToNode = 1.0f / 1024;

inline __host__ __device__ float crossing(float from, float to, float iso) {
    const float part = (iso - from) / (to - from);
    if (!(part > kNearestToNode)) return kNearestToNode;  // also if the field is not a number
    return part < 1 - kNearestToNode ? part : 1 - kNearestToNode;
}
//! [crossing]

//! [vertices]
/// One thread per crossed row: the vertices on its edges, with normals if they are wanted.
template <bool kNormals>
__global__ void vertices_kernel(float4* position, float4* normal, const RowWork* work,
                                const std::uint32_t* first_vertex, const float* field, BrickView bricks,
                                Lattice lattice, float iso, std::uint32_t n) {
    const std::uint32_t k = blockIdx.x * blockDim.x + threadIdx.x;
    if (k >= n) return;
    const std::uint32_t b = work[k].row / kBrickRows;
    const int4 corner = bricks.corner[b];
    std::uint32_t vertex = first_vertex[k];
    for (std::uint32_t edges = work[k].edges; edges != 0; edges &= edges - 1) {  // takes the lowest bit away
        const int bit = __ffs(int(edges)) - 1, axis = bit / kBrick;
        glm::ivec3 node(bit % kBrick, work[k].row % kBrick, work[k].row / kBrick % kBrick), other = node;
        other[axis] += 1;
        const float from = node_value(field, bricks.around, b, node),
                    to = node_value(field, bricks.around, b, other), part = crossing(from, to, iso);
        glm::vec3 place(corner.x + node.x, corner.y + node.y, corner.z + node.z);
        place[axis] += part;
        const glm::vec3 x = lattice.place_m(place);
        position[vertex] = make_float4(x.x, x.y, x.z, 1);
        if constexpr (kNormals) {
            const glm::vec3 slope = (1 - part) * gradient(field, bricks.around, b, node) +
                                    part * gradient(field, bricks.around, b, other);
            const float steepness = glm::length(slope);
            glm::vec3 out(0);
            out[axis] = from > to ? 1.0f : -1.0f;  // where the field is level: along the edge
            if (steepness > 0 && steepness < INFINITY) out = -slope / steepness;
            normal[vertex] = make_float4(out.x, out.y, out.z, 0);
        }
        ++vertex;
    }
}
//! [vertices]

//! [triangles]
/// One thread per crossed row: the triangles of its eight cells. Their corners may belong to seven other
/// rows, which `place` finds in the list of crossed rows.
inline __global__ void triangles_kernel(std::uint32_t* index, const RowWork* work,
                                        const std::uint32_t* first_vertex,
                                        const std::uint32_t* first_triangle, const std::uint32_t* place,
                                        const std::uint8_t* inside, const std::uint32_t* around,
                                        const CaseTable* table, std::uint32_t n) {
    const std::uint32_t k = blockIdx.x * blockDim.x + threadIdx.x;
    if (k >= n) return;
    const std::uint32_t r = work[k].row, b = r / kBrickRows;
    const int y = int(r % kBrick), z = int(r / kBrick % kBrick);
    // Edges and first vertex of the four rows of nodes around the cells, and of those that go on along x.
    std::uint32_t edges[2][4], first[2][4];
    for (int side_x = 0; side_x < 2; ++side_x)
        for (int corner = 0; corner < 4; ++corner) {
            const std::uint32_t row = row_of(around, b, side_x, y + corner % 2, z + corner / 2);
            const std::uint32_t item = row == kNone ? kNone : place[row];
            edges[side_x][corner] = item == kNone ? 0 : work[item].edges;
            first[side_x][corner] = item == kNone ? 0 : first_vertex[item];
        }
    const CellRow row = cell_row(inside, around, r);
    std::uint32_t* out = index + 3 * std::size_t(first_triangle[k]);
    for (int i = 0; i < kBrick; ++i) {
        const int bits = case_of(row, i);
        for (int corner = 0; corner < 3 * table->triangles[bits]; ++corner) {
            const int edge = table->edge[bits][corner], low = lower_corner(edge), x = i + (low & 1);
            *out++ = vertex_number(first[x / kBrick][low >> 1], edges[x / kBrick][low >> 1], edge_axis(edge),
                                   x % kBrick);
        }
    }
}
//! [triangles]

//! [MarchingCubes]
/// The surface where a field on bricks is `iso`. Inside is where it is larger. Memory grows as needed and is
/// kept. @pre no node is inside that misses one of its neighbours, or the surface has a hole there
class MarchingCubes {
  public:
    MarchingCubes() : table_(std::vector<CaseTable>{make_case_table()}) {}

    /// Classify, scan, compact: everything but the mesh itself. Waits for the device, to know the sizes.
    MeshSize count(const float* field, const BrickView& bricks, float iso) {
        size_ = {};
        iso_ = iso;
        const std::uint32_t rows = bricks.count * kBrickRows;
        crossed_count_ = 0;
        if (rows == 0) return size_;
        make_room(inside_, rows);
        inside_kernel<<<blocks_for(rows, kThreads), kThreads>>>(inside_.data(), field, iso, rows);
        CUDA_CHECK(cudaGetLastError());
        classify_kernel<<<blocks_for(rows, kThreads), kThreads>>>(crossed_.resize(rows), inside_.data(),
                                                                  bricks.around, rows);
        CUDA_CHECK(cudaGetLastError());
        crossed_count_ = crossed_.finish();
        if (crossed_count_ == 0) return size_;
        make_room(work_, crossed_count_);
        first_vertex_.resize(crossed_count_);
        first_triangle_.resize(crossed_count_);
        count_rows_kernel<<<blocks_for(crossed_count_, kThreads), kThreads>>>(
            work_.data(), first_vertex_.data(), first_triangle_.data(), crossed_.list(), inside_.data(),
            bricks.around, table_.data(), crossed_count_);
        CUDA_CHECK(cudaGetLastError());
        size_ = {first_vertex_.scan(), first_triangle_.scan()};
        return size_;
    }

    /// Generate: writes the mesh whose size count() gave. @param field, bricks  the same as there
    void write(const MeshOut& out, const float* field, const BrickView& bricks,
               const Lattice& lattice) const {
        if (crossed_count_ == 0) return;
        const std::uint32_t blocks = blocks_for(crossed_count_, kThreads);
        if (out.normal)
            vertices_kernel<true><<<blocks, kThreads>>>(out.position, out.normal, work_.data(),
                                                        first_vertex_.data(), field, bricks, lattice, iso_,
                                                        crossed_count_);
        else
            vertices_kernel<false><<<blocks, kThreads>>>(out.position, nullptr, work_.data(),
                                                         first_vertex_.data(), field, bricks, lattice, iso_,
                                                         crossed_count_);
        CUDA_CHECK(cudaGetLastError());
        triangles_kernel<<<blocks, kThreads>>>(out.index, work_.data(), first_vertex_.data(),
                                               first_triangle_.data(), crossed_.place(), inside_.data(),
                                               bricks.around, table_.data(), crossed_count_);
        CUDA_CHECK(cudaGetLastError());
    }

    /// Rows of the bricks that the surface passes, out of all that were looked at.
    std::uint32_t crossed_rows() const { return crossed_count_; }
    std::size_t bytes() const {
        return table_.bytes() + inside_.bytes() + crossed_.bytes() + work_.bytes() + first_vertex_.bytes() +
               first_triangle_.bytes();
    }

  private:
    course::DeviceBuffer<CaseTable> table_;
    course::DeviceBuffer<std::uint8_t> inside_;
    MarkedList crossed_;
    course::DeviceBuffer<RowWork> work_;
    Offsets first_vertex_, first_triangle_;
    std::uint32_t crossed_count_ = 0;
    MeshSize size_;
    float iso_ = 0;
};
//! [MarchingCubes]

}  // namespace surface
