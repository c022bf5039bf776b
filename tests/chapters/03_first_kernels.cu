// Chapter 03: the kernels against chapter 01's loops, at sizes and blocks that catch people; what wrong
// launches look like.
#include "03_first_kernels/first_kernels.cuh"

#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>

#include "01_particle_loop/checks.h"
#include "01_particle_loop/scenes.h"
#include "03_first_kernels/device_fountain.cuh"
#include "03_first_kernels/mistakes.cuh"
#include "03_first_kernels/studies.cuh"
#include "tests/support/course_test.h"
#include "tests/support/run_program.h"
#ifdef __CUDASIM__
#include "common/cudasim/cudasim.h"
#endif

using namespace first_kernels;
using particle_loop::make_scene;

namespace {

/// Chapter 01's loop: the reference.
std::vector<Particle> run_on_host(const Fountain& fountain, std::uint32_t n, std::uint32_t steps) {
    std::vector<Particle> particles(n);
    for (std::uint32_t s = 0; s < steps; ++s) step(particles, fountain, s);
    return particles;
}

std::vector<Particle> run_float4(const Fountain& fountain, std::uint32_t n, std::uint32_t steps,
                                 unsigned threads_per_block = kThreadsPerBlock) {
    Float4OnDevice state(n);
    for (std::uint32_t s = 0; s < steps; ++s) state.step(fountain, s, threads_per_block);
    return state.download();
}

template <class State>
std::vector<Particle> run_from_zeros(const Fountain& fountain, std::uint32_t n, std::uint32_t steps) {
    State state{std::vector<Particle>(n)};
    for (std::uint32_t s = 0; s < steps; ++s) state.step(fountain, s);
    return state.download();
}

/// Rounding for all but a few; those few bounced in another step (parity.h has the reasons for both bounds).
/// A height within 1e-5 m of the floor decides, of 0.02 m that a droplet falls in a step: 5 droplets in
/// 10,000 at a first bounce, some more at the slower ones after it.
void check_parity(const std::vector<Particle>& host, const std::vector<Particle>& device,
                  std::uint32_t born) {
    const Parity parity = compare_positions(host, device, born);
    CHECK_MESSAGE(parity.other_bounce <= 1 + born / 200, parity.other_bounce << " of " << born);
    CHECK_FALSE(!(parity.largest_other_m <= kOtherBounceBound_m));
    std::vector<glm::vec3> v_host, v_device;
    for (std::uint32_t i = 0; i < born; ++i) {
        if (glm::distance(host[i].position_m, device[i].position_m) > kRoundingBound_m) continue;
        v_host.push_back(host[i].velocity_m_per_s);
        v_device.push_back(device[i].velocity_m_per_s);
    }
    // A velocity is rounded like a position; one that met the floor in another step differs by (1 + e) g dt,
    // its way by less than kRoundingBound_m for as long as 6 ms, that is, for the last two steps.
    course::check_close(v_device, v_host, course::Tolerance(0.06), "velocity", "droplet");
}

bool same_bits(const std::vector<Particle>& a, const std::vector<Particle>& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0);
}

__global__ void random_start_kernel(Uniforms* out, std::uint64_t seed, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i < n) out[i] = random_start_on_device(seed, i, 3 * i);
}

}  // namespace

// ------------------------------------------------------------------------------------------------- parity

TEST_CASE("blocks: as many as are needed, no more") {
    CHECK(blocks_for(1, 256) == 1);
    CHECK(blocks_for(255, 256) == 1);
    CHECK(blocks_for(256, 256) == 1);
    CHECK(blocks_for(257, 256) == 2);
    CHECK(blocks_for(1000, 1) == 1000);
    CHECK(blocks_for(2147483647u, 256) == 8388608);
}

TEST_CASE("random numbers on the device are the host's, bit for bit") {
    const std::uint32_t n = 1000;
    course::DeviceBuffer<Uniforms> out(n);
    const std::uint64_t seed = 0x123456789abcdefull;
    random_start_kernel<<<blocks_for(n), kThreadsPerBlock>>>(out.data(), seed, n);
    CUDA_CHECK(cudaGetLastError());
    const std::vector<Uniforms> device = out.download();
    int different = 0;
    for (std::uint32_t i = 0; i < n; ++i) {
        const Uniforms host = particle_loop::random_start(seed, i, 3 * i);
        different += std::memcmp(&host, &device[i], sizeof host) != 0;  // integers, and one exact product
    }
    CHECK(different == 0);
}

