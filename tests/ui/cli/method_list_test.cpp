// Lists of methods on the command line: what they mean and what they refuse.

#include "ui/cli/method_list.h"

#include "tests/support/program.h"
#include "ui/cli/usage_error.h"

#include <gtest/gtest.h>

namespace
{

std::string complaint(const std::string& list, const passes::Settings& base = {})
{
    try {
        ui::readMethods(list, base);
        return "";
    } catch (const ui::UsageError& error) {
        return error.what();
    }
}

} // namespace

TEST(MethodList, AppliesEachEntryOnTopOfTheCommonSettings)
{
    passes::Settings base;
    base.maxConfidence = 7;
    base.width = 11;
    const auto methods =
        ui::readMethods("pt,restir-pt:replay,rgb-restir:spatial=0:max-confidence=64,restir-pt:color=chosen", base);
    ASSERT_EQ(methods.size(), 4u);
    EXPECT_EQ(methods[0].name, "pt");
    EXPECT_EQ(methods[0].settings, base);
    EXPECT_EQ(methods[1].settings.method, passes::Method::RestirPt);
    EXPECT_EQ(methods[1].settings.shift, passes::Shift::Replay);
    EXPECT_EQ(methods[1].settings.maxConfidence, 7u);
    EXPECT_EQ(methods[2].name, "rgb-restir:spatial=0:max-confidence=64");
    EXPECT_EQ(methods[2].settings.method, passes::Method::RgbRestir);
    EXPECT_EQ(methods[2].settings.spatial, 0u);
    EXPECT_EQ(methods[2].settings.maxConfidence, 64u);
    EXPECT_EQ(methods[2].settings.width, 11u);
    EXPECT_EQ(methods[2].settings.color, base.color);
    EXPECT_EQ(methods[3].settings.color, passes::Color::Chosen);
}

TEST(MethodList, AllIsEveryPictureThatThereIs)
{
    std::vector<std::string> names;
    for (const auto& method : ui::readMethods("all", {})) names.push_back(method.name);
    std::vector<std::string> expected = {"pt"};
    for (const char* method :
         {"restir-pt:color=chosen", "restir-pt:color=weighted", "restir-pt:color=variate", "rgb-restir",
          "grouped-restir:color=chosen", "grouped-restir:color=weighted", "grouped-restir:color=variate"})
        for (const char* mutate : {"", ":mutate=free"}) expected.push_back(method + std::string(mutate));
    EXPECT_EQ(names, expected);
}

TEST(MethodList, TakesPresets)
{
    const TemporaryDirectory directory;
    const std::string file = directory / "long.json";
    writeFile(file, R"({"method": "rgb-restir", "max-confidence": 500})");
    const auto methods = ui::readMethods(file + ":spatial=1", {});
    EXPECT_EQ(methods[0].settings.method, passes::Method::RgbRestir);
    EXPECT_EQ(methods[0].settings.maxConfidence, 500u);
    EXPECT_EQ(methods[0].settings.spatial, 1u);
    const auto named = ui::readMethods("pt,paper:max-confidence=8", {}); // the program's own
    EXPECT_EQ(named[1].settings.method, passes::Method::RgbRestir);
    EXPECT_EQ(named[1].settings.shift, passes::Shift::Replay);
    EXPECT_EQ(named[1].settings.maxConfidence, 8u);
}

TEST(MethodList, RefusesWhatCannotBeCompared)
{
    EXPECT_NE(complaint("").find("\"\" is no method"), std::string::npos);
    EXPECT_NE(complaint("pt,").find("\"\" is no method"), std::string::npos);
    EXPECT_NE(complaint("metropolis").find("metropolis"), std::string::npos);
    EXPECT_NE(complaint("restir-pt:sideways").find("sideways"), std::string::npos);
    EXPECT_NE(complaint("restir-pt:spatial=99").find("99"), std::string::npos);
    EXPECT_NE(complaint("missing.json").find("missing.json"), std::string::npos);
    EXPECT_NE(complaint("pt,restir-pt,pt").find("twice"), std::string::npos);
    for (const char* other : {"size=9x9", "max-bounces=3", "seed=4", "pixel-filter=box", "frames=3", "average=off"})
        EXPECT_NE(complaint(std::string("pt:") + other).find("must share"), std::string::npos) << other;
}
