// Chapter 14: the case table against its rule, marching cubes against known surfaces and random fields, the
// field against its sums.
#include <cmath>
#include <cstring>
#include <map>
#include <random>
#include <set>

#include "14_surface_generation/known_fields.cuh"
#include "14_surface_generation/surface_cpu.h"
#include "tests/support/course_test.h"
#ifdef __CUDASIM__
#include "common/cudasim/cudasim.h"
#endif

namespace {

using namespace surface;

constexpr double kPi = 3.14159265358979323846;

void check_sound(const Mesh& mesh) {
    const Soundness s = inspect(mesh);
    CHECK(s.bad_indices == 0);
    CHECK(s.unpaired_edges == 0);
    CHECK(s.degenerate_triangles == 0);
    CHECK(s.duplicate_triangles == 0);
    CHECK(s.unused_vertices == 0);
    CHECK(s.pinched_vertices == 0);
}

/// A field of random numbers on n^3 nodes, the rim outside.
template <class Random>
KnownField random_field(int n, Random random) {
    return KnownField(glm::ivec3(n), glm::vec3(0), 1, 0, [&](glm::ivec3 node, glm::vec3) {
        const float value = random();
        bool rim = false;
        for (int axis = 0; axis < 3; ++axis) rim = rim || node[axis] == 0 || node[axis] == n - 1;
        return rim ? -1.0f : value;
    });
}

std::vector<float4> cloud(std::uint32_t n, std::uint32_t seed, float size_m = 0.2f) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> at(0, size_m);
    std::vector<float4> position;
    for (std::uint32_t i = 0; i < n; ++i) {
        const float x = at(random), y = at(random), z = at(random);
        position.push_back(make_float4(x, y, z, 0));
    }
    return position;
}

const FieldKind kKinds[] = {FieldKind::colour, FieldKind::zhu_bridson, FieldKind::anisotropic};

SurfaceSettings settings_of(FieldKind kind, float spacing_m = 0.02f) {
    SurfaceSettings settings;
    settings.kind = kind;
    settings.particle_spacing_m = spacing_m;
    return settings;
}

}  // namespace

// ------------------------------------------------------------------------------------------- the case table

TEST_CASE("each case uses exactly its crossed edges, in closed outlines") {
    const CaseTable table = make_case_table();
    for (int inside = 0; inside < 256; ++inside) {
        CAPTURE(inside);
        std::set<int> crossed, used;
        for (int e = 0; e < kEdges; ++e) {
            const int low = lower_corner(e), high = low | 1 << edge_axis(e);
            CHECK(edge_between(low, high) == e);
            if ((inside >> low & 1) != (inside >> high & 1)) crossed.insert(e);
        }
        // Inner sides of triangles pair up; what is left over lies in the faces and is the outline.
        std::map<std::pair<int, int>, int> sides;
        for (int t = 0; t < table.triangles[inside]; ++t)
            for (int k = 0; k < 3; ++k) {
                const int a = table.edge[inside][3 * t + k], b = table.edge[inside][3 * t + (k + 1) % 3];
                used.insert(a);
                CHECK(a != b);
                ++sides[{a, b}];
            }
        CHECK(used == crossed);
        const Outline outline = outline_of(inside);
        for (const auto& [side, count] : sides) {
            CHECK(count == 1);
            const bool inner = sides.count({side.second, side.first}) > 0;
            if (inner)
                CHECK(!share_face(side.first, side.second));
            else
                CHECK(outline[side.first] == side.second);
        }
    }
    CHECK(table.triangles[0] == 0);
    CHECK(table.triangles[255] == 0);
}

