// What the simulator costs: kernels against the same work as a plain C++ loop on as many threads, in
// processor time of the whole process. Kernel and loop take turns, and of the times of each the lower
// quartile counts: other programs on the machine then disturb both alike, or neither. `--check` ends with 1
// when a ratio is over its limit.
#include <time.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <thread>
#include <vector>

#include "common/cuda_check.h"
#include "common/device_buffer.h"
#include "tests/cudasim/simulator.h"

using course::DeviceBuffer;

namespace {

// ---- the work, as a kernel and as a loop
// ------------------------------------------------------------------------

/// What each of a particle's neighbours adds: a term as in SPH's density sum.
__host__ __device__ inline float neighbour_term(float4 here, float4 there) {
    const float x = here.x - there.x, y = here.y - there.y, z = here.z - there.z;
    const float q = 1.0f - (x * x + y * y + z * z);
    return q > 0 ? there.w * q * q * q : 0;
}

constexpr int kWindow = 48;  // candidates on either side, about what 27 cells hold of particles

__host__ __device__ inline float density_of(int i, const float4* particles, int n) {
    const int begin = i < kWindow ? 0 : i - kWindow, end = i + kWindow < n ? i + kWindow : n;
    float sum = 0;
    for (int j = begin; j < end; ++j) sum += neighbour_term(particles[i], particles[j]);
    return sum;
}

__global__ void neighbours_kernel(float* density, const float4* particles, int n) {
    const int i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i < n) density[i] = density_of(i, particles, n);
}
__attribute__((noinline)) void neighbours_loop(int begin, int end, float* density, const float4* particles,
                                               int n) {
    for (int i = begin; i < end; ++i) density[i] = density_of(i, particles, n);
}

__global__ void stream_kernel(float* y, const float* x, float a, int n) {
    const int i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i < n) y[i] = a * x[i] + y[i];
}
__attribute__((noinline)) void stream_loop(int begin, int end, float* y, const float* x, float a) {
    for (int i = begin; i < end; ++i) y[i] = a * x[i] + y[i];
}

/// Pull of body b on body a, softened.
__host__ __device__ inline void add_pull(float3& sum, float4 a, float4 b) {
    const float x = b.x - a.x, y = b.y - a.y, z = b.z - a.z;
    const float inverse = rsqrtf(x * x + y * y + z * z + 0.01f), strength = b.w * inverse * inverse * inverse;
    sum.x += x * strength;
    sum.y += y * strength;
    sum.z += z * strength;
}

template <int kTile>
__global__ void tiled_kernel(float4* pull, const float4* bodies, int n) {
    __shared__ float4 tile[kTile];
    const int i = blockIdx.x * kTile + threadIdx.x;
    const float4 here = bodies[i];
    float3 sum = make_float3(0, 0, 0);
    for (int first = 0; first < n; first += kTile) {
        tile[threadIdx.x] = bodies[first + threadIdx.x];
        __syncthreads();
        for (int k = 0; k < kTile; ++k) add_pull(sum, here, tile[k]);
        __syncthreads();
    }
    pull[i] = make_float4(sum.x, sum.y, sum.z, 0);
}
__attribute__((noinline)) void all_pairs_loop(int begin, int end, float4* pull, const float4* bodies, int n) {
    for (int i = begin; i < end; ++i) {
        const float4 here = bodies[i];
        float3 sum = make_float3(0, 0, 0);
        for (int k = 0; k < n; ++k) add_pull(sum, here, bodies[k]);
        pull[i] = make_float4(sum.x, sum.y, sum.z, 0);
    }
}

__global__ void empty_kernel() {}
__global__ void nearly_empty_kernel(int* out, int never) {
    if (static_cast<int>(threadIdx.x) == never) *out = 1;
}
__global__ void barriers_kernel(int count) {
    for (int k = 0; k < count; ++k) __syncthreads();
}
__global__ void shuffles_kernel(int* out, int count) {
    int value = static_cast<int>(threadIdx.x);
    for (int k = 0; k < count; ++k) value = __shfl_xor_sync(0xffffffffu, value, 1);
    out[threadIdx.x] = value;
}

// ---- measuring
// --------------------------------------------------------------------------------------------------

double processor_seconds() {
    timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Plain loops get what kernels get: one thread for each worker. `loop` is called with a part of 0 ... n - 1.
void on_all_threads(int n, const std::function<void(int, int)>& loop) {
    cudaDeviceProp device;
    CUDA_CHECK(cudaGetDeviceProperties(&device, 0));
    const int threads = device.multiProcessorCount, part = (n + threads - 1) / threads;
    std::vector<std::thread> others;
    for (int begin = part; begin < n; begin += part)
        others.emplace_back([=, &loop] { loop(begin, std::min(n, begin + part)); });
    loop(0, std::min(n, part));
    for (std::thread& other : others) other.join();
}

double seconds_of(const std::function<void()>& work) {
    const double start = processor_seconds();
    work();
    return processor_seconds() - start;
}

double lower_quartile(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 4];
}

