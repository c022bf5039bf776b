/// @file
/// Time of kernels, measured on the device by events. On the simulator it is the time of the CPU that runs
/// them.
#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "common/cuda_check.h"

namespace course {

/// Stop watch between two points of the default stream.
class GpuTimer {
  public:
    GpuTimer() {
        CUDA_CHECK(cudaEventCreate(&start_));
        CUDA_CHECK(cudaEventCreate(&stop_));
    }
    GpuTimer(const GpuTimer&) = delete;
    GpuTimer& operator=(const GpuTimer&) = delete;
    ~GpuTimer() {
        cudaEventDestroy(start_);
        cudaEventDestroy(stop_);
    }
    void start() { CUDA_CHECK(cudaEventRecord(start_)); }
    /// Waits for everything since start() and returns its milliseconds.
    float stop() {
        CUDA_CHECK(cudaEventRecord(stop_));
        CUDA_CHECK(cudaEventSynchronize(stop_));
        float milliseconds = 0;
        CUDA_CHECK(cudaEventElapsedTime(&milliseconds, start_, stop_));
        return milliseconds;
    }

  private:
    cudaEvent_t start_{}, stop_{};
};

/// Median milliseconds of `repeats` calls of `work`, after one warm-up call.
template <class Work>
float median_milliseconds(int repeats, Work&& work) {
    GpuTimer timer;
    std::vector<float> times;
    work();
    for (int k = 0; k < repeats; ++k) {
        timer.start();
        work();
        times.push_back(timer.stop());
    }
    std::nth_element(times.begin(), times.begin() + times.size() / 2, times.end());
    return times[times.size() / 2];
}

/// Name of the device the kernels run on, as the runtime gives it.
inline std::string device_name() {
    cudaDeviceProp properties;
    CUDA_CHECK(cudaGetDeviceProperties(&properties, 0));
    return properties.name;
}

/// False where kernels run on the simulator.
inline bool is_gpu() {
    return device_name().find("simulator") == std::string::npos;
}

/// Says of a Study or a StabilityMap that its kernels ran on the device.
template <class Measured>
void on_device(Measured& measured) {
    measured.device = device_name();
    measured.backend = is_gpu() ? "cuda" : "simulator";
}

}  // namespace course
