/// @file
/// Reads what stands behind the word `__shared__`.
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace cudasim {

/// Names that a declaration such as "float4 tile[256], sums[8]" declares; nothing if it is not understood.
std::optional<std::vector<std::string>> declared_names(const std::string& declaration);

/// A declaration without size, such as "float tile[]", that `extern __shared__` stood before.
struct DynamicArray {
    std::string type, name;
};
std::optional<DynamicArray> dynamic_array(const std::string& declaration);

}  // namespace cudasim