TEST_CASE("neighbouring cells draw the same lines on the face they share") {
    int disagreeing = 0;
    // All pairs of cells side by side along x: 4 corners of their own each, 4 in common.
    for (int left = 0; left < 256; ++left)
        for (int own = 0; own < 16; ++own) {
            // Corners with x = 1 of the left cell are those with x = 0 of the right one.
            int right = 0;
            for (int c = 0; c < 8; c += 2)
                right |= (left >> (c + 1) & 1) << c | (own >> c / 2 & 1) << (c + 1);
            const auto lines = [](int inside, int face) {
                std::set<std::pair<int, int>> found;
                const Outline next = outline_of(inside);
                for (int e = 0; e < kEdges; ++e) {
                    const auto on_face = [&](int edge) {
                        return edge_axis(edge) != 0 && (lower_corner(edge) & 1) == face;
                    };
                    // The edge's place on the face, whichever side of the cell that is.
                    const auto place = [](int edge) {
                        return edge_axis(edge) * 8 + (lower_corner(edge) & 6);
                    };
                    if (next[e] < 0 || !on_face(e) || !on_face(next[e])) continue;
                    found.insert({place(e), place(next[e])});
                }
                return found;
            };
            std::set<std::pair<int, int>> back;
            for (const auto& [a, b] : lines(right, 0)) back.insert({b, a});
            disagreeing += lines(left, 1) != back;
        }
    CHECK(disagreeing == 0);
}

TEST_CASE("ambiguous face: inside corners are always separated, whatever the saddle says") {
    // tests/data/README.md, 7_marching_cubes face_ambiguity: two corners across a face are +1, the others
    // have this value; the bilinear field connects the +1 corners if its saddle is positive.
    struct Face {
        float other, saddle;
    };
    for (const Face& f : {Face{-0.5f, 0.25f}, Face{-0.9f, 0.05f}, Face{-1.1f, -0.05f}, Face{-2.0f, -0.5f}}) {
        CAPTURE(f.other);
        CHECK((1.0f + f.other) / 2 == doctest::Approx(f.saddle));
        // The face is z = 3 in the middle of the box; everything else is outside.
        KnownField field(glm::ivec3(8), glm::vec3(0), 1, 0, [&](glm::ivec3 n, glm::vec3) {
            if (n.z != 3 || n.x < 3 || n.x > 4 || n.y < 3 || n.y > 4) return -2.0f;
            return n.x == n.y ? 1.0f : f.other;
        });
        const Mesh mesh = field.mesh();
        check_sound(mesh);
        // Right for the last two; for the first two the table is wrong, and always in the same way.
        CHECK(inspect(mesh).parts == 2);
    }
}

TEST_CASE("interior ambiguity: case 4 has no tunnel, right up to A = 3") {
    // tests/data/README.md, 7_marching_cubes interior_ambiguity_case4: corners (0,0,0) and (1,1,1) of a cell
    // have the value A, the other six -1. The trilinear field connects the two inside for A > 3.
    for (const float a : {1.0f, 2.0f, 2.9f, 3.1f, 4.0f, 10.0f}) {
        CAPTURE(a);
        KnownField field(glm::ivec3(8), glm::vec3(0), 1, 0, [&](glm::ivec3 n, glm::vec3) {
            return n == glm::ivec3(3) || n == glm::ivec3(4) ? a : -1.0f;
        });
        const Mesh mesh = field.mesh();
        check_sound(mesh);
        const Soundness s = inspect(mesh);
        const std::size_t trilinear_parts = a > 3 ? 1 : 2;
        CHECK(s.parts == 2);                           // what this table says...
        if (a < 3) CHECK(s.parts == trilinear_parts);  // ...and where that is right
        CHECK(s.euler == 4);                           // two balls
    }
}

// --------------------------------------------------------------------------------------- known surfaces