TEST_CASE("one step from the same state differs by roundings only") {
    const Fountain fountain = make_scene("crown");
    const std::uint32_t n = 2000, step_index = 900;
    std::vector<Particle> host = run_on_host(fountain, n, step_index);
    const std::vector<Particle> before = host;
    StructsOnDevice structs(host);
    ArraysOnDevice arrays(host);
    Float4OnDevice float4s(host);
    structs.step(fountain, step_index);
    arrays.step(fountain, step_index);
    float4s.step(fountain, step_index);
    step(host, fountain, step_index);
    for (const std::vector<Particle>& device : {structs.download(), arrays.download(), float4s.download()}) {
        std::vector<glm::vec3> x, v, x_host, v_host;
        for (std::uint32_t i = 0; i < n; ++i) {
            if (before[i].position_m.y < 0.1f)
                continue;  // may reach the floor: in this step here, in the next there
            x.push_back(device[i].position_m), v.push_back(device[i].velocity_m_per_s);
            x_host.push_back(host[i].position_m), v_host.push_back(host[i].velocity_m_per_s);
        }
        // Two roundings on either side, of numbers below 8 and below 4: 4 * 2.4e-7 and 4 * 1.2e-7.
        course::check_close(v, v_host, course::Tolerance(1e-6), "velocity", "droplet");
        course::check_close(x, x_host, course::Tolerance(5e-7), "position", "droplet");
    }
}

TEST_CASE("the three layouts agree with the host's loop, whatever the number of droplets") {
    for (const char* scene : {"crown", "spray"})
        for (const std::uint32_t n : {1u, 2u, 31u, 255u, 256u, 257u, 3001u}) {
            const Fountain fountain = make_scene(scene);
            const std::uint32_t steps =
                300 + n % 200;  // in the first life for some, in the second for others
            const std::uint32_t born = born_after(fountain, n, steps);
            const std::vector<Particle> host = run_on_host(fountain, n, steps);
            check_parity(host, run_from_zeros<StructsOnDevice>(fountain, n, steps), born);
            check_parity(host, run_from_zeros<ArraysOnDevice>(fountain, n, steps), born);
            check_parity(host, run_float4(fountain, n, steps), born);
        }
}

TEST_CASE("the block size changes nothing, not one bit") {
    const Fountain fountain = make_scene("crown");
    const std::vector<Particle> expected = run_float4(fountain, 1000, 500);
    for (const unsigned threads : {1u, 31u, 32u, 33u, 100u, 1024u})
        CHECK_MESSAGE(same_bits(run_float4(fountain, 1000, 500, threads), expected), threads);
}

TEST_CASE("float4: position.w is the age, and waiting droplets keep out of sight") {
    const Fountain fountain = make_scene("crown");
    const std::uint32_t n = 1000, steps = 200, born = born_after(fountain, n, steps);
    Float4OnDevice state(n);
    for (std::uint32_t s = 0; s < steps; ++s) state.step(fountain, s);
    const std::vector<float4> position = state.position.download(), velocity = state.velocity.download();
    REQUIRE((born > 0 && born < n));
    for (std::uint32_t i = 0; i < n; ++i) {
        CHECK(velocity[i].w == 0.0f);
        if (i >= born) {
            CHECK((position[i].w == -1.0f && position[i].y == -1.0f));
            continue;
        }
        // Born in step floor(i L / n), a random part of a step early.
        const float steps_ago = float(steps - 1 - std::uint64_t(i) * life_steps(fountain) / n);
        CHECK(position[i].w >= (steps_ago - 1) * fountain.dt_s);
        CHECK(position[i].w <= (steps_ago + 2) * fountain.dt_s);
    }
    // Its exact value for one of them: the sum of 199 - steps rounded below 1 s, each by up to 3e-8.
    const float start_s = particle_loop::random_start(fountain.seed, 0, 0).u[7] * fountain.dt_s;
    CHECK_FALSE(!(std::abs(position[0].w - (start_s + 199 * fountain.dt_s)) <= 200 * 3e-8f));
}

