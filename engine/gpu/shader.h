#pragma once
// SPIR-V: where it comes from and what it declares.

#include "engine/gpu/gpu.h"

#include <filesystem>
#include <map>

namespace gpu
{

// A compute shader with its specialisation constants set.
struct Reflection {
    std::vector<Binding> bindings;                          // sorted by (set, binding)
    std::map<uint32_t, uint32_t> constants;                 // value by constant_id
    std::array<uint32_t, 3> workgroupSize = {1, 1, 1};      // invocations
    std::array<std::string, 3> workgroupSizeConstants = {}; // the names of the constants that set it, if any do
    uint64_t sharedBytes = 0;
    std::vector<uint32_t> pruned; // the shader without constants, and without what their values rule out
};

// Constants that the shader lacks are ignored; an unnamed local_size_x_id is called "local_size_x".
// `tablesAreTexelBuffers` says how to recognize a table. Throws Error when it is not a compute shader we understand.
Reflection reflect(std::span<const uint32_t> spirv, const std::string& label, bool tablesAreTexelBuffers,
                   std::span<const Constant> constants);

// The same shader, of which no product and sum may become one operation, and no sum be reordered: each of its
// operations on numbers rounds as IEEE 754 says, in every pipeline alike.
std::vector<uint32_t> withoutContraction(std::span<const uint32_t> spirv);

// The same shader with these values of its constants (by constant_id), inlined and without what they leave unused;
// without subgroup arithmetic's name, too, if that is.
std::vector<uint32_t> simplified(std::span<const uint32_t> spirv, const std::string& label,
                                 const std::map<uint32_t, uint32_t>& constants);

// The embedded shader `name`, or the file `name`.<flavor>.spv if that contains a slash. Throws Error when there is
// none.
std::vector<uint32_t> loadShader(const std::string& name, bool tablesAreTexelBuffers);

// Compiles a .comp file as the build does: the same includes (`directory`, `directory`/path), macros and target.
// Throws Error with the compiler's message.
std::vector<uint32_t> compileShader(const std::filesystem::path& source, const std::filesystem::path& directory,
                                    bool tablesAreTexelBuffers);

} // namespace gpu