TEST_CASE("ball: area, volume, topology and normals as the reference meshes have them") {
    // tests/data/README.md, 7_marching_cubes sphere_torus_convergence. Errors are -0.313 h^2 and -0.593 h^2
    // of area and volume for a distance field, -0.417 and -0.750 for a quadratic one, each within 5 % there.
    double normal_error[2] = {}, last_area[2] = {};
    for (const BallField kind : {BallField::distance, BallField::quadratic})
        for (const int n : {33, 65}) {
            CAPTURE(n);
            const bool quadratic = kind == BallField::quadratic;
            KnownField field = known_ball(n, kind);
            const Mesh mesh = field.mesh();
            const double h = 3.0 / (n - 1), area = 4 * kPi, volume = 4 * kPi / 3;
            const Measures m = measure(mesh);
            const double area_error = (m.area_m2 / area - 1) / (h * h),
                         volume_error = (m.volume_m3 / volume - 1) / (h * h);
            CHECK(area_error == doctest::Approx(quadratic ? -0.417 : -0.313).epsilon(0.05));
            CHECK(volume_error == doctest::Approx(quadratic ? -0.750 : -0.593).epsilon(0.05));
            CHECK(mesh.triangles() == (n == 33 ? 4276 : 17128));  // as the reference: the same cells are cut
            check_sound(mesh);
            const Soundness s = inspect(mesh);
            CHECK(s.euler == 2);
            CHECK(s.parts == 1);
            CHECK(s.flat_triangles == 0);
            // Order 2: twice as fine, a quarter of the error, to 0.07 in the exponent.
            const double error = std::fabs(m.area_m2 / area - 1);
            if (n == 65) CHECK(std::log2(last_area[quadratic] / error) == doctest::Approx(2).epsilon(0.035));
            last_area[quadratic] = error;
            double worst = 0;
            for (std::size_t v = 0; v < mesh.position.size(); ++v) {
                const glm::dvec3 out =
                    glm::normalize(glm::dvec3(mesh.position[v].x, mesh.position[v].y, mesh.position[v].z) -
                                   glm::dvec3(0.0123, 0.0371, -0.0217));
                const glm::dvec3 normal(mesh.normal[v].x, mesh.normal[v].y, mesh.normal[v].z);
                CHECK(glm::length(normal) == doctest::Approx(1).epsilon(1e-5));  // roundings of fp32
                worst = std::fmax(worst, glm::length(glm::cross(normal, out)));
                if (!(glm::dot(normal, out) > 0.9)) FAIL("normal ", v, " points inwards");
            }
            if (!quadratic && n == 65)
                CHECK(std::log2(normal_error[0] / worst) > 1.6);  // order 2, at its worst
            normal_error[quadratic] = worst;
        }
    // Central differences of a quadratic function are exact; what is left is fp32: 1e-7 / h.
    CHECK(normal_error[1] < 2e-5);
}

TEST_CASE("torus: area, volume and its one hole") {
    for (const int n : {33, 65}) {
        CAPTURE(n);
        const Mesh mesh = known_torus(n).mesh();
        const double h = 3.4 / (n - 1), area = 4 * kPi * kPi * 0.4, volume = 2 * kPi * kPi * 0.16;
        const Measures m = measure(mesh);
        // -0.363 h^2 and -1.22 h^2, within 5 % for n >= 33 (tests/data/README.md).
        CHECK((m.area_m2 / area - 1) / (h * h) == doctest::Approx(-0.363).epsilon(0.05));
        CHECK((m.volume_m3 / volume - 1) / (h * h) == doctest::Approx(-1.22).epsilon(0.05));
        check_sound(mesh);
        CHECK(inspect(mesh).euler == 0);
    }
}

