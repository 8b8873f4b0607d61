// The pass that forbids contraction, on all of the product's shaders: read back as text, by SPIRV-Tools.

#include <filesystem>
#include <set>
#include <sstream>

#include <gtest/gtest.h>
#include <spirv-tools/libspirv.hpp>

#include "engine/gpu/shader.h"

namespace
{

using Words = std::vector<uint32_t>;

// What a shader's text says: results that round, results that are decorated, and all lines but decorations.
struct Findings {
    std::set<std::string> arithmetic, decorated;
    std::vector<std::string> rest;
};

Findings look(const Words& spirv)
{
    static const std::set<std::string> rounding = {"OpFAdd",
                                                   "OpFSub",
                                                   "OpFMul",
                                                   "OpFDiv",
                                                   "OpFRem",
                                                   "OpFMod",
                                                   "OpFNegate",
                                                   "OpDot",
                                                   "OpOuterProduct",
                                                   "OpVectorTimesScalar",
                                                   "OpMatrixTimesScalar",
                                                   "OpVectorTimesMatrix",
                                                   "OpMatrixTimesVector",
                                                   "OpMatrixTimesMatrix"};
    std::string text;
    EXPECT_TRUE(
        spvtools::SpirvTools(SPV_ENV_VULKAN_1_2)
            .Disassemble(spirv, &text, SPV_BINARY_TO_TEXT_OPTION_NO_HEADER | SPV_BINARY_TO_TEXT_OPTION_FRIENDLY_NAMES));
    Findings found;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string first, second, third, type;
        words >> first >> second >> third >> type;
        if (first == "OpDecorate" && third == "NoContraction") {
            EXPECT_TRUE(found.decorated.insert(second).second) << "twice: " << line;
            continue;
        }
        found.rest.push_back(line);
        const bool extended = third == "OpExtInst" && type.ends_with("float");    // %float, %v3float
        if (rounding.contains(third) || extended) found.arithmetic.insert(first); // "first = third type ..."
    }
    return found;
}

TEST(Contraction, IsForbiddenInEachOperationOfAllShadersAndNothingElseChanges)
{
    size_t shaders = 0, operations = 0;
    for (const auto& file : std::filesystem::directory_iterator(TRICHROME_SOURCE_DIR "/shaders")) {
        if (file.path().extension() != ".comp") continue;
        for (const bool texel : {true, false}) {
            const std::string name = file.path().stem();
            const Words before = gpu::loadShader(name, texel), after = gpu::withoutContraction(before);
            const spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_2);
            EXPECT_TRUE(tools.Validate(after)) << name;
            const Findings was = look(before), is = look(after);
            std::set<std::string> expected = is.arithmetic;
            expected.insert(was.decorated.begin(), was.decorated.end()); // indices of what is `precise`, too
            EXPECT_EQ(is.decorated, expected) << name;
            EXPECT_EQ(is.rest, was.rest) << name;
            EXPECT_EQ(gpu::withoutContraction(after), after) << name;
            ++shaders;
            operations += is.decorated.size();
        }
    }
    EXPECT_GE(shaders, 22u);
    EXPECT_GT(operations, 5'000u);
}

// As SPIRV-Tools simplifies them afterwards: what it makes of such operations may not be contracted either.
TEST(Contraction, StaysForbiddenInSimplifiedShaders)
{
    const Words spirv = gpu::withoutContraction(gpu::loadShader("temporal", false));
    const gpu::Constant reservoirs{"RESERVOIR_COUNT", 3u};
    const gpu::Reflection shader = gpu::reflect(spirv, "test", false, std::span(&reservoirs, 1));
    const Findings found = look(gpu::simplified(spirv, "test", shader.constants));
    EXPECT_GT(found.arithmetic.size(), 100u);
    EXPECT_EQ(found.decorated, found.arithmetic);
}

} // namespace
