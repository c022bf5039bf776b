// Chapter 03: the fountain on the device: parity with the CPU, three layouts timed, the price of copies.
#include <cmath>
#include <cstdio>

#include "01_particle_loop/checks.h"
#include "01_particle_loop/film.h"
#include "01_particle_loop/scenes.h"
#include "03_first_kernels/device_fountain.cuh"
#include "03_first_kernels/mistakes.cuh"
#include "03_first_kernels/parity.h"
#include "common/gpu_timer.h"
#include "common/program.h"

using namespace first_kernels;

namespace {

constexpr int kStepsPerLook = 50;  // a look at the state costs a copy; chapter 04 finds a cheaper one
constexpr int kRepeats = 15;       // medians of so many samples
constexpr int kBatch = 10;         // launches in a sample: one alone is over too soon to be measured well

/// Runs the fountain on the device and draws it. @return its last state
std::vector<Particle> show(course::Program& program, const Fountain& fountain, unsigned threads_per_block) {
    const course::ProgramOptions& o = program.options;
    Float4OnDevice device(o.particles);
    particle_loop::Film film(o, fountain);
    course::Progress progress("fountain", o.steps);
    try {
        for (int s = 0; s < o.steps; ++s) {
            device.step(fountain, s, threads_per_block);
            progress.update(s + 1);
            if (!film.wants(s + 1) && (s + 1) % kStepsPerLook != 0 && s + 1 < o.steps) continue;
            const std::uint32_t born = born_after(fountain, o.particles, s + 1);
            const std::vector<Particle> now = device.download();
            watch(now, born, fountain, s);
            if (film.wants(s + 1)) film.take(now, born);
        }
    } catch (const course::Unstable&) {
        film.save_sheet(program.result());
        throw;
    }
    const std::uint32_t born = born_after(fountain, o.particles, o.steps);
    const std::vector<Particle> end = device.download();
    film.save_end(program.result(), end, born,
                  std::to_string(born) + " droplets, computed on " + program.result().device + ", after " +
                      course::format_number(o.steps * fountain.dt_s) + " s");
    film.save_sheet(program.result());
    return end;
}

/// The same on the host, and how far the two are apart.
void compare_with_host(course::Program& program, const Fountain& fountain,
                       const std::vector<Particle>& device) {
    const course::ProgramOptions& o = program.options;
    std::vector<Particle> host(o.particles);
    for (int s = 0; s < o.steps; ++s) step(host, fountain, s);
    const std::uint32_t born = born_after(fountain, o.particles, o.steps);
    const Parity parity = compare_positions(host, device, born);
    course::Table table("Host and device after " + std::to_string(o.steps) + " steps",
                        {"droplets", "largest distance um", "rounding explains um", "bounced in another step",
                         "their distance um"});
    table.row({born, 1e6 * parity.largest_m, 1e6 * kRoundingBound_m, parity.other_bounce,
               1e6 * parity.largest_other_m});
    program.result().table(table);
}

/// n droplets as they leave the nozzle.
std::vector<Particle> at_the_nozzle(const Fountain& fountain, std::uint32_t n) {
    std::vector<Particle> particles(n);
    for (std::uint32_t i = 0; i < n; ++i)
        emit(fountain, particle_loop::random_start(fountain.seed, i, 0), particles[i].position_m,
             particles[i].velocity_m_per_s);
    return particles;
}

/// Milliseconds of one step.
template <class State>
double step_ms(State state, const Fountain& fountain) {
    std::uint32_t s = life_steps(fountain);  // from here on, all droplets are in flight
    return course::median_milliseconds(kRepeats,
                                       [&] {
                                           for (int k = 0; k < kBatch; ++k) state.step(fountain, s++);
                                       }) /
           kBatch;
}

void compare_layouts(course::Program& program, const Fountain& fountain) {
    course::Table table("One step in three layouts on " + program.result().device + " (median)",
                        {"droplets", "AoS ms", "SoA ms", "float4 ms", "AoS GB/s", "SoA GB/s", "float4 GB/s"});
    for (const std::uint32_t n : {1u << 12, 1u << 16, 1u << 20}) {
        const std::vector<Particle> start = at_the_nozzle(fountain, n);
        const double aos = step_ms(StructsOnDevice(start), fountain);
        const double soa = step_ms(ArraysOnDevice(start), fountain);
        const double vec = step_ms(Float4OnDevice(start), fountain);
        // Each droplet is read once and written once: 2 * 24 bytes, with float4 2 * 32.
        table.row({n, aos, soa, vec, 48e-6 * n / aos, 48e-6 * n / soa, 64e-6 * n / vec});
    }
    program.result().table(table);
}

void price_of_copies(course::Program& program, const Fountain& fountain) {
    course::Table table("A step, and a copy of its state to or from the host, on " + program.result().device +
                            " (ms, median)",
                        {"droplets", "upload", "step", "download", "copies / step"});
    for (const std::uint32_t n : {1u << 12, 1u << 16, 1u << 20}) {
        Float4OnDevice device(at_the_nozzle(fountain, n));
        const std::vector<float4> x = device.position.download(), v = device.velocity.download();
        const double upload = course::median_milliseconds(kRepeats, [&] {
            device.position.upload(x);
            device.velocity.upload(v);
        });
        std::vector<float4> back(n);  // once: allocating a vector each time would be measured, too
        const double download = course::median_milliseconds(kRepeats, [&] {
            for (const auto* from : {&device.position, &device.velocity})
                CUDA_CHECK(cudaMemcpy(back.data(), from->data(), from->bytes(), cudaMemcpyDeviceToHost));
        });
        const double step = step_ms(std::move(device), fountain);
        table.row({n, upload, step, download, (upload + download) / step});
    }
    program.result().table(table);
}

void explain(const Fountain& fountain, std::uint32_t n, unsigned threads_per_block) {
    std::printf(
        "A step is one kernel: fountain_step_float4_kernel, %u blocks of %u threads, %u of them idle.\n",
        blocks_for(n, threads_per_block), threads_per_block,
        blocks_for(n, threads_per_block) * threads_per_block - n);
    std::printf(
        "State: 32 bytes a droplet (position and age, velocity): %.1f KiB of device memory, allocated "
        "once.\n",
        32.0 * n / 1024);
    std::printf(
        "Left out: no copy to the host between steps; no generation and no random state is stored; no\n"
        "colour, the picture makes it from the position; no neighbours, no shared memory, no atomics.\n");
    std::printf("dt %g s; stable below %g s (2 / drag); a life is %u steps.\n", fountain.dt_s,
                2.0 / fountain.drag_per_s, life_steps(fountain));
}

}  // namespace