TEST_CASE("a surface through nodes has no triangle without area, and none twice") {
    // tests/data/README.md, 7_marching_cubes surface_through_grid_nodes: a ball of radius 1 around a node,
    // 33^3 nodes over [-2, 2]^3. Six nodes lie on it; other implementations make 48 triangles of no area
    // there.
    KnownField field = known_ball(33, BallField::distance, glm::vec3(0), 2);
    const Mesh mesh = field.mesh();
    check_sound(mesh);
    const Soundness s = inspect(mesh);
    CHECK(s.flat_triangles == 0);
    CHECK(s.euler == 2);
    // The reference counts 2360 with nodes on the surface inside; with these outside, their cells are cut
    // otherwise.
    CHECK(mesh.triangles() > 2200);
    for (const float4& p : mesh.position)
        if (!(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)))
            FAIL("a vertex is not a number");
    // Whole numbers only: every edge that is crossed ends on a node of the surface.
    KnownField steps(glm::ivec3(8), glm::vec3(0), 1, 0, [](glm::ivec3 n, glm::vec3) {
        const glm::ivec3 d = glm::abs(n - 3);
        return float(1 - glm::max(d.x, glm::max(d.y, d.z)));
    });
    const Mesh box = steps.mesh();
    check_sound(box);
    CHECK(inspect(box).flat_triangles == 0);
    CHECK(inspect(box).euler == 2);
}

// ---------------------------------------------------------------------------------------- random fields

TEST_CASE("thousands of random fields are watertight") {
    course::set_seed(14);
    std::mt19937 random(14);
    std::uniform_real_distribution<float> smooth(-1, 1);
    std::uniform_int_distribution<int> few(-1, 1);
    for (int k = 0; k < 3000; ++k) {
        CAPTURE(k);
        // Every third field has the very value of iso at a third of its nodes; sizes that do and don't fill
        // a brick, so that surfaces cross from brick to brick.
        const int n = 5 + k % 7;
        KnownField field = k % 3 == 0 ? random_field(n, [&] { return float(few(random)); })
                                      : random_field(n, [&] { return smooth(random); });
        const Mesh mesh = field.mesh();
        const Soundness s = inspect(mesh);
        REQUIRE(s.sound());
        REQUIRE(s.flat_triangles == 0);
    }
}

TEST_CASE("random fields: the serial reference makes the same surface") {
    course::set_seed(15);
    std::mt19937 random(15);
    std::uniform_real_distribution<float> value(-1, 1);
    const CaseTable table = make_case_table();
    for (int k = 0; k < 20; ++k) {
        const int n = 18 + k % 3;
        DenseField dense{glm::ivec3(n), glm::vec3(0.5f, -1, 2), 0.25f, {}};
        dense.value.resize(std::size_t(n) * n * n);
        KnownField field(dense.nodes, dense.origin_m, dense.spacing_m, 0.1f, [&](glm::ivec3 node, glm::vec3) {
            bool rim = false;
            for (int axis = 0; axis < 3; ++axis) rim = rim || node[axis] == 0 || node[axis] == n - 1;
            return dense.value[dense.at(node.x, node.y, node.z)] = rim ? -1.0f : value(random);
        });
        const Mesh got = field.mesh(), expected = cubes_cpu(dense, 0.1f, table);
        // Vertices are numbered differently: compare triangles by the places of their corners, bit by bit.
        const auto places = [](const Mesh& mesh) {
            std::multiset<std::vector<float>> all;
            for (std::size_t t = 0; t < mesh.triangles(); ++t) {
                std::vector<std::vector<float>> corner;
                for (int c = 0; c < 3; ++c) {
                    const float4& p = mesh.position[mesh.index[3 * t + c]];
                    corner.push_back({p.x, p.y, p.z});
                }
                std::rotate(corner.begin(), std::min_element(corner.begin(), corner.end()), corner.end());
                std::vector<float> flat;
                for (const auto& c : corner) flat.insert(flat.end(), c.begin(), c.end());
                all.insert(flat);
            }
            return all;
        };
        CHECK(got.position.size() == expected.position.size());
        REQUIRE(got.triangles() == expected.triangles());
        CHECK(places(got) == places(expected));
    }
}

