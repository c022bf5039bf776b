// Chapter 03: the fountain on the device, its parity with the CPU, and clocks. Its studies: three layouts,
// the price of copies; its stability map: drag.
#include <chrono>
#include <cstdio>

#include "01_particle_loop/checks.h"
#include "01_particle_loop/film.h"
#include "03_first_kernels/mistakes.cuh"
#include "03_first_kernels/studies.cuh"
#include "common/gpu_timer.h"
#include "common/program.h"

using namespace first_kernels;

namespace {

/// Of host memory: the host's own droplets, a download, and on the simulator the device's memory as well.
constexpr double kBytesPerDroplet = sizeof(Particle) + 2 * (sizeof(Particle) + 2 * sizeof(float4));
constexpr int kStepsPerLook = 50;  // a look at the state costs a copy; chapter 04 finds a cheaper one

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

//! [three_clocks]
/// The same ten steps by three clocks.
void three_clocks(course::Program& program, const Fountain& fountain, unsigned threads_per_block) {
    using Clock = std::chrono::steady_clock;
    const auto ms_since = [](Clock::time_point start) {
        return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    };
    Float4OnDevice state(program.options.particles);
    std::uint32_t step_index = life_steps(fountain);  // from here on, all droplets are in flight
    const auto ten_steps = [&] {
        for (int k = 0; k < 10; ++k) state.step(fountain, step_index++, threads_per_block);
    };
    ten_steps();  // to warm up
    CUDA_CHECK(cudaDeviceSynchronize());

    course::GpuTimer events;
    const Clock::time_point start = Clock::now();
    events.start();  // notes the device's time when the work before is done: at once
    ten_steps();
    const double launched_ms = ms_since(start);
    const double events_ms = events.stop();  // notes it when the ten steps are done, and waits for that
    const double done_ms = ms_since(start);
    course::Table table("Ten steps on " + program.result().device + " by three clocks (ms)",
                        {"host, launches returned", "device, between two events", "host, device done"});
    table.row({launched_ms, events_ms, done_ms});
    program.result().table(table);
}
//! [three_clocks]

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
    program.option("--drag", drag_per_s, "linear drag per second (below 0: the scene's)");
    program.option("--block", threads_per_block, "threads per block, 1 to 1024");
    program.option("--mistake", mistake,
                   "make this mistake and stop: too-many-threads, unchecked, host-pointer, no-guard");
    program.study(
        {"layout", "Which layout is cheapest on the device, and from how many droplets on does it pay?",
         "largest distance from the host's droplets after one life (m)", "n",
         course::StudyPlot::time_against_value},
        study_layout);
    program.study({"copies", "What does it cost to take the state to the host and back?",
                   "elements that differ from a state that stayed on the device", "n",
                   course::StudyPlot::time_against_value},
                  study_copies);
    program.stability({"drag", "Up to which time step does drag slow a droplet down, on the device?",
                       "after 200 steps the fastest droplet is slower than at the start",
                       "each step multiplies the velocity by 1 - k dt, so dt < 2 / k", "drag k (1/s)"},
                      map_drag);
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
        course::require_memory(kBytesPerDroplet * o.particles + particle_loop::Film::bytes(o));
        if (!mistake.empty()) return program.result().note(make_mistake(mistake));
        compare_with_host(program, fountain, show(program, fountain, unsigned(threads_per_block)));
        three_clocks(program, fountain, unsigned(threads_per_block));
    });
}
