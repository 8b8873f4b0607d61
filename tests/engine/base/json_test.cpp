// JSON of strangers: refused in a sentence however it is broken, and no name breaks our own.

#include "engine/base/json.h"

#include <gtest/gtest.h>

namespace
{

std::string refusalOf(const std::string& text)
{
    try {
        parseJson(std::as_bytes(std::span(text)));
        return "";
    } catch (const Error& error) {
        return error.what();
    }
}

} // namespace

TEST(Json, ReadsWhatItIsAndRefusesTheRestInOneSentence)
{
    EXPECT_EQ(refusalOf(R"({"a": [1, "[[[\"", null]})"), "");
    for (const std::string text : {"", "{", "[1,", "{\"a\": 1} x", "\"\x01\"", "[\xff]"}) {
        EXPECT_TRUE(refusalOf(text).starts_with("The JSON is malformed: ")) << text;
        EXPECT_EQ(refusalOf(text).find('\n'), std::string::npos) << text;
    }
    EXPECT_LT(refusalOf("[" + std::string(1 << 20, 'x') + "]").size(), 300u);
}

TEST(Json, DepthIsLimitedBeforeAnythingRecurses)
{
    const auto nested = [](size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); };
    EXPECT_EQ(refusalOf(nested(MAX_JSON_DEPTH)), "");
    for (const size_t depth : {MAX_JSON_DEPTH + 1, size_t{1} << 24})
        EXPECT_EQ(refusalOf(nested(depth)), fmt::format("The JSON is nested deeper than {} levels.", MAX_JSON_DEPTH));
}

TEST(Json, WritesTextsThatAreNoUtf8)
{
    EXPECT_EQ(jsonText({{"name", "h\xffll"}}), "{\"name\":\"h\uFFFDll\"}");
}