TEST_CASE("random clouds of particles are watertight, with every kind of field") {
    course::set_seed(16);
    for (const FieldKind kind : kKinds)
        for (std::uint32_t k = 0; k < 60; ++k) {
            CAPTURE(int(kind));
            CAPTURE(k);
            SurfaceSettings settings = settings_of(kind, 0.05f);
            settings.nodes_per_spacing = 0.5f + 0.5f * float(k % 4);
            const Mesh mesh = mesh_of(cloud(1 + 7 * k, k, 0.1f + 0.01f * float(k)), settings);
            // A few particles alone are too thin for the colour field, and for nodes farther apart than they.
            if (k > 20 && settings.nodes_per_spacing >= 1) REQUIRE(mesh.triangles() > 0);
            const Soundness s = inspect(mesh);
            REQUIRE(s.sound());
            REQUIRE(s.flat_triangles == 0);
        }
}

// --------------------------------------------------------------------------------- from particles to field

TEST_CASE("field: the kernels agree with the plain sums") {
    course::set_seed(17);
    const std::vector<float4> position = cloud(700, 17);
    for (const FieldKind kind : kKinds) {
        CAPTURE(int(kind));
        const SurfaceSettings settings = complete(settings_of(kind));
        Surface surface(settings);
        const course::DeviceBuffer<float4> particles(position);
        surface.build(particles.data(), std::uint32_t(position.size()));
        REQUIRE(surface.brick_count() > 0);
        const Blobs& made = surface.blobs();
        BlobsCpu blobs;
        if (kind == FieldKind::anisotropic)
            blobs = blobs_cpu(position, made.shape());
        else
            for (const float4& p : position) blobs.blob.push_back(p);
        const std::vector<float> field = surface.field().download();
        const std::vector<int4> corner = surface.bricks().corners().download();
        std::vector<double> got, expected;
        for (std::uint32_t b = 0; b < surface.brick_count(); b += 3)
            for (int k = b % 7; k < kBrickNodes; k += 7) {
                const glm::ivec3 node =
                    glm::ivec3(corner[b].x, corner[b].y, corner[b].z) + item_of(k, glm::ivec3(kBrick));
                got.push_back(field[std::size_t(kBrickNodes) * b + k]);
                expected.push_back(field_cpu(kind, surface.bricks().lattice().place_m(glm::vec3(node)),
                                             blobs.blob, blobs.stretch, made.field_shape()));
            }
        // Some hundred roundings of 6e-8 in sums of about 1. Anisotropic: covariances that lose a digit to
        // the subtraction of the mean, and flat blobs whose rim is four times as steep.
        const double tolerance = kind == FieldKind::anisotropic ? 1e-4 : 1e-5;
        course::check_close(got, expected, course::Tolerance(tolerance), "field", "node");
    }
}

TEST_CASE("blobs: a lattice is full of round ones, and its surface of flat ones") {
    std::vector<float4> position;
    for (int z = 0; z < 12; ++z)
        for (int y = 0; y < 12; ++y)
            for (int x = 0; x < 12; ++x) position.push_back(make_float4(0.1f * x, 0.1f * y, 0.1f * z, 0));
    Surface surface(settings_of(FieldKind::anisotropic, 0.1f));
    const BlobsCpu blobs = blobs_cpu(position, surface.blobs().shape());
    const auto at = [&](int x, int y, int z) { return std::size_t(12 * (12 * z + y) + x); };
    // In the middle: round by symmetry. The sum over a lattice is not quite the integral behind
    // kFullVariance.
    const Stretch middle = blobs.stretch[at(6, 6, 6)];
    CHECK(middle.xx == doctest::Approx(middle.yy).epsilon(1e-4));
    CHECK(middle.xx == doctest::Approx(1 / (0.25f * 0.25f)).epsilon(0.1));
    CHECK(std::fabs(middle.xy) < 1e-3f * middle.xx);
    // In the lowest layer: thin along z, so M is large there; and pulled upwards.
    const Stretch floor = blobs.stretch[at(6, 6, 0)];
    CHECK(floor.zz > 1.8f * floor.xx);
    CHECK(blobs.blob[at(6, 6, 0)].z > 0.02f);
    CHECK(blobs.blob[at(6, 6, 0)].x == doctest::Approx(0.6f).epsilon(1e-4));
}