TEST_CASE("no kernel writes behind its n droplets") {
    const Fountain fountain = make_scene("crown");
    const std::vector<float4> guard(1280, make_float4(1, 2, 3, 4));
    for (const std::uint32_t n : {0u, 1u, 255u, 256u, 1000u}) {
        course::DeviceBuffer<float4> position(guard), velocity(guard);
        launch_fountain_clear(position.data(), velocity.data(), n);
        for (std::uint32_t s = 0; s < 500; ++s)
            launch_fountain_step(position.data(), velocity.data(), n, fountain, s);
        const std::vector<float4> x = position.download(), v = velocity.download();
        CHECK(std::memcmp(&x[n], &guard[n], (guard.size() - n) * sizeof(float4)) == 0);
        CHECK(std::memcmp(&v[n], &guard[n], (guard.size() - n) * sizeof(float4)) == 0);
        if (n) CHECK(std::memcmp(&x[0], &guard[0], sizeof(float4)) != 0);
    }
}

TEST_CASE("the comparison itself notices NaN, and counts droplets that bounced elsewhere") {
    std::vector<Particle> host(10), device(10);
    device[2].position_m.x = 1e-4f;
    Parity parity = compare_positions(host, device, 10);
    CHECK((parity.largest_m > 0.9e-4 && parity.other_bounce == 0));
    device[3].position_m.z = 0.01f;
    device[4].position_m.y = std::numeric_limits<float>::quiet_NaN();
    parity = compare_positions(host, device, 10);
    CHECK(parity.other_bounce == 2);
    CHECK(parity.largest_other_m == std::numeric_limits<double>::infinity());
    CHECK(compare_positions(host, device, 3).other_bounce == 0);
}

// ------------------------------------------------------------------------------------------ what is launched

TEST_CASE("a step is one launch, the state two allocations of 16 bytes a droplet, and nothing is left") {
    course::require_simulator();
#ifdef __CUDASIM__
    const std::size_t before = cudasim::live_bytes();
    {
        cudasim::Recording recording;
        run_float4(make_scene("crown"), 1000, 50);
        CHECK(recording.count("fountain_step_float4_kernel") == 50);
        CHECK(recording.count("fountain_clear_kernel") == 1);
        CHECK(recording.launches().size() == 51);
        CHECK(recording.launches().back().grid.x == 4);
        CHECK(recording.launches().back().block.x == 256);
        CHECK(recording.allocations() == 2);
        CHECK(recording.bytes() == 32 * 1000);
    }
    CHECK(cudasim::live_bytes() == before);
    cudasim::Recording recording;  // n = 0: nothing to launch, and no error
    run_float4(make_scene("crown"), 0, 3);
    CHECK(recording.launches().empty());
    CHECK(recording.allocations() == 0);
#endif
}

TEST_CASE("the order of threads and the number of workers change nothing, not one bit") {
    course::require_simulator();
#ifdef __CUDASIM__
    const Fountain fountain = make_scene("crown");
    const std::vector<Particle> expected = run_float4(fountain, 1000, 500);
    for (const auto kind : {cudasim::Order::kReverse, cudasim::Order::kShuffled}) {
        const cudasim::OrderScope scope({kind, 3});
        CHECK(same_bits(run_float4(fountain, 1000, 500), expected));
    }
    const cudasim::WorkerScope one(1);
    CHECK(same_bits(run_float4(fountain, 1000, 500), expected));
#endif
}

// ------------------------------------------------------------------------------------------ wrong launches

TEST_CASE("1025 threads: the check throws, names file and line, and the next launch works") {
    try {
        too_many_threads();
        FAIL("no error");
    } catch (const course::CudaError& error) {
        CHECK(error.code == cudaErrorInvalidConfiguration);
        CHECK(std::string(error.what()).find("first_kernels.cuh:") != std::string::npos);
    }
    CHECK_NOTHROW(run_float4(make_scene("crown"), 100, 3));
}

