// By name, else by index, else a sentence that lists what there is.

#include "engine/scene/choice.h"

#include <gtest/gtest.h>

#include "engine/base/error.h"

namespace scene
{
namespace
{

std::string refusal(const std::vector<std::string>& names, const std::string& choice)
{
    try {
        return "chose " + std::to_string(chooseName(names, choice, "door"));
    } catch (const Error& error) {
        return error.what();
    }
}

} // namespace

TEST(Choice, TakesNamesBeforeIndicesAndTheFirstOfAName)
{
    const std::vector<std::string> names = {"", "front", "0", "front"};
    EXPECT_EQ(chooseName(names, "front", "door"), 1u);
    EXPECT_EQ(chooseName(names, "0", "door"), 2u);
    EXPECT_EQ(chooseName(names, "3", "door"), 3u);
    EXPECT_EQ(chooseName(names, "", "door"), 0u);
}

TEST(Choice, ListsWhatThereIs)
{
    for (const std::string wrong : {"2", "back", "-1", "1.0", " 1", "4294967296"})
        EXPECT_EQ(refusal({"front", ""}, wrong),
                  "The scene has no door \"" + wrong + "\": it has 0 \"front\", 1 \"\".");
    EXPECT_EQ(refusal({}, "0"), "The scene has no door \"0\": it has none.");
    const std::string many = refusal(std::vector<std::string>(21, "x"), std::string(100, 'y'));
    EXPECT_NE(many.find("19 \"x\" and more."), std::string::npos) << many;
    EXPECT_EQ(many.find("20 \"x\""), std::string::npos) << many;
    EXPECT_NE(many.find("\"" + std::string(60, 'y') + "...\""), std::string::npos) << many;
}

} // namespace scene
