// Chapter 14: extreme input, files, OpenGL, and what a run leaves out.
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <random>
#include <sstream>

#include "14_surface_generation/mesh_file.h"
#include "14_surface_generation/surface_view.cuh"
#include "common/gl_context.h"
#include "tests/support/course_test.h"
#include "tests/support/run_program.h"
#ifdef __CUDASIM__
#include "common/cudasim/cudasim.h"
#endif

namespace {

using namespace surface;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr const char* kProgram = "ch14_surface_generation";
const FieldKind kKinds[] = {FieldKind::colour, FieldKind::zhu_bridson, FieldKind::anisotropic};

SurfaceSettings settings_of(FieldKind kind, float spacing_m = 0.02f) {
    SurfaceSettings settings;
    settings.kind = kind;
    settings.particle_spacing_m = spacing_m;
    return settings;
}

std::vector<float4> block(int edge, glm::vec3 low_m = glm::vec3(0), float spacing_m = 0.02f) {
    std::vector<float4> position;
    for (int z = 0; z < edge; ++z)
        for (int y = 0; y < edge; ++y)
            for (int x = 0; x < edge; ++x) {
                const glm::vec3 p = low_m + spacing_m * (glm::vec3(x, y, z) + 0.5f);
                position.push_back(make_float4(p.x, p.y, p.z, 0));
            }
    return position;
}

/// The sentence of the BadInput that `work` must throw.
template <class Work>
std::string sentence_of(Work work) {
    try {
        work();
    } catch (const course::BadInput& error) {
        return error.what();
    }
    return "no error";
}
bool says(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace

// ---------------------------------------------------------------------------------------------- few
// particles

TEST_CASE("no water, no surface") {
    for (const FieldKind kind : kKinds) {
        Surface surface(settings_of(kind));
        CHECK(surface.build(nullptr, 0).triangles == 0);
        CHECK(surface.brick_count() == 0);
        DeviceMesh mesh;
        mesh.take(surface);
        CHECK(mesh.download().position.empty());
        // And after a surface there was: nothing of it is left.
        const course::DeviceBuffer<float4> some(block(5));
        CHECK(surface.build(some.data(), 125).triangles > 0);
        CHECK(surface.build(some.data(), 0).triangles == 0);
        mesh.take(surface);
        CHECK(mesh.size().vertices == 0);
    }
}

TEST_CASE("one particle is a small ball, or too little for the colour field") {
    for (const FieldKind kind : kKinds) {
        CAPTURE(int(kind));
        SurfaceSettings settings = settings_of(kind);
        settings.nodes_per_spacing = 8;
        const Mesh mesh = mesh_of({make_float4(0.3f, -0.2f, 0.1f, 0)}, settings);
        if (kind == FieldKind::colour) {  // its field is 0.2 at the most, and the surface is at 0.5
            CHECK(mesh.triangles() == 0);
            continue;
        }
        const Soundness s = inspect(mesh);
        CHECK(s.sound());
        CHECK(s.euler == 2);
        // Zhu and Bridson's: a ball of half a spacing, 0.52 of the particle's cube. Anisotropic: radius
        // 1.25 spacings, height 8 x 1.567 / 2.5^3 = 0.80; 0.3 of it is at 0.66 spacings, and 1.2 cubes.
        const double cubes = measure(mesh).volume_m3 / std::pow(0.02, 3);
        CHECK(cubes == doctest::Approx(kind == FieldKind::zhu_bridson ? 0.52 : 1.2).epsilon(0.05));
    }
}

TEST_CASE("two particles: apart, close together, and at one place") {
    for (const FieldKind kind : kKinds)
        for (const float apart_m : {0.2f, 0.02f, 0.0f}) {
            CAPTURE(int(kind));
            CAPTURE(apart_m);
            const Mesh mesh =
                mesh_of({make_float4(0, 0, 0, 0), make_float4(apart_m, 0, 0, 0)}, settings_of(kind));
            const Soundness s = inspect(mesh);
            CHECK(s.sound());
            if (kind == FieldKind::anisotropic) CHECK(s.parts == (apart_m > 0.1f ? 2 : 1));
        }
}

TEST_CASE("all particles at one point, on a line, in a plane") {
    for (const FieldKind kind : kKinds)
        for (int dimension = 0; dimension < 3; ++dimension) {
            CAPTURE(int(kind));
            CAPTURE(dimension);
            std::vector<float4> position;
            for (int i = 0; i < 400; ++i)
                position.push_back(make_float4(dimension > 0 ? 0.002f * i : 0.5f,
                                               dimension > 1 ? 0.05f * (i % 7) : 0.5f, 0.5f, 0));
            const Mesh mesh = mesh_of(position, settings_of(kind));
            CHECK(mesh.triangles() > 0);
            CHECK(inspect(mesh).sound());
        }
}

TEST_CASE("particles at NaN and infinity are left out") {
    for (const FieldKind kind : kKinds) {
        CAPTURE(int(kind));
        std::vector<float4> position = block(6), mixed = position;
        mixed.insert(mixed.begin() + 17, make_float4(kNan, 0, 0, 0));
        mixed.insert(mixed.begin() + 60, make_float4(0, INFINITY, 0, 0));
        mixed.push_back(make_float4(0, 0, -INFINITY, 0));
        const Mesh clean = mesh_of(position, settings_of(kind)), got = mesh_of(mixed, settings_of(kind));
        course::check_equal(got.position, clean.position, "position", "vertex");
        course::check_equal(got.index, clean.index, "index", "place");
        CHECK(mesh_of({make_float4(kNan, kNan, kNan, 0)}, settings_of(kind)).triangles() == 0);
    }
}

// --------------------------------------------------------------------------------------------- far and large

TEST_CASE("ten kilometres from the origin the surface is closed all the same") {
    // There a float knows places to 1 mm, a twentieth of the spacing: normals suffer, the topology does not.
    for (const FieldKind kind : kKinds) {
        CAPTURE(int(kind));
        const Mesh mesh = mesh_of(block(8, glm::vec3(1e4f)), settings_of(kind));
        const Soundness s = inspect(mesh);
        CHECK(s.sound());
        CHECK(s.parts == 1);
        CHECK(measure(mesh).volume_m3 == doctest::Approx(std::pow(0.16, 3)).epsilon(0.15));
    }
}

TEST_CASE("two drops far apart take few bricks; a box too large for its table is told in bytes") {
    const auto two_drops = [](float apart_m) {
        std::vector<float4> position = block(4), far = block(4, glm::vec3(apart_m));
        position.insert(position.end(), far.begin(), far.end());
        return position;
    };
    const SurfaceSettings settings = settings_of(FieldKind::anisotropic);
    Surface surface(settings);
    const course::DeviceBuffer<float4> near(two_drops(1)), wide(two_drops(50));
    surface.build(near.data(), 128);
    const std::uint32_t bricks = surface.brick_count();
    surface.build(wide.data(), 128);
    // Each drop lies in other bricks than before, so their number may differ a little, but not with the box:
    // that is 50^3 times as large.
    CHECK(surface.brick_count() < 2 * bricks);
    CHECK(inspect([&] {
              DeviceMesh mesh;
              mesh.take(surface);
              return mesh.download();
          }())
              .parts == 2);
    const course::DeviceBuffer<float4> too_wide(two_drops(2e4f)), beyond(two_drops(1e9f)),
        huge(two_drops(1e38f));
    const std::string table = sentence_of([&] { surface.build(too_wide.data(), 128); });
    CHECK(says(table, "a table of the regions of this box would take"));
    CHECK(says(table, "bytes, and the device has"));
    CHECK(says(sentence_of([&] { surface.build(beyond.data(), 128); }), "nodes long"));
    CHECK(says(sentence_of([&] { surface.build(huge.data(), 128); }), "nodes long"));
    SurfaceSettings dense = settings;
    dense.sparse = false;
    Surface everywhere(dense);
    CHECK(says(sentence_of([&] { everywhere.build(wide.data(), 128); }), "a field on bricks would take"));
    // The error has broken nothing.
    CHECK(surface.build(near.data(), 128).triangles > 0);
}

TEST_CASE("settings that make no sense are told apart") {
    const auto sentence = [](auto change) {
        SurfaceSettings settings;
        change(settings);
        return sentence_of([&] { Surface surface(settings); });
    };
    const float bad[] = {-1, kNan, INFINITY};
    for (const float value : bad) {
        CAPTURE(value);
        CHECK(says(sentence([&](auto& s) { s.iso = value; }), "iso-value"));
        CHECK(says(sentence([&](auto& s) { s.particle_spacing_m = value; }), "spacing"));
        CHECK(says(sentence([&](auto& s) { s.nodes_per_spacing = value; }), "nodes for each spacing"));
        CHECK(says(sentence([&](auto& s) { s.radius = value; }), "radius"));
        CHECK(says(sentence([&](auto& s) { s.neighbour_reach = value; }), "neighbours"));
        CHECK(says(sentence([&](auto& s) { s.pull = value; }), "pulled"));
    }
    CHECK(says(sentence([](auto& s) { s.particle_spacing_m = 0; }), "spacing"));
    CHECK(says(sentence([](auto& s) { s.particle_spacing_m = 1e-30f; }), "spacing"));
    // A spacing far below the particles' true one: a mist of tiny drops, or too many nodes; no crash.
    const course::DeviceBuffer<float4> particles(block(3));
    Surface fine(settings_of(FieldKind::anisotropic, 1e-3f));
    CHECK(fine.build(particles.data(), 27).triangles > 27 * 8);
    Surface finer(settings_of(FieldKind::anisotropic, 1e-9f));
    CHECK(says(sentence_of([&] { finer.build(particles.data(), 27); }), "nodes long"));
}

TEST_CASE("an iso-value above the whole field gives nothing, one near zero a closed surface") {
    for (const FieldKind kind : kKinds) {
        CAPTURE(int(kind));
        SurfaceSettings settings = settings_of(kind);
        for (const float iso : {1e-3f, 0.1f, 0.7f, 1e6f}) {
            CAPTURE(iso);
            settings.iso = iso;
            const Mesh mesh = mesh_of(block(6), settings);
            CHECK(inspect(mesh).sound());
            CHECK((mesh.triangles() > 0) == (iso < 1));
        }
    }
}

TEST_CASE("resolutions from a quarter of a node to eight nodes a spacing") {
    for (const float nodes : {0.25f, 0.7f, 1.0f, 3.0f, 8.0f}) {
        CAPTURE(nodes);
        SurfaceSettings settings = settings_of(FieldKind::anisotropic);
        settings.nodes_per_spacing = nodes;
        const Mesh mesh = mesh_of(block(7), settings);
        CHECK(inspect(mesh).sound());
        if (nodes >= 1) CHECK(inspect(mesh).euler == 2);
    }
}

TEST_CASE("a field that is not a number has no surface there, and no vertex either") {
    course::DeviceBuffer<float> field(std::vector<float>(kBrickNodes, kNan));
    Bricks bricks;
    bricks.build_all({glm::vec3(0), 1, glm::ivec3(1)});
    MarchingCubes cubes;
    CHECK(cubes.count(field.data(), bricks.view(), 0).triangles == 0);
    std::vector<float> mixed(kBrickNodes, kNan);
    mixed[3 * 64 + 3 * 8 + 3] = 1;
    field.upload(mixed);
    const MeshSize size = cubes.count(field.data(), bricks.view(), 0);
    CHECK(size.triangles == 8);
    course::DeviceBuffer<float4> position(size.vertices), normal(size.vertices);
    course::DeviceBuffer<std::uint32_t> index(3 * size.triangles);
    cubes.write({position.data(), normal.data(), index.data()}, field.data(), bricks.view(),
                bricks.lattice());
    for (const std::vector<float4>& list : {position.download(), normal.download()})
        for (const float4& v : list) CHECK(std::isfinite(v.x + v.y + v.z));
}

// --------------------------------------------------------------------------------------------------- files

namespace {

/// Reads what any program must read in a PLY file: the header says what follows.
Mesh read_ply(const std::string& file) {
    Mesh mesh;
    std::istringstream in(file);
    std::string word, line;
    std::size_t vertices = 0, faces = 0, floats = 0;
    while (std::getline(in, line) && line != "end_header") {
        std::istringstream words(line);
        words >> word;
        if (word == "element") {
            std::string what;
            std::size_t count;
            words >> what >> count;
            (what == "vertex" ? vertices : faces) = count;
        }
        floats += line.rfind("property float", 0) == 0;
    }
    for (std::size_t i = 0; i < vertices; ++i) {
        float v[6] = {};
        in.read(reinterpret_cast<char*>(v), std::streamsize(floats * sizeof(float)));
        mesh.position.push_back(make_float4(v[0], v[1], v[2], 1));
        if (floats == 6) mesh.normal.push_back(make_float4(v[3], v[4], v[5], 0));
    }
    for (std::size_t t = 0; t < faces; ++t) {
        std::uint32_t corner[3] = {};
        CHECK(in.get() == 3);
        in.read(reinterpret_cast<char*>(corner), sizeof corner);
        mesh.index.insert(mesh.index.end(), corner, corner + 3);
    }
    CHECK(in.good());
    CHECK(in.peek() == std::istringstream::traits_type::eof());
    return mesh;
}

Mesh read_obj(const std::string& file) {
    Mesh mesh;
    std::istringstream in(file);
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        std::string what;
        words >> what;
        float4 v{0, 0, 0, what == "v" ? 1.0f : 0.0f};
        if (what == "v" || what == "vn") {
            words >> v.x >> v.y >> v.z;
            (what == "v" ? mesh.position : mesh.normal).push_back(v);
        } else if (what == "f") {
            for (std::string corner; words >> corner;) {
                const std::size_t slashes = corner.find("//");
                if (slashes != std::string::npos)
                    CHECK(corner.substr(0, slashes) == corner.substr(slashes + 2));
                mesh.index.push_back(std::uint32_t(std::stoul(corner)) - 1);
            }
        }
    }
    return mesh;
}

std::string content(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("PLY and OBJ hold the mesh, to the last bit") {
    const course::TemporaryFolder folder;
    Mesh mesh = mesh_of(block(5, {-0.123f, 1e-7f, 30}), settings_of(FieldKind::anisotropic));
    REQUIRE(mesh.triangles() > 0);
    for (const bool normals : {true, false}) {
        if (!normals) mesh.normal.clear();
        save_ply(folder.path() / "a.ply", mesh);
        save_obj(folder.path() / "a.obj", mesh);
        for (const Mesh& got :
             {read_ply(content(folder.path() / "a.ply")), read_obj(content(folder.path() / "a.obj"))}) {
            course::check_equal(got.position, mesh.position, "position", "vertex");
            course::check_equal(got.normal, mesh.normal, "normal", "vertex");
            course::check_equal(got.index, mesh.index, "index", "place");
        }
    }
    save_ply(folder.path() / "empty.ply", Mesh{});
    CHECK(read_ply(content(folder.path() / "empty.ply")).triangles() == 0);
    save_obj(folder.path() / "empty.obj", Mesh{});
    CHECK(read_obj(content(folder.path() / "empty.obj")).triangles() == 0);
}

TEST_CASE("a mesh that no program could read is not written, and the old file stays") {
    const course::TemporaryFolder folder;
    const Mesh good = mesh_of(block(3), settings_of(FieldKind::anisotropic));
    const auto file = folder.path() / "a.ply";
    save_ply(file, good);
    const std::string before = content(file);
    Mesh bad = good;
    bad.position[3].y = kNan;
    CHECK(says(sentence_of([&] { save_ply(file, bad); }), "not a number"));
    bad = good;
    bad.index.back() = std::uint32_t(good.position.size());
    CHECK(says(sentence_of([&] { save_ply(file, bad); }), "without corners"));
    bad = good;
    bad.normal.pop_back();
    CHECK(says(sentence_of([&] { save_obj(file, bad); }), "some of its vertices"));
    CHECK(content(file) == before);
    CHECK(says(sentence_of([&] { save_obj("/proc/no/such/folder.obj", good); }), "/proc/no"));
}

TEST_CASE("the mesh inspector sees what is wrong") {
    const Mesh good = mesh_of(block(3), settings_of(FieldKind::anisotropic));
    REQUIRE(inspect(good).sound());
    Mesh hole = good;
    hole.index.resize(hole.index.size() - 3);
    CHECK(inspect(hole).unpaired_edges == 3);
    Mesh turned = good;
    std::swap(turned.index[0], turned.index[1]);
    CHECK(inspect(turned).unpaired_edges == 6);
    Mesh twice = good;
    twice.index.insert(twice.index.end(), good.index.begin(), good.index.begin() + 3);
    CHECK(inspect(twice).duplicate_triangles == 1);
    Mesh extra = good;
    extra.position.push_back(make_float4(0, 0, 0, 1));
    CHECK(inspect(extra).unused_vertices == 1);
    Mesh wild = good;
    wild.index[5] = 0xfffffffe;
    CHECK(inspect(wild).bad_indices == 1);
    // Two balls that share a vertex: closed, but pinched there.
    Mesh pinched = good;
    const std::uint32_t n = std::uint32_t(good.position.size());
    pinched.position.insert(pinched.position.end(), good.position.begin() + 1, good.position.end());
    for (const std::uint32_t i : good.index) pinched.index.push_back(i == 0 ? 0 : n - 1 + i);
    CHECK(inspect(pinched).unpaired_edges == 0);
    CHECK(inspect(pinched).pinched_vertices == 1);
    CHECK(inspect(pinched).parts == 1);
}

// -------------------------------------------------------------------------------------- OpenGL and leaving
// out

namespace {

Settings run_of(Drawing drawing) {
    Settings settings;
    settings.water.scene = sph::all_scenes()[0];
    settings.water.particles = 1000;
    settings.drawing = drawing;
    settings.water.drawing = drawing == Drawing::points    ? sph::Drawing::points
                             : drawing == Drawing::spheres ? sph::Drawing::spheres
                                                           : sph::Drawing::none;
    return settings;
}

std::unique_ptr<course::GlContext> context_or_skip() {
    try {
        return course::make_headless_context();
    } catch (const course::NoOpenGl& error) {
        course::skip(error.what());
    }
}

#ifdef __CUDASIM__
const char* kSurfaceKernels[] = {"blob_kernel",     "round_blob_kernel", "mark_regions_kernel",
                                 "field_kernel",    "classify_kernel",   "vertices_kernel",
                                 "triangles_kernel"};
#endif

}  // namespace

TEST_CASE("OpenGL's mesh is the device's mesh, shared or copied") {
    const auto context = context_or_skip();
    const course::DeviceBuffer<float4> particles(block(6));
    Surface surface(settings_of(FieldKind::anisotropic));
    surface.build(particles.data(), 216);
    DeviceMesh device;
    device.take(surface);
    const Mesh expected = device.download();
    for (const interop::Handover wanted : {interop::Handover::shared, interop::Handover::copied}) {
        GlMesh mesh(Normals::from_field, wanted);
        CHECK(mesh.buffers().triangles == 0);
        mesh.take(surface);
        const MeshBuffers buffers = mesh.buffers();
        REQUIRE(buffers.triangles == expected.triangles());
        Mesh got = expected;
        const auto read = [](GLuint buffer, auto& list) {
            std::fill(list.begin(), list.end(), typename std::decay_t<decltype(list)>::value_type{});
            glBindBuffer(GL_ARRAY_BUFFER, buffer);
            glGetBufferSubData(GL_ARRAY_BUFFER, 0, GLsizeiptr(list.size() * sizeof list[0]), list.data());
        };
        read(buffers.position, got.position);
        read(buffers.normal, got.normal);
        read(buffers.index, got.index);
        course::check_equal(got.position, expected.position, "position", "vertex");
        course::check_equal(got.normal, expected.normal, "normal", "vertex");
        course::check_equal(got.index, expected.index, "index", "place");
        if (wanted == interop::Handover::copied) CHECK(says(mesh.handover(), "asked for"));
        if (wanted == interop::Handover::shared && course::on_simulator())
            CHECK(says(mesh.handover(), "no copy"));
        // A larger surface, then none.
        const course::DeviceBuffer<float4> more(block(10));
        Surface larger(settings_of(FieldKind::anisotropic));
        larger.build(more.data(), 1000);
        mesh.take(larger);
        CHECK(mesh.buffers().triangles == larger.size().triangles);
        larger.build(more.data(), 0);
        mesh.take(larger);
        CHECK(mesh.buffers().triangles == 0);
    }
}

TEST_CASE("a drop is drawn, and an empty scene is drawn without it") {
    const auto context = context_or_skip();
    const Settings settings = run_of(Drawing::surface);
    SurfaceView view(settings, 160, 90);
    const course::Camera camera = interop::first_view(tank_of(settings)).camera();
    view.draw(nullptr, 0, camera);
    const course::Image empty = view.image();
    const course::DeviceBuffer<float4> particles(block(10, {0.3f, 0.2f, 0.1f}));
    view.draw(particles.data(), 1000, camera);
    const course::Image drop = view.image();
    int changed = 0;
    for (std::size_t k = 0; k < empty.rgb.size(); ++k) changed += std::abs(empty.rgb[k] - drop.rgb[k]) > 20;
    CHECK(changed > 600);  // 0.2 m of a tank of 0.9 m: some 20 x 20 pixels of 3 values, and a shadow
    CHECK(changed < int(empty.rgb.size()) / 3);
    view.draw(nullptr, 0, camera);
    CHECK(view.image().rgb == empty.rgb);
}

TEST_CASE("--explain tells the kernels and bytes of every kind of surface") {
    course::require_simulator();
#ifdef __CUDASIM__
    for (const FieldKind kind : kKinds)
        for (const bool sparse : {true, false}) {
            CAPTURE(int(kind));
            CAPTURE(sparse);
            Settings settings = run_of(Drawing::none);
            const sph::Start start = sph::make_start(settings.water);
            settings.surface = settings_of(kind, start.spacing_m);
            settings.surface.sparse = sparse;
            Surface surface(settings.surface);
            const std::size_t before = cudasim::live_bytes();
            Launches expected;
            std::vector<std::string> got, want;
            {
                const cudasim::Recording recording;
                surface.build(start.water.position(), start.water.size());
                expected = launches_of_build(surface);
                for (const cudasim::Launch& launch : recording.launches()) got.push_back(launch.kernel);
            }
            // Scans call themselves, so their two kernels are nested: compared as how often, not in which
            // order.
            std::map<std::string, int> got_count, want_count;
            for (const std::string& kernel : got) ++got_count[kernel];
            for (const auto& [kernel, count] : expected)
                if (count > 0) want_count[kernel] += count;
            CHECK(got_count == want_count);
            CHECK(says(explain(settings, &surface), list_launches(expected)));
            CHECK(says(explain(settings, &surface), std::to_string(surface.bytes()) + " bytes"));
            // bytes() is what was allocated, but for what a Surface holds before its first build.
            const Surface fresh(settings.surface);
            CHECK(cudasim::live_bytes() - before == surface.bytes());
            DeviceMesh mesh(Normals::none);
            {
                const cudasim::Recording recording;
                mesh.take(surface);
                CHECK(recording.count("vertices_kernel<false>") == 1);
                CHECK(recording.count("vertices_kernel<true>") == 0);
                CHECK(recording.count("triangles_kernel") == 1);
                CHECK(recording.launches().size() == 2);
                CHECK(recording.allocations() == 2);  // positions and indices: no normals
            }
            const cudasim::Recording again;
            surface.build(start.water.position(), start.water.size());
            mesh.take(surface);
            CHECK(again.allocations() == 0);  // memory is kept
        }
#endif
}

TEST_CASE("points and spheres: no field and no mesh; numbers: no OpenGL") {
    course::require_simulator();
#ifdef __CUDASIM__
    const auto context = context_or_skip();
    for (const Drawing drawing : {Drawing::points, Drawing::spheres}) {
        const Settings settings = run_of(drawing);
        const sph::Start start = sph::make_start(settings.water);
        const course::GlCount buffers = course::gl_count(course::GlKind::buffer);
        const cudasim::Recording recording;
        View view(settings, start, 64, 36);
        view.draw(start.water, interop::first_view(tank_of(settings)).camera());
        for (const char* kernel : kSurfaceKernels) CHECK(recording.count(kernel) == 0);
        CHECK(recording.launches().empty());
        CHECK(recording.allocations() == 0);
        CHECK(course::gl_count(course::GlKind::buffer).made - buffers.made == 2);  // positions, velocities
        CHECK(says(explain(settings, nullptr), "left out: blobs, bricks, field, marching cubes and mesh"));
    }
    {
        const Settings settings = run_of(Drawing::surface);
        const sph::Start start = sph::make_start(settings.water);
        const course::GlCount buffers = course::gl_count(course::GlKind::buffer);
        const cudasim::Recording recording;
        View view(settings, start, 64, 36);
        view.draw(start.water, interop::first_view(tank_of(settings)).camera());
        CHECK(recording.count("vertices_kernel<true>") == 1);
        // Positions, normals, indices; no sphere's velocity.
        CHECK(course::gl_count(course::GlKind::buffer).made - buffers.made == 3);
    }
    const course::GlCount before = course::gl_count();
    Settings settings = run_of(Drawing::none);
    const sph::Start start = sph::make_start(settings.water);
    settings.surface.particle_spacing_m = start.spacing_m;
    Surface surface(settings.surface);
    surface.build(start.water.position(), start.water.size());
    DeviceMesh mesh(Normals::none);
    mesh.take(surface);
    CHECK(measure(mesh.download()).volume_m3 > 0);
    CHECK(course::gl_count().made == before.made);
    CHECK(says(explain(settings, &surface), "left out: OpenGL"));
    CHECK(says(explain(settings, &surface), "left out: normals"));
#endif
}

// ------------------------------------------------------------------------------------------------- the
// program

TEST_CASE("bad input ends with one clear sentence and exit code 2") {
    const course::TemporaryFolder folder;
    const std::string out = " --steps 0 --particles 50 --out " + folder.path().string();
    const auto run = [&](const std::string& arguments) {
        return course::run_program(kProgram, arguments + out);
    };
    for (const auto& [arguments, sentence] : std::vector<std::pair<std::string, std::string>>{
             {"--draw sphere", "--draw must be one of none, points, spheres, surface"},
             {"--field metaballs", "--field must be one of colour, zhu_bridson, anisotropic"},
             {"--mesh stl", "--mesh must be one of none, ply, obj"},
             {"--iso -0.5", "--iso must be 0"},
             {"--iso nan", "--iso must be"},
             {"--iso 1e-9", "iso-value must be at least 0.001"},
             {"--resolution 0", "0.25 to 64 nodes"},
             {"--resolution 1000", "0.25 to 64 nodes"},
             {"--scene ocean", "ocean"}}) {
        CAPTURE(arguments);
        const course::ProgramRun result = run(arguments);
        CHECK(result.exit_code == 2);
        CAPTURE(result.output);
        CHECK(says(result.output, sentence));
    }
}

TEST_CASE("little water, no surface, the dense grid: the program runs, and writes the mesh") {
    const course::TemporaryFolder folder;
    const std::string out = " --steps 2 --draw none --out " + folder.path().string();
    for (const char* arguments :
         {"--particles 40 --field colour --mesh ply", "--particles 60 --mesh ply",
          "--particles 300 --mesh obj --iso 1e6", "--particles 300 --mesh ply --dense"}) {
        CAPTURE(arguments);
        const course::ProgramRun result = course::run_program(kProgram, arguments + out);
        CAPTURE(result.output);
        CHECK(result.exit_code == 0);
    }
    CHECK(read_ply(content(folder.path() / "surface.ply")).triangles() > 0);
    CHECK(read_obj(content(folder.path() / "surface.obj")).triangles() == 0);
}