TEST_CASE("1025 threads, unchecked: nothing ran, nothing was said") {
    CHECK(unchecked().find("that should be 1 is 7") != std::string::npos);
    CHECK(cudaGetLastError() == cudaSuccess);
}

TEST_CASE("a host pointer in a kernel: the simulator refuses the launch") {
    course::require_simulator();
    const course::TemporaryFolder folder;
    const course::ProgramRun run =
        course::run_program("ch03_first_kernels", "--mistake host-pointer --out " + folder.path().string());
    CHECK(run.exit_code == 1);
    CHECK_MESSAGE(run.output.find("argument 1 points to no device memory") != std::string::npos, run.output);
}

TEST_CASE("a missing guard: the simulator stops the program and names the kernel") {
    course::require_simulator();
#ifdef __SANITIZE_THREAD__
    course::skip("ThreadSanitizer builds look for races and let an overrun pass");
#endif
    const course::TemporaryFolder folder;
    const course::ProgramRun run =
        course::run_program("ch03_first_kernels", "--mistake no-guard --out " + folder.path().string());
    CHECK(run.exit_code != 0);
    CHECK_MESSAGE(run.output.find("no_guard_kernel") != std::string::npos, run.output);
    CHECK_MESSAGE(run.output.find("32000") != std::string::npos, run.output);  // bytes of the allocation
}

// ------------------------------------------------------------------------------------------------ the edges

namespace {

/// A droplet and a fountain that no scene has.
struct Extreme {
    std::string what;
    Fountain fountain = make_scene("crown");
    Particle droplet{{0.5f, 1, -2}, {1, 2, 3}};
};

std::vector<Extreme> extremes() {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    std::vector<Extreme> all;
    const auto add = [&](const std::string& what, auto&& change) {
        all.push_back({what});
        change(all.back().fountain, all.back().droplet);
    };
    add("nothing", [](Fountain&, Particle&) {});
    add("1e6 m/s", [](Fountain&, Particle& p) { p.velocity_m_per_s = {1e6f, 1e6f, -1e6f}; });
    add("dt 0", [](Fountain& f, Particle&) { f.dt_s = 0; });
    add("dt 1e-30", [](Fountain& f, Particle&) { f.dt_s = 1e-30f; });
    add("dt 1e6", [](Fountain& f, Particle&) { f.dt_s = 1e6f; });
    add("drag 0", [](Fountain& f, Particle&) { f.drag_per_s = 0; });
    add("drag 1e12", [](Fountain& f, Particle&) { f.drag_per_s = 1e12f; });
    add("10 km away", [](Fountain&, Particle& p) { p.position_m.x = 1e4f; });
    add("position nan", [=](Fountain&, Particle& p) { p.position_m.y = nan; });
    add("velocity nan", [=](Fountain&, Particle& p) { p.velocity_m_per_s.z = nan; });
    add("gravity nan", [=](Fountain& f, Particle&) { f.gravity_m_per_s2 = nan; });
    for (const float restitution : {0.0f, 1.0f, 2.0f, nan})
        add("restitution " + std::to_string(restitution), [=](Fountain& f, Particle& p) {
            f.restitution = restitution;
            p.position_m.y = 0.01f;  // 30 mm below the floor after the step
            p.velocity_m_per_s.y = -10;
        });
    return all;
}

bool is_number(const Particle& p) {
    return std::isfinite(glm::dot(p.position_m, p.position_m)) &&
           std::isfinite(glm::dot(p.velocity_m_per_s, p.velocity_m_per_s));
}

/// Both no number or the same infinity, or as near as roundings of the largest number involved bring them.
bool same_but_rounding(glm::vec3 a, glm::vec3 b) {
    const float largest = std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z), 10.0f});
    for (int k = 0; k < 3; ++k) {
        if (std::isnan(a[k]) && std::isnan(b[k])) continue;
        if (a[k] != b[k] && !(std::abs(a[k] - b[k]) <= 5e-7f * largest))
            return false;  // 4 roundings of 1.2e-7
    }
    return true;
}

}  // namespace

