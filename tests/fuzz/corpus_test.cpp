// Every seed, and every file that fuzzing once failed on (tests/fuzz/corpus/TARGET/), without a fuzzer.

#include "tests/fuzz/targets.h"

#include "engine/base/files.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace
{

class Corpus : public testing::TestWithParam<fuzz::Target>
{
};

std::vector<std::vector<std::byte>> corpus(const std::string& target)
{
    std::vector<std::vector<std::byte>> inputs;
    const std::filesystem::path folder = std::filesystem::path(TRICHROME_SOURCE_DIR) / "tests/fuzz/corpus" / target;
    if (!std::filesystem::exists(folder)) return inputs;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) inputs.push_back(files::read(entry.path()));
    return inputs;
}

TEST_P(Corpus, SeedsAreAcceptedAndNothingCrashesAlsoCutShort)
{
    std::vector<std::vector<std::byte>> inputs = fuzz::seeds(GetParam().name);
    for (const auto& seed : inputs) EXPECT_TRUE(GetParam().run(seed));
    for (const auto& input : corpus(GetParam().name)) inputs.push_back(input);
    EXPECT_FALSE(inputs.empty());
    for (const auto& input : inputs) {
        GetParam().run(input);
        for (size_t part = 0; part < 16; ++part) GetParam().run(std::span(input).first(input.size() * part / 16));
    }
}

INSTANTIATE_TEST_SUITE_P(Targets, Corpus, testing::ValuesIn(fuzz::targets().begin(), fuzz::targets().end()),
                         [](const auto& target) {
                             std::string name = target.param.name;
                             std::erase(name, '-');
                             return name;
                         });

} // namespace
