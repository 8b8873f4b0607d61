// Forbids drivers to contract: a pass over SPIR-V, since SPIRV-Tools has none.

#include "engine/gpu/instructions.h"
#include "engine/gpu/shader.h"

#include <unordered_set>

namespace gpu
{

namespace
{

// Whose results may round otherwise when two become one. Of the extended instructions, which drivers make of such ones,
// all.
bool isArithmetic(SpvOp opcode)
{
    switch (opcode) {
    case SpvOpFNegate:
    case SpvOpFAdd:
    case SpvOpFSub:
    case SpvOpFMul:
    case SpvOpFDiv:
    case SpvOpFRem:
    case SpvOpFMod:
    case SpvOpVectorTimesScalar:
    case SpvOpMatrixTimesScalar:
    case SpvOpVectorTimesMatrix:
    case SpvOpMatrixTimesVector:
    case SpvOpMatrixTimesMatrix:
    case SpvOpOuterProduct:
    case SpvOpDot:
    case SpvOpExtInst: return true;
    default: return false;
    }
}

} // namespace

std::vector<uint32_t> withoutContraction(std::span<const uint32_t> spirv)
{
    constexpr uint32_t DECORATION_WORDS = 3;
    std::unordered_set<uint32_t> floats;    // types of floats, and of vectors and matrices of them
    std::unordered_set<uint32_t> decorated; // results that are `precise` already
    std::vector<uint32_t> decorations;
    size_t types = 0; // where they begin and decorations end
    forEachInstruction(spirv, [&](SpvOp opcode, std::span<const uint32_t> words, size_t at) {
        if (opcode == SpvOpDecorate && words[2] == SpvDecorationNoContraction) decorated.insert(words[1]);
        if (types == 0 && opcode >= SpvOpTypeVoid && opcode <= SpvOpTypeForwardPointer) types = at;
        const bool composed = opcode == SpvOpTypeVector || opcode == SpvOpTypeMatrix;
        if (opcode == SpvOpTypeFloat || (composed && floats.contains(words[2]))) floats.insert(words[1]);
        if (!isArithmetic(opcode) || !floats.contains(words[1]) || decorated.contains(words[2])) return;
        decorations.insert(decorations.end(), {DECORATION_WORDS << SpvWordCountShift | SpvOpDecorate, words[2],
                                               SpvDecorationNoContraction});
    });
    std::vector<uint32_t> result(spirv.begin(), spirv.end());
    result.insert(result.begin() + std::ptrdiff_t(types), decorations.begin(), decorations.end());
    return result;
}

} // namespace gpu
