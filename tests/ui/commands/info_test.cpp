// The info command and --help: what they tell people and programs.

#include "tests/support/trichrome.h"

#include "engine/gpu/gpu.h"
#include "engine/scene/procedural.h"
#include "passes/settings.h"

#include <fmt/ranges.h>

namespace
{

class Info : public Trichrome
{
};

} // namespace

TEST_F(Info, HelpOfRenderDocumentsEverySettingWithValuesAndDefault)
{
    const Outcome help = run({"render", "--help"});
    EXPECT_EQ(help.exitCode, 0);
    for (const passes::KnobText& knob : passes::describeSettings()) {
        const std::string initial = knob.initial.empty() ? "empty" : knob.initial;
        EXPECT_NE(help.out.find("--" + knob.name + "  " + knob.values + " (" + initial + ")"), std::string::npos)
            << knob.name;
        EXPECT_NE(help.out.find(knob.doc.substr(0, 40)), std::string::npos) << knob.name;
    }
    EXPECT_EQ(run({"--help"}).exitCode, 0);
    EXPECT_EQ(run({"--version"}).exitCode, 0);
}

TEST_F(Info, ListsTheDevicesWithTheirLimits)
{
    const std::string json = directory / "devices.json";
    const Outcome told = runWell({"info", "--json", json});
    const std::vector<gpu::Adapter> adapters = gpu::enumerateAdapters();
    const nlohmann::json devices = readJson(json)["devices"];
    ASSERT_EQ(devices.size(), adapters.size());
    for (size_t i = 0; i < adapters.size(); ++i) {
        EXPECT_EQ(devices[i]["name"], adapters[i].name);
        EXPECT_EQ(devices[i]["limits"]["storage_binding_bytes"], adapters[i].limits.storageBindingBytes);
        EXPECT_NE(told.out.find(adapters[i].name), std::string::npos);
    }
}

TEST_F(Info, AdvisesFromMeasurements)
{
    const std::string json = directory / "advice.json";
    const Outcome told = runWell({"info", "cornell", "--advise", "--size", "16x9", "--json", json, "--quiet"});
    const nlohmann::json advice = readJson(json)["advice"];
    ASSERT_EQ(advice["methods"].size(), 3u);
    for (const nlohmann::json& row : advice["methods"]) {
        EXPECT_GT(row["milliseconds"], 0);
        EXPECT_GT(row["relmse"], 0);
        EXPECT_LE(row["gain_low"], row["gain"]);
        EXPECT_NE(told.out.find("    " + row["method"].get<std::string>()), std::string::npos);
    }
    EXPECT_GT(advice["trees_per_pixel"], 1);
    EXPECT_NEAR(advice["crossover"].get<double>(), 4, 2); // V/P of cornell, at any size
    EXPECT_NE(told.out.find("Use " + advice["best"].get<std::string>()), std::string::npos);
    expectRefusal({"info", "--advise"}, 2, "name one");
}

TEST_F(Info, ShowsHowDevicesAreTunedAndTakesOverrides)
{
    const std::string json = directory / "devices.json";
    for (const std::string overrides : {"", "loops=start,counters=off"}) {
        std::vector<std::string> command = {"info", "--json", json};
        if (!overrides.empty()) command.insert(command.end(), {"--device-tuning", overrides});
        const std::string told = runWell(command).out;
        const std::vector<gpu::Adapter> adapters = gpu::enumerateAdapters(overrides);
        const nlohmann::json devices = readJson(json)["devices"];
        ASSERT_EQ(devices.size(), adapters.size());
        for (size_t i = 0; i < adapters.size(); ++i)
            for (const gpu::TuningText& text : gpu::describe(adapters[i].tuning)) {
                EXPECT_EQ(devices[i]["tuning"][text.name], text.value);
                EXPECT_NE(told.find(fmt::format("    {:<28}{}", text.name, text.value)), std::string::npos) << told;
            }
    }
    const std::string help = run({"render", "--help"}).out;
    for (const gpu::TuningText& text : gpu::describe({}))
        EXPECT_NE(help.find(fmt::format("{}={}", text.name, fmt::join(text.values, "|"))), std::string::npos) << help;
    expectRefusal({"info", "--device-tuning", "loop=end"}, 2, "no device tuning \"loop\"; there are: tables, loops,");
    expectRefusal({"info", "--device-tuning", "loops=begin"}, 2,
                  "\"begin\" is no value of the device tuning \"loops\"");
    expectRefusal({"render", "cornell", "-o", directory / "x.png", "--device-tuning", "loops"}, 2, "not of the form");
}

// Pictures say how their device was tuned, so that equal metadata mean equal pixels.
TEST_F(Info, OfASceneShowsTheTuningThatIsInForce)
{
    const std::string json = directory / "cornell.json";
    const std::string told = runWell({"info", "cornell", "--json", json, "--device-tuning", "stack=array"}).out;
    EXPECT_EQ(readJson(json)["tuning"]["stack"], "array");
    EXPECT_EQ(readJson(json)["scene"]["variant"]["STACK_IN_REGISTERS"]["value"], "off");
    EXPECT_NE(told.find("stack=array"), std::string::npos) << told;
}

TEST_F(Info, ListsTheBuiltInScenes)
{
    const std::string told = runWell({"info", "--scenes"}).out;
    for (const scene::BuiltInScene& builtIn : scene::builtInScenes())
        EXPECT_NE(told.find(builtIn.name), std::string::npos) << builtIn.name;
}

TEST_F(Info, TellsWhatASceneHoldsAndWhatIsLeftOut)
{
    const std::string json = directory / "cornell.json";
    const std::string told = runWell({"info", "cornell", "--json", json}).out;
    EXPECT_NE(told.find("36 triangles"), std::string::npos);
    EXPECT_NE(told.find("Left out"), std::string::npos);
    const nlohmann::json scene = readJson(json)["scene"];
    EXPECT_EQ(scene["triangles"], 36);
    EXPECT_EQ(scene["materials"], 4);
    EXPECT_EQ(scene["lights"]["emissive_triangles"], 2);
    EXPECT_EQ(scene["variant"]["HAS_EMISSIVE"]["value"], "on");
    EXPECT_EQ(scene["variant"]["HAS_TRANSMISSION"]["value"], "off");
    EXPECT_NE(scene["variant"]["HAS_TRANSMISSION"]["meaning"], "");
    EXPECT_NEAR(scene["bvh"]["bytes_per_triangle"].get<double>(), scene["bvh"]["bytes"].get<double>() / 36, 1e-9);
    EXPECT_GT(scene["bytes_per_pixel"], 0);
}

TEST_F(Info, RefusesAnUnknownScene)
{
    expectRefusal({"info", "attic"}, 1, "attic");
    expectRefusal({"info", "cornell", "--frames", "0"}, 2, "frames");
}
