#pragma once
// SPIR-V: where it comes from and what it declares.

#include "engine/gpu/gpu.h"

namespace gpu
{

struct SpecializationConstant {
    std::string name; // those of an unnamed local size: "local_size_x", ...
    uint32_t id = 0;  // layout(constant_id = ...)
    uint32_t defaultValue = 0;
};

// A number in a shader that a specialisation constant may set.
struct Extent {
    uint32_t literal = 1;
    std::optional<uint32_t> constantId;
};

// An array, matrix or vector in shared memory.
struct SharedVariable {
    uint64_t elementBytes = 0;
    std::vector<Extent> dimensions;
};

struct Reflection {
    std::vector<Binding> bindings; // sorted by (set, binding)
    std::vector<SpecializationConstant> constants;
    std::array<Extent, 3> workgroupSize;
    std::vector<SharedVariable> shared;
};

// `tablesAreTexelBuffers` says how to recognize a table. Throws Error when it is not a compute shader we understand.
Reflection reflect(std::span<const uint32_t> spirv, const std::string& label, bool tablesAreTexelBuffers);

// The embedded shader `name`, or the file `name`.<flavor>.spv if that contains a slash. Throws Error when there is
// none.
std::vector<uint32_t> loadShader(const std::string& name, bool tablesAreTexelBuffers);

} // namespace gpu