TEST_CASE("eigenvalues and eigenvectors rebuild their matrix") {
    course::set_seed(18);
    std::mt19937 random(18);
    std::uniform_real_distribution<float> value(-1, 1);
    std::vector<float> got, expected;
    const auto add = [&](const glm::mat3& a) {
        const Eigen e = eigen_of(a);
        const glm::mat3 rebuilt =
            glm::mat3(e.vector[0] * e.value.x, e.vector[1] * e.value.y, e.vector[2] * e.value.z) *
            glm::transpose(e.vector);
        const glm::mat3 unit = glm::transpose(e.vector) * e.vector;
        for (int c = 0; c < 3; ++c)
            for (int r = 0; r < 3; ++r) {
                got.push_back(rebuilt[c][r]);
                expected.push_back(a[c][r]);
                got.push_back(unit[c][r]);
                expected.push_back(c == r);
            }
    };
    for (int k = 0; k < 500; ++k) {
        const float xy = value(random), xz = value(random), yz = value(random);
        add({value(random), xy, xz, xy, value(random), yz, xz, yz, value(random)});
    }
    add(glm::mat3(0));
    add(glm::mat3(1));
    add({1, 1, 1, 1, 1, 1, 1, 1, 1});  // eigenvalues 3, 0, 0
    add({1, 1e-20f, 0, 1e-20f, 1, 0, 0, 0, 1});
    // Fifteen rotations, each with a few roundings of 6e-8.
    course::check_close(got, expected, course::Tolerance(5e-6), "element");
}

TEST_CASE("bricks: exactly those that a particle reaches") {
    course::set_seed(19);
    std::vector<float4> blob = cloud(300, 19, 3);
    for (std::size_t i = 0; i < blob.size(); ++i) blob[i].w = 0.01f * float(i % 20);
    blob[7].x = NAN;  // left out
    const Lattice lattice{glm::vec3(-1), 0.05f, glm::ivec3(13, 12, 14)};
    std::set<std::vector<int>> expected;
    for (const float4& b : blob) {
        if (!(b.x == b.x)) continue;
        // In double, with the definition: a node nearer along each axis than the reach, or next to one.
        std::vector<std::set<int>> along(3);
        for (int axis = 0; axis < 3; ++axis) {
            const double x = (double(axis == 0 ? b.x : axis == 1 ? b.y : b.z) + 1) / double(0.05f);
            const double reach = double(b.w) / double(0.05f);
            for (int n = int(std::floor(x - reach)); n <= int(std::ceil(x + reach)); ++n)
                along[axis].insert(n / kBrick);
        }
        for (int z : along[2])
            for (int y : along[1])
                for (int x : along[0]) expected.insert({x * kBrick, y * kBrick, z * kBrick});
    }
    Bricks bricks;
    const course::DeviceBuffer<float4> device(blob);
    bricks.build(lattice, device.data(), std::uint32_t(blob.size()));
    std::set<std::vector<int>> got;
    std::map<std::vector<int>, std::uint32_t> number;
    std::vector<int4> corner = bricks.corners().download();
    for (std::uint32_t b = 0; b < bricks.count(); ++b) {
        got.insert({corner[b].x, corner[b].y, corner[b].z});
        number[{corner[b].x, corner[b].y, corner[b].z}] = b;
    }
    CHECK(got.size() == bricks.count());  // none twice
    CHECK(got == expected);
    // And each knows who is around it.
    std::vector<std::uint32_t> around(kAround * bricks.count());
    CUDA_CHECK(cudaMemcpy(around.data(), bricks.view().around, around.size() * sizeof(std::uint32_t),
                          cudaMemcpyDeviceToHost));
    std::vector<std::uint32_t> around_expected;
    for (std::uint32_t b = 0; b < bricks.count(); ++b)
        for (int k = 0; k < kAround; ++k) {
            const auto found =
                number.find({corner[b].x + kBrick * (k % 3 - 1), corner[b].y + kBrick * (k / 3 % 3 - 1),
                             corner[b].z + kBrick * (k / 9 - 1)});
            around_expected.push_back(found == number.end() ? kNone : found->second);
        }
    course::check_equal(around, around_expected, "neighbour", "place");
}

