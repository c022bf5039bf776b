// Chapter 14.
#include <cstdio>
#include <random>
#include "14_surface_generation/known_fields.cuh"
#include "common/timing.h"
using namespace surface;
int main() {
    for (int n : {17, 33, 65, 129}) {
        KnownField f = known_ball(n, BallField::distance);
        Mesh m = f.mesh();
        Measures s = measure(m);
        Soundness ok = inspect(m);
        double h = 3.0 / (n - 1), a = 4 * M_PI, v = 4 * M_PI / 3;
        auto t = course::time_work(9, [&] { f.build(); });
        DeviceMesh dm;
        auto t2 = course::time_work(9, [&] { f.build(); dm.take(f); });
        std::printf("n %d tri %zu area %.4f vol %.4f chi %ld sound %d flat %zu  %.2f ms count %.2f all: %.1f Mcells/s\n", n, m.triangles(), (s.area_m2 / a - 1) / h / h,
                    (s.volume_m3 / v - 1) / h / h, ok.euler, ok.sound(), ok.flat_triangles, t.median_s * 1e3, t2.median_s * 1e3, (n - 1.) * (n - 1) * (n - 1) / t2.median_s * 1e-6);
    }
    std::mt19937 r(1);
    std::uniform_real_distribution<float> u(-1, 1);
    int bad = 0;
    for (int k = 0; k < 2000; ++k) {
        KnownField f(glm::ivec3(10), glm::vec3(0), 1, 0, [&](glm::ivec3 n, glm::vec3) {
            bool rim = n.x == 0 || n.y == 0 || n.z == 0 || n.x == 9 || n.y == 9 || n.z == 9;
            float v = u(r); return rim ? -1.f : v; });
        Mesh m = f.mesh();
        Soundness ok = inspect(m);
        if (!ok.sound() || ok.flat_triangles) { if (!bad) std::printf("bad %zu %zu %zu %zu pinched %zu\n", ok.unpaired_edges, ok.duplicate_triangles, ok.flat_triangles, ok.unused_vertices, ok.pinched_vertices); ++bad; }
    }
    std::printf("%d bad\n", bad);
    for (FieldKind kind : {FieldKind::colour, FieldKind::zhu_bridson, FieldKind::anisotropic}) {
        std::vector<float4> p;
        float dx = 0.02f;
        int n = 50;
        for (int z = 0; z < n; ++z) for (int y = 0; y < n; ++y) for (int x = 0; x < n; ++x)
            p.push_back(make_float4((x + 0.5f + 0.05f * u(r)) * dx, (y + 0.5f + 0.05f * u(r)) * dx, (z + 0.5f + 0.05f * u(r)) * dx, 0));
        SurfaceSettings s; s.kind = kind; s.particle_spacing_m = dx;
        course::DeviceBuffer<float4> d(p);
        Surface surf(s);
        DeviceMesh dm;
        auto t = course::time_work(5, [&] { surf.build(d.data(), p.size()); dm.take(surf); });
        Mesh m = dm.download();
        Soundness ok = inspect(m);
        Measures me = measure(m);
        std::printf("kind %d bricks %u v %u t %u sound %d parts %zu vol %.4f (true %.4f) area %.3f  %.1f ms bytes %.1f MB\n", int(kind), surf.brick_count(), dm.size().vertices, dm.size().triangles, ok.sound(), ok.parts, me.volume_m3, n*n*n*dx*dx*dx, me.area_m2, t.median_s * 1e3, surf.bytes() / 1e6);
    }
}
