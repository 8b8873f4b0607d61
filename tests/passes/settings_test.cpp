// Settings: every way in and out of the list gives the same values back, and nothing that is not a value gets in.

#include "passes/settings.h"

#include "engine/base/error.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <limits>
#include <set>

using passes::Settings;
using Json = nlohmann::ordered_json;

namespace
{

// Every knob away from its default, with values that only an exact round trip keeps.
Settings unusual()
{
    Settings s;
    s.method = passes::Method::RgbRestir;
    s.shift = passes::Shift::Replay;
    s.maxConfidence = 1048576;
    s.temporal = false;
    s.spatial = 8;
    s.spatialRadius = 0.1f + 31;
    s.color = passes::Color::Chosen;
    s.colorConfidence = 1048575;
    s.mutate = passes::Mutate::Free;
    s.maxBounces = 0;
    s.pixelFilter = passes::PixelFilter::Box;
    s.width = 17;
    s.height = 13;
    s.camera = "Kamera \"Süd\" = 2";
    s.seed = std::numeric_limits<uint64_t>::max();
    s.frames = 1073741824;
    s.seconds = 1.0 / 3;
    s.average = false;
    s.environment = "sky.exr";
    s.environmentScale = 0.1f;
    return s;
}

std::string messageOf(const auto& action)
{
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

} // namespace

TEST(Settings, UnusualDiffersInEveryKnobSoThatTheRoundTripsProveSomething)
{
    const auto initial = passes::toText(Settings{});
    const auto changed = passes::toText(unusual());
    ASSERT_EQ(initial.size(), changed.size());
    for (size_t i = 0; i < initial.size(); ++i) EXPECT_NE(initial[i].second, changed[i].second) << initial[i].first;
}

TEST(Settings, TextRoundTripsExactly)
{
    Settings back;
    for (const auto& [name, text] : passes::toText(unusual())) passes::set(back, name, text);
    EXPECT_EQ(back, unusual());
}

TEST(Settings, JsonRoundTripsExactlyThroughItsText)
{
    Settings back;
    passes::apply(back, Json::parse(passes::toJson(unusual()).dump()));
    EXPECT_EQ(back, unusual());
    EXPECT_EQ(passes::toJson(unusual())["environment-scale"].dump(), "0.1");
}

TEST(Settings, APresetChangesOnlyWhatItNames)
{
    Settings s;
    passes::apply(s, Json::parse(R"({"max-bounces": 2, "size": "8x4"})"));
    Settings expected;
    expected.maxBounces = 2;
    expected.width = 8;
    expected.height = 4;
    EXPECT_EQ(s, expected);
}

TEST(Settings, NamesAreUniqueAndDefaultsAreLegal)
{
    std::set<std::string> names;
    for (const passes::KnobText& knob : passes::describeSettings()) {
        EXPECT_TRUE(names.insert(knob.name).second) << knob.name;
        EXPECT_FALSE(knob.doc.empty());
        Settings s;
        EXPECT_NO_THROW(passes::set(s, knob.name, knob.initial)) << knob.name;
        EXPECT_EQ(s, Settings{}) << knob.name;
    }
}

TEST(Settings, RangesAreClosedAndHold)
{
    Settings s;
    passes::visitSettings(s, []<class T>(const passes::Knob& knob, T&&) {
        using Value = std::remove_cvref_t<T>;
        if constexpr (std::is_arithmetic_v<Value> && !std::is_same_v<Value, bool> && !std::is_same_v<Value, uint64_t>) {
            Settings at;
            EXPECT_NO_THROW(passes::set(at, knob.name, fmt::format("{}", static_cast<Value>(knob.low)))) << knob.name;
            EXPECT_NO_THROW(passes::set(at, knob.name, fmt::format("{}", static_cast<Value>(knob.high)))) << knob.name;
            EXPECT_THROW(passes::set(at, knob.name, fmt::format("{}", knob.low - 1)), Error) << knob.name;
            EXPECT_THROW(passes::set(at, knob.name, fmt::format("{}", knob.high + 1)), Error) << knob.name;
            EXPECT_THROW(passes::apply(at, Json{{knob.name, knob.high + 1}}), Error) << knob.name;
            for (const double none : {std::nan(""), HUGE_VAL, -HUGE_VAL})
                EXPECT_THROW(passes::apply(at, Json{{knob.name, none}}), Error) << knob.name << none;
        }
    });
}

TEST(Settings, WhatIsNoValueIsRefusedAndChangesNothing)
{
    const std::vector<std::pair<std::string, std::string>> wrong = {
        {"method", "PT"},
        {"method", ""},
        {"temporal", "true"},
        {"spatial", "3.0"},
        {"spatial", "-1"},
        {"spatial", "+1"},
        {"spatial", " 1"},
        {"spatial", "1 "},
        {"spatial", "0x1"},
        {"spatial", ""},
        {"max-bounces", "4294967296"},
        {"seed", "18446744073709551616"},
        {"seed", "-1"},
        {"seconds", "nan"},
        {"seconds", "inf"},
        {"seconds", "1e999"},
        {"seconds", "1s"},
        {"size", "0x10"},
        {"size", "10x0"},
        {"size", "99999999x1"},
        {"size", "10"},
        {"size", "10x"},
        {"size", "10x10x10"},
        {"size", "10X10"},
        {"size", "-1x5"},
        {"size", "32768x32768"},
        {"environment-scale", "-1"},
        {"frames", "0"},
        {"no-such-knob", "1"},
        {"", "1"},
        {"Method", "pt"},
    };
    for (const auto& [name, text] : wrong) {
        Settings s;
        EXPECT_THROW(passes::set(s, name, text), Error) << name << "=" << text;
        EXPECT_EQ(s, Settings{}) << name << "=" << text;
    }
}

TEST(Settings, JsonOfAnotherTypeIsRefused)
{
    for (const char* preset :
         {R"([1])", R"("pt")", R"(null)", R"({"method": 0})", R"({"method": null})", R"({"temporal": "on"})",
          R"({"temporal": 1})", R"({"spatial": 1.0})", R"({"spatial": "1"})", R"({"spatial": -1})",
          R"({"spatial": true})", R"({"max-bounces": 4294967297})", R"({"seed": 1e3})", R"({"seconds": "1"})",
          R"({"seconds": -1})", R"({"size": [640, 360]})", R"({"size": "0x10"})", R"({"camera": 0})",
          R"({"spp": 1})"}) {
        Settings s;
        EXPECT_THROW(passes::apply(s, Json::parse(preset)), Error) << preset;
    }
}

TEST(Settings, MessagesNameTheKnobTheValueAndWhatItTakes)
{
    Settings s;
    EXPECT_EQ(messageOf([&] { passes::set(s, "spatial", "9"); }),
              "Setting \"spatial\" cannot be \"9\"; it takes: whole number, 0 to 8 neighbors.");
    EXPECT_EQ(messageOf([&] { passes::set(s, "shift", "magic"); }),
              "Setting \"shift\" cannot be \"magic\"; it takes: replay|reconnection|hybrid.");
    EXPECT_NE(messageOf([&] { passes::set(s, "spp", "9"); }).find("no setting \"spp\""), std::string::npos);
}

TEST(Settings, DifferencesNameWhatDiffersWithBothValues)
{
    EXPECT_TRUE(passes::differences(unusual(), unusual()).empty());
    EXPECT_EQ(passes::differences({}, unusual()).size(), passes::toText({}).size());
    Settings s;
    s.spatial = 1;
    const std::vector<passes::Difference> list = passes::differences({}, s);
    ASSERT_EQ(list.size(), 1u);
    EXPECT_EQ(list[0].knob.name, std::string("spatial"));
    EXPECT_EQ(list[0].a, "3");
    EXPECT_EQ(list[0].b, "1");
}

TEST(Settings, ChangesTakeWhatTheirStrongestKnobTakes)
{
    using passes::Change;
    Settings s;
    EXPECT_EQ(changeBetween({}, s), Change::Nothing);
    s.frames = 7;
    EXPECT_EQ(changeBetween({}, s), Change::Nothing);
    s.maxConfidence = 7;
    EXPECT_EQ(changeBetween({}, s), Change::Tune);
    s.seed = 7;
    EXPECT_EQ(changeBetween({}, s), Change::Reset);
    s.maxBounces = 7;
    EXPECT_EQ(changeBetween({}, s), Change::Compile);
    s.environmentScale = 7;
    EXPECT_EQ(changeBetween({}, s), Change::Reload);
}

TEST(Settings, CopyTakesKnobsOfTheseRolesAndNoOthers)
{
    using passes::Role;
    for (const Role role :
         {Role::Scene, Role::View, Role::Picture, Role::Estimator, Role::Sampling, Role::Stopping, Role::Output}) {
        Settings s;
        passes::copy(s, unusual(), {role});
        const std::vector<passes::Difference> taken = passes::differences({}, s),
                                              left = passes::differences(s, unusual());
        EXPECT_FALSE(taken.empty()) << int(role);
        for (const passes::Difference& one : taken) EXPECT_EQ(one.knob.role, role) << one.knob.name;
        for (const passes::Difference& one : left) EXPECT_NE(one.knob.role, role) << one.knob.name;
    }
}

TEST(Settings, TheHashTellsEverySingleChange)
{
    std::set<std::string> hashes = {passes::hash(Settings{})};
    const auto changed = passes::toText(unusual());
    for (const auto& [name, text] : changed) {
        Settings s;
        passes::set(s, name, text);
        EXPECT_TRUE(hashes.insert(passes::hash(s)).second) << name;
    }
    EXPECT_EQ(passes::hash(Settings{}), passes::hash(Settings{}));
    EXPECT_EQ(passes::hash(Settings{}).size(), 16u);
}