TEST_CASE("sparse and dense grids make the same surface") {
    for (const FieldKind kind : kKinds) {
        CAPTURE(int(kind));
        SurfaceSettings settings = settings_of(kind);
        const std::vector<float4> position = cloud(400, 20, 0.4f);
        const Mesh sparse = mesh_of(position, settings);
        settings.sparse = false;
        const Mesh dense = mesh_of(position, settings);
        REQUIRE(sparse.triangles() > 0);
        const auto sorted = [](const Mesh& mesh) {
            std::vector<std::vector<float>> all;
            for (std::size_t i = 0; i < mesh.position.size(); ++i) {
                const float4 &p = mesh.position[i], &n = mesh.normal[i];
                all.push_back({p.x, p.y, p.z, n.x, n.y, n.z});
            }
            std::sort(all.begin(), all.end());
            return all;
        };
        CHECK(sparse.triangles() == dense.triangles());
        CHECK(sorted(sparse) == sorted(dense));  // bit for bit: the same sums at the same nodes
    }
}

TEST_CASE("a block of water: its volume and area are found again") {
    // 20^3 particles of 0.02 m: a cube of 0.4 m. Each field's surface lies within a fifth of a spacing of the
    // cube's faces, which is 6 % of the volume, and edges are rounded off.
    std::vector<float4> position;
    for (int z = 0; z < 20; ++z)
        for (int y = 0; y < 20; ++y)
            for (int x = 0; x < 20; ++x)
                position.push_back(
                    make_float4(0.02f * (x + 0.5f), 0.02f * (y + 0.5f), 0.02f * (z + 0.5f), 0));
    for (const FieldKind kind : kKinds) {
        CAPTURE(int(kind));
        const Mesh mesh = mesh_of(position, settings_of(kind));
        check_sound(mesh);
        CHECK(inspect(mesh).parts == 1);
        const Measures m = measure(mesh);
        CHECK(m.volume_m3 == doctest::Approx(0.064).epsilon(0.06));
        CHECK(m.area_m2 == doctest::Approx(0.96).epsilon(0.08));
    }
}

TEST_CASE("the same mesh whatever the order of the threads") {
    course::require_simulator();
#ifdef __CUDASIM__
    const course::DeviceBuffer<float4> particles(cloud(300, 21));
    const std::string races = cudasim::find_races([&] {
        for (const FieldKind kind : kKinds) {
            Surface surface(settings_of(kind));
            surface.build(particles.data(), 300);
            DeviceMesh mesh;
            mesh.take(surface);
        }
    });
    // Chapter 05's scatter_kernel hands out places by luck; sort_cells_kernel, which follows, takes luck out
    // again. Nobody else may depend on it.
    const std::string named = "the result of kernel ";
    for (std::size_t at = races.find(named); at != std::string::npos; at = races.find(named, at + 1))
        CHECK(races.compare(at + named.size(), 14, "scatter_kernel") == 0);
    const auto mesh_with = [&](unsigned workers, cudasim::Order order) {
        const cudasim::WorkerScope worker_scope(workers);
        const cudasim::OrderScope order_scope(order);
        return mesh_of(cloud(300, 21), settings_of(FieldKind::anisotropic));
    };
    const Mesh one = mesh_with(1, {}), two = mesh_with(2, {}),
               shuffled = mesh_with(2, {cudasim::Order::kShuffled, 3});
    for (const Mesh* other : {&two, &shuffled}) {
        course::check_equal(other->index, one.index, "index", "place");
        course::check_equal(other->position, one.position, "position", "vertex");
        course::check_equal(other->normal, one.normal, "normal", "vertex");
    }
#endif
}
