// Exercise 09.2: who is held by how many?
//
// A heap of marbles stands because its marbles hold each other. Count the contacts of each marble, and find
// out how many carry nothing at all: those that touch nobody ("rattlers", in a heap at rest) and those that
// hang in the air. Without friction a heap at rest needs six contacts per marble on average, one for each way
// to move and its opposite; with friction four are enough.
//
// The list of neighbours knows whom to ask: those within diameter + skin when it was made. Not all of them
// touch.
#pragma once
#include <glm/geometric.hpp>

#include "09_water_spring_mass/marbles.cuh"
#include "common/todo.h"

namespace spring_mass {

// One thread per marble: with how many others is it in contact, how hard is the deepest pressed?
// Contact: the centres are less than a diameter apart. Walls are not counted.
// @param contacts, deepest_m  results for each place; deepest_m is 0 without any contact
inline __global__ void coordination_kernel(std::uint32_t* contacts, float* deepest_m, const float4* position,
                                           NeighbourList list, float diameter_m, std::uint32_t n) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n) return;
    // TODO(9.2): list.for_each_near asks a question of all candidates and visits those for which the answer
    // is yes. About 10 lines.
    // <solution>
    const glm::vec3 x = grid::xyz(position[i]);
    std::uint32_t count = 0;
    float deepest = 0;
    const auto touches = [&](std::uint32_t j) {
        const glm::vec3 apart = x - grid::xyz(position[j]);
        return glm::dot(apart, apart) < diameter_m * diameter_m;
    };
    list.for_each_near(i, touches, [&](std::uint32_t j) {
        ++count;
        deepest = fmaxf(deepest, diameter_m - glm::length(x - grid::xyz(position[j])));
    });
    contacts[i] = count;
    deepest_m[i] = deepest;
    // <stub>
    //| (void)position, (void)list, (void)diameter_m;
    //| contacts[i] = std::uint32_t(course::kTodo);
    //| deepest_m[i] = float(course::kTodo);
    // </solution>
}

// Contacts of each marble by its number, and how many marbles have none.
struct Coordination {
    std::vector<std::uint32_t> contacts;
    std::vector<float> deepest_m;
    std::uint32_t alone = 0;
};

inline Coordination coordination(const Marbles& marbles) {
    const std::uint32_t n = marbles.size();
    Coordination result;
    if (n == 0) return result;
    course::DeviceBuffer<std::uint32_t> contacts(n);
    course::DeviceBuffer<float> deepest_m(n);
    coordination_kernel<<<grid::blocks_for(n, 64), 64>>>(contacts.data(), deepest_m.data(),
                                                         marbles.position(), marbles.list(),
                                                         marbles.material().diameter_m, n);
    CUDA_CHECK(cudaGetLastError());
    // TODO(9.2): the kernel's results lie in the order in which the marbles are kept, sorted by cell. Bring
    // them into the order of their numbers; marbles.ids() tells whose is whose. About 8 lines.
    // <solution>
    const auto counted = contacts.download();
    const auto pressed = deepest_m.download();
    const auto ids = marbles.ids().download();
    result.contacts.resize(n);
    result.deepest_m.resize(n);
    for (std::uint32_t place = 0; place < n; ++place) {
        result.contacts[ids[place]] = counted[place];
        result.deepest_m[ids[place]] = pressed[place];
        result.alone += counted[place] == 0;
    }
    // <stub>
    //| result.contacts.assign(n, std::uint32_t(course::kTodo));
    //| result.deepest_m.assign(n, float(course::kTodo));
    //| result.alone = std::uint32_t(course::kTodo);
    // </solution>
    return result;
}

}  // namespace spring_mass
