#include "runtime/report.h"

namespace cudasim {

thread_local const LaunchRequest* running_launch = nullptr;

void say(const std::string& message) {
    std::string text = "cudasim: ";
    for (const char c : message) {
        text += c;
        if (c == '\n') text += "cudasim:   ";
    }
    text += '\n';
    std::fputs(text.c_str(), stderr);
}

std::string text_of(uint3 index) {
    return "(" + std::to_string(index.x) + "," + std::to_string(index.y) + "," + std::to_string(index.z) +
           ")";
}

std::string text_of(const char* file, int line) {
    return std::string(file) + ":" + std::to_string(line);
}

std::string text_of(const LaunchRequest& launch) {
    return std::string("kernel ") + launch.kernel + " (launched at " + text_of(launch.file, launch.line) +
           ")";
}

std::string running_block_text() {
    return text_of(*running_launch) + ", block " + text_of(blockIdx);
}

std::string running_thread_text() {
    return running_block_text() + ", thread " + text_of(threadIdx);
}

uint3 thread_index_of(unsigned number) {
    return {number % blockDim.x, number / blockDim.x % blockDim.y, number / (blockDim.x * blockDim.y)};
}

}  // namespace cudasim