TEST_CASE("extremes: a step on the device does what the host's does, in each layout") {
    for (const Extreme& e : extremes()) {
        CAPTURE(e.what);
        const std::uint32_t life = life_steps(e.fountain);  // 2^32 - 1 for a time step of 0
        const std::uint32_t s = life == 0xffffffffu ? 0 : life;
        std::vector<Particle> host(300, e.droplet);
        StructsOnDevice structs(host);
        ArraysOnDevice arrays(host);
        Float4OnDevice float4s(host);
        step(host, e.fountain, s);
        structs.step(e.fountain, s);
        arrays.step(e.fountain, s);
        float4s.step(e.fountain, s);
        for (const auto& device : {structs.download(), arrays.download(), float4s.download()}) {
            int different = 0;
            for (std::size_t i = 0; i < host.size(); ++i)
                different += !same_but_rounding(device[i].position_m, host[i].position_m) ||
                             !same_but_rounding(device[i].velocity_m_per_s, host[i].velocity_m_per_s);
            CHECK(different == 0);
        }
    }
}

TEST_CASE("extremes: a droplet on the device stays a number, or is named") {
    // One droplet, and so many steps a life that it never starts again: what goes wrong has the time to.
    for (Extreme e : extremes()) {
        CAPTURE(e.what);
        if (e.what == "restitution 2.000000") e.fountain.drag_per_s = 0;  // or falls end at g / k = 28 m/s
        const bool fine = e.what == "nothing" || e.what == "dt 0" || e.what == "dt 1e-30" ||
                          e.what == "drag 0" || e.what == "restitution 0.000000" ||
                          e.what == "restitution 1.000000";
        Float4OnDevice state(std::vector<Particle>{e.droplet});
        std::string last_words;
        e.fountain.lifetime_s = e.fountain.dt_s * 1e9f;
        const std::uint32_t first = e.fountain.dt_s > 0 ? life_steps(e.fountain) : 0;
        for (std::uint32_t s = 0; s < 10000 && last_words.empty(); ++s) {
            state.step(e.fountain, first + s);
            if (s % 50 != 49) continue;
            const std::vector<Particle> now = state.download();
            try {
                watch(now, 1, e.fountain, int(s));
                CHECK(is_number(now[0]));
            } catch (const course::Unstable& error) {
                last_words = error.what();
            }
        }
        CHECK_MESSAGE(last_words.empty() == fine, last_words);
        if (!fine) CHECK_MESSAGE(last_words.find("droplet 0 is at (") != std::string::npos, last_words);
    }
}

TEST_CASE("extremes: no droplets at all, in each layout") {
    const Fountain fountain = make_scene("crown");
    const std::vector<Particle> none;
    StructsOnDevice structs(none);
    ArraysOnDevice arrays(none);
    Float4OnDevice float4s(none);
    structs.step(fountain, 0);
    arrays.step(fountain, 0);
    float4s.step(fountain, 0);
    CHECK((structs.download().empty() && arrays.download().empty() && float4s.download().empty()));
    CHECK(cudaGetLastError() == cudaSuccess);
}

TEST_CASE("more droplets than the machine can hold: exit code 2, before anything is computed") {
    const double memory = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
    if (memory > 2147483647.0 * 136) course::skip("this machine can hold them");
    const course::TemporaryFolder folder;
    const course::ProgramRun run = course::run_program(
        "ch03_first_kernels", "--particles 2147483647 --steps 1 --out " + folder.path().string());
    CHECK(run.exit_code == 2);
    CHECK_MESSAGE(run.output.find("GiB of memory") != std::string::npos, run.output);
}