bool all_good = true;

void compare(const char* name, double limit, int repeats, const std::function<void()>& kernel,
             const std::function<void()>& loop) {
    std::vector<double> kernel_s, loop_s;
    kernel();
    loop();
    for (int r = 0; r < repeats; ++r) {
        kernel_s.push_back(seconds_of(kernel));
        loop_s.push_back(seconds_of(loop));
    }
    CUDA_CHECK(cudaGetLastError());
    const double k = lower_quartile(kernel_s), l = lower_quartile(loop_s), ratio = k / l;
    const bool good = ratio <= limit;
    all_good = all_good && good;
    std::printf("%-44s %9.2f ms %9.2f ms %7.2f %7.1f%s\n", name, k * 1e3, l * 1e3, ratio, limit,
                good ? "" : "  OVER THE LIMIT");
}

void fixed_cost(const char* name, double per, const std::function<void()>& work) {
    std::vector<double> times;
    for (int r = 0; r < 9; ++r) times.push_back(seconds_of(work));
    std::printf("%-44s %9.1f ns\n", name, lower_quartile(times) / per * 1e9);
}

std::vector<float4> points(int n) {
    std::vector<float4> result(n);
    for (int i = 0; i < n; ++i)
        result[i] = make_float4(std::sin(0.1f * i), std::cos(1.3f * i), std::sin(0.7f * i), 1);
    return result;
}

}  // namespace

int main(int count, char** arguments) {
    std::printf("%-44s %12s %12s %7s %7s\n", "processor time", "kernel", "plain loop", "ratio", "limit");
    {
        const int n = 1 << 16;
        const std::vector<float4> host = points(n);
        const DeviceBuffer<float4> particles(host);
        DeviceBuffer<float> density(n);
        std::vector<float> plain(n);
        compare(
            "neighbour loop, 96 candidates a particle", 1.3, 15,
            [&] { neighbours_kernel<<<n / 256, 256>>>(density.data(), particles.data(), n); },
            [&] {
                on_all_threads(n, [&](int begin, int end) {
                    neighbours_loop(begin, end, plain.data(), host.data(), n);
                });
            });
    }
    {
        const int n = 1 << 25;  // two arrays of 128 MiB: beyond any cache
        DeviceBuffer<float> x(n), y(n);
        std::vector<float> plain_x(n, 1.0f), plain_y(n, 0.0f);
        x.upload(plain_x);
        y.upload(plain_y);
        compare(
            "streaming, y = a x + y beyond the cache", 2.5, 15,
            [&] { stream_kernel<<<n / 256, 256>>>(y.data(), x.data(), 0.5f, n); },
            [&] {
                on_all_threads(n, [&](int begin, int end) {
                    stream_loop(begin, end, plain_y.data(), plain_x.data(), 0.5f);
                });
            });
    }
    {
        const int n = 4096;
        const std::vector<float4> host = points(n);
        const DeviceBuffer<float4> bodies(host);
        DeviceBuffer<float4> pull(n);
        std::vector<float4> plain(n);
        compare(
            "tiles and barriers, 256 threads a block", 1.5, 9,
            [&] { tiled_kernel<256><<<n / 256, 256>>>(pull.data(), bodies.data(), n); },
            [&] {
                on_all_threads(
                    n, [&](int begin, int end) { all_pairs_loop(begin, end, plain.data(), host.data(), n); });
            });
    }
    std::printf("\nfixed costs\n");
    DeviceBuffer<int> out(1024);
    const int launches = 1000;
    fixed_cost("launch of one block of one thread", launches, [&] {
        for (int k = 0; k < launches; ++k) empty_kernel<<<1, 1>>>();
    });
    fixed_cost("launch of 64 blocks", launches, [&] {
        for (int k = 0; k < launches; ++k) empty_kernel<<<64, 1>>>();
    });
    fixed_cost("thread", 1e7, [&] { nearly_empty_kernel<<<10000, 1000>>>(out.data(), -1); });
    fixed_cost("thread and barrier", 256 * 1000 * 4, [&] { barriers_kernel<<<4, 256>>>(1000); });
    fixed_cost("thread and shuffle", 256 * 1000 * 4, [&] { shuffles_kernel<<<4, 256>>>(out.data(), 1000); });
    CUDA_CHECK(cudaGetLastError());
    const bool check = count > 1 && std::strcmp(arguments[1], "--check") == 0;
    return check && !all_good ? 1 : 0;
}
