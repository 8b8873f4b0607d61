#pragma once
// SPIR-V as a list of instructions, for what SPIRV-Tools has no pass for.

#include <cstddef>
#include <cstdint>
#include <span>

#include <spirv_cross/spirv_cross_c.h>

namespace gpu
{

constexpr size_t SPIRV_HEADER_WORDS = 5;

// visit(opcode, the instruction's words, where it begins) for each instruction of a module that is known to be
// well-formed.
template <class Visit>
void forEachInstruction(std::span<const uint32_t> spirv, Visit&& visit)
{
    for (size_t at = SPIRV_HEADER_WORDS; at < spirv.size();) {
        const size_t words = spirv[at] >> SpvWordCountShift;
        visit(SpvOp(spirv[at] & SpvOpCodeMask), spirv.subspan(at, words), at);
        at += words;
    }
}

} // namespace gpu