int main(int argc, char** argv) {
    course::Program program("03_first_kernels", "First kernels",
                            "The fountain on the device: the same physics, one thread per droplet");
    program.options.particles = 65536;
    program.options.steps = 700;
    program.scenes = {"crown", "spray"};
    float drag_per_s = -1.0f;
    int threads_per_block = int(kThreadsPerBlock);
    std::string mistake;
    bool no_measure = false;
    program.option("--drag", drag_per_s, "linear drag per second (below 0: the scene's)");
    program.option("--block", threads_per_block, "threads per block, 1 to 1024");
    program.option("--mistake", mistake,
                   "make this mistake and stop: too-many-threads, unchecked, host-pointer, no-guard");
    program.flag("--no-measure", no_measure, "pictures and parity only, no tables");
    return program.run(argc, argv, [&] {
        const course::ProgramOptions& o = program.options;
        if (o.window) throw course::BadInput("--window: this chapter draws pictures only; 06 opens one");
        if (threads_per_block < 1 || threads_per_block > 1024)
            throw course::BadInput("--block must be from 1 to 1024 threads, not " +
                                   std::to_string(threads_per_block));
        Fountain fountain = particle_loop::make_scene(o.scene);
        fountain.seed = o.seed;
        if (o.dt_s > 0) fountain.dt_s = o.dt_s;
        if (!(drag_per_s < 0)) fountain.drag_per_s = drag_per_s;
        check(fountain);
        if (o.explain) return explain(fountain, o.particles, unsigned(threads_per_block));
        program.result().device = course::device_name();
        if (!mistake.empty()) return program.result().note(make_mistake(mistake));
        compare_with_host(program, fountain, show(program, fountain, unsigned(threads_per_block)));
        if (no_measure) return;
        compare_layouts(program, particle_loop::make_scene("crown"));
        price_of_copies(program, particle_loop::make_scene("crown"));
    });
}
