/// @file
/// A body of particles seen by the numbers its particles were made with, whatever order it keeps them in.
#pragma once
#include <cuda_runtime.h>

#include <cstdint>
#include <vector>

#include "common/device_buffer.h"

namespace spring_mass {

/// Values by particle number.
/// @param body    whose ids()[k] is the number of the particle at place k
/// @param buffer  one of its arrays
template <class Body, class T>
std::vector<T> by_id(const Body& body, const course::DeviceBuffer<T>& buffer) {
    const std::vector<T> values = buffer.download();
    const std::vector<std::uint32_t> ids = body.ids().download();
    std::vector<T> sorted(values.size());
    for (std::size_t k = 0; k < ids.size(); ++k) sorted[ids[k]] = values[k];
    return sorted;
}

//! [state_hash]
/// 64-bit FNV-1a hash of all positions and velocities, by particle number. Equal states have equal hashes;
/// one different bit anywhere gives another.
template <class Body>
std::uint64_t state_hash(const Body& body) {
    const std::vector<float4> x = by_id(body, body.positions()), v = by_id(body, body.velocities());
    std::uint64_t hash = 0xcbf29ce484222325u;
    const auto add = [&hash](float4 value) {
        unsigned char bytes[sizeof value];
        __builtin_memcpy(bytes, &value, sizeof value);
        for (unsigned char byte : bytes) hash = (hash ^ byte) * 0x100000001b3u;
    };
    for (std::uint32_t i = 0; i < body.size(); ++i) {
        add(x[i]);
        add(v[i]);
    }
    return hash;
}
//! [state_hash]

}  // namespace spring_mass
