// The options of the settings: which source wins, and that every setting has its option.

#include "ui/cli/settings_options.h"

#include "engine/base/error.h"
#include "tests/support/program.h"
#include "ui/cli/presets.h"

#include <gtest/gtest.h>

namespace
{

passes::Settings parse(std::vector<std::string> words)
{
    CLI::App app;
    ui::SettingsOptions options;
    options.addTo(app);
    std::ranges::reverse(words); // as CLI11 takes them
    app.parse(words);
    return options.read();
}

} // namespace

TEST(SettingsOptions, EverySettingHasAnOptionThatReadsItsOwnText)
{
    for (const auto& [name, value] : passes::toText(passes::Settings{}))
        EXPECT_EQ(parse({"--" + name, value}), passes::Settings{}) << name;
}

TEST(SettingsOptions, PresetLosesToSetLosesToTheOwnOption)
{
    const TemporaryDirectory directory;
    const std::string preset = directory / "preset.json";
    writeFile(preset, R"({"frames": 11, "seed": 12, "spatial": 5})");
    const passes::Settings settings =
        parse({"--frames", "31", "--set", "frames=21", "--preset", preset, "--set", "seed=22", "--set", "seed=23"});
    EXPECT_EQ(settings.frames, 31u);
    EXPECT_EQ(settings.seed, 23u);
    EXPECT_EQ(settings.spatial, 5u);
}

TEST(SettingsOptions, PresetsThatComeAlongAreKnownByName)
{
    EXPECT_EQ(ui::presetNames(), (std::vector<std::string>{"offline", "paper", "real-time"}));
    for (const std::string& name : ui::presetNames()) EXPECT_NE(parse({"--preset", name}), passes::Settings{}) << name;
    EXPECT_EQ(parse({"--preset", "paper"}).maxConfidence, 32768u);
    EXPECT_THROW(parse({"--preset", "papers"}), Error);
}

TEST(SettingsOptions, KnowWhatTheCommandLineGave)
{
    CLI::App app;
    ui::SettingsOptions options;
    options.addTo(app);
    app.parse(std::vector<std::string>{"average=on", "--set", "7", "--frames"});
    EXPECT_TRUE(options.given("average"));
    EXPECT_TRUE(options.given("frames"));
    EXPECT_FALSE(options.given("seed"));
}

TEST(SettingsOptions, OneSetTakesOneValueAndLeavesTheNextWordAlone)
{
    CLI::App app;
    std::string scene;
    app.add_option("SCENE", scene);
    ui::SettingsOptions options;
    options.addTo(app);
    app.parse(std::vector<std::string>{"cornell", "frames=3", "--set"});
    EXPECT_EQ(scene, "cornell");
    EXPECT_EQ(options.read().frames, 3u);
}