TEST_CASE("bad input ends with exit code 2, an unstable run with 3") {
    const course::TemporaryFolder folder;
    const auto run = [&](const std::string& arguments) {
        return course::run_program("ch03_first_kernels", arguments + " --out " + folder.path().string());
    };
    CHECK(run("--particles 0").exit_code == 2);
    CHECK(run("--block 0").exit_code == 2);
    CHECK(run("--block 1025").output.find("from 1 to 1024 threads, not 1025") != std::string::npos);
    for (const char* arguments : {"--dt nan", "--dt 1e-30", "--dt 1e6", "--drag nan", "--drag 1e12",
                                  "--width 0", "--height 16385", "--study weather", "--stability weather"})
        CHECK_MESSAGE(run(arguments).exit_code == 2, arguments);
    CHECK(run("--mistake spelling").exit_code == 2);
    CHECK(run("--window").exit_code == 2);
    const course::ProgramRun unstable = run("--particles 100 --drag 50 --dt 0.1");
    CHECK(unstable.exit_code == 3);
    CHECK(unstable.output.find("over the limit 2 / drag = 0.04 s") != std::string::npos);
    CHECK(std::filesystem::exists(folder.path() / "result.json"));
    // By the time somebody looks, after 50 steps, the numbers are none any more.
    const course::ProgramRun late = run("--particles 100 --drag 900000 --dt 0.004");
    CHECK(late.exit_code == 3);
    CHECK_MESSAGE(late.output.find("step 49: droplet 0") != std::string::npos, late.output);
    CHECK(late.output.find("over the limit 2 / drag") != std::string::npos);
    for (const char* arguments : {"--particles 1 --steps 2 --width 64 --height 64",
                                  "--particles 2 --steps 500 --width 16 --height 16",
                                  "--particles 300 --steps 0 --width 64 --height 64",
                                  "--particles 300 --drag 0 --steps 50 --width 2048 --height 16"}) {
        const course::ProgramRun small = run(arguments);
        CHECK_MESSAGE(small.exit_code == 0, small.output);
        CHECK(std::filesystem::exists(folder.path() / "fountain.png"));
    }
}

// ---------------------------------------------------------------------------------------------- the studies

TEST_CASE("study layout: a life on the device ends where the host's does") {
    course::Study study({"layout", "?", "m", "n"}, "03_first_kernels", true);
    add_layouts(study, make_scene("crown"), 1000);
    REQUIRE(study.rows().size() == 4);
    for (const course::StudyRow& row : study.rows()) CHECK_FALSE(!(row.error <= kRoundingBound_m));
    // And a wrong answer would not pass: another fountain's droplets are somewhere else.
    const std::vector<Particle> crown = run_on_host(make_scene("crown"), 1000, 600);
    CHECK_FALSE(!(parity_error_m(crown, run_float4(make_scene("spray"), 1000, 600)) > 0.1));
}

TEST_CASE("study copies: a state that travels stays what it was") {
    const Fountain fountain = make_scene("crown");
    const std::vector<Particle> start = at_the_nozzle(fountain, 1000);
    for (const Copies copies : {Copies::none, Copies::to_host, Copies::there_and_back}) {
        Float4OnDevice travels(start), stays(start);
        std::vector<std::vector<float4>> host{travels.position.download(), travels.velocity.download()};
        for (std::uint32_t s = 500; s < 520; ++s) {
            step_with_copies(travels, host, copies, fountain, s);
            stays.step(fountain, s);
        }
        CHECK(different_elements(travels, stays) == 0);
        stays.step(fountain, 520);
        CHECK(different_elements(travels, stays) > 1000);
    }
}

TEST_CASE("stability map drag: on the device, too, the limit is 2 / k") {
    for (const float drag : {0.35f, 350.0f, 35000.0f}) {
        CHECK(drag_is_stable_on_device(drag, 0.99f * 2 / drag));
        CHECK_FALSE(drag_is_stable_on_device(drag, 1.01f * 2 / drag));
        CHECK_FALSE(drag_is_stable_on_device(drag, 1e4f * 2 / drag));  // to infinity, and on to NaN
    }
}

TEST_CASE("the program's studies and its stability map say where their kernels ran") {
    const course::TemporaryFolder folder;
    const std::string out = " --quick --out " + folder.path().string();
    const std::string backend = course::on_simulator() ? "simulator" : "cuda";
    const course::ProgramRun copies = course::run_program("ch03_first_kernels", "--study copies" + out);
    CHECK_MESSAGE(copies.exit_code == 0, copies.output);
    CHECK_MESSAGE(copies.output.find("Times: " + backend) != std::string::npos, copies.output);
    CHECK(course::run_program("ch03_first_kernels", "--stability drag" + out).exit_code == 0);
    CHECK(std::filesystem::exists(folder.path() / "study_copies.csv"));
    CHECK(std::filesystem::exists(folder.path() / "stability_drag.csv"));
}
