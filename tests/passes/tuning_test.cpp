// Whatever a device is tuned to, it makes the same picture and counts the same. By default each choice once and those
// of a graphics card together, in a plain scene; with TRICHROME_TEST_MATRIX=1 all combinations, in one that has all
// kinds of materials.
// Covers passes/variant.cpp.

#include <cstdlib>

#include "engine/base/error.h"
#include "engine/scene/procedural.h"
#include "passes/camera_path.h"
#include "passes/renderer.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/test_scenes.h"

namespace
{

scene::Scene builtIn(const std::string& name)
{
    for (const scene::BuiltInScene& scene : scene::builtInScenes())
        if (scene.name == name) return scene.make();
    throw Error("There is no scene \"{}\".", name);
}

class TuningOfRenderer : public RendererFixture
{
  protected:
    using Methods = std::vector<passes::Method>;
    struct Result {
        std::vector<image::Image> pictures;
        std::vector<passes::RenderStats> stats;
    };

    // The last of three frames of a moving camera, of each method.
    static Result render(const std::string& tuning, const scene::Scene& scene, const Methods& methods)
    {
        gpu::Device device = openDevice({.tuning = tuning});
        const passes::CameraAt cameraAt = passes::cameraOrbit(scene.cameras.at(0), 2);
        Result result;
        for (const passes::Method method : methods) {
            passes::Settings settings;
            settings.method = method;
            settings.width = 24;
            settings.height = 16;
            settings.maxBounces = 3;
            settings.spatial = 1;
            passes::Renderer renderer(device, scene, settings);
            for (uint32_t frame = 0; frame < 3; ++frame) {
                renderer.setCamera(cameraAt(frame));
                renderer.renderFrame();
            }
            result.pictures.push_back(renderer.read(passes::LAST_FRAME));
            result.stats.push_back(renderer.stats());
        }
        for (const std::string& message : device.takeValidationMessages()) ADD_FAILURE() << tuning << ": " << message;
        return result;
    }

    // To the bit, or but for rounding, which turns a decision now and then.
    static void compare(const std::string& tuning, const Result& found, const Result& expected, bool exact)
    {
        for (size_t i = 0; i < expected.pictures.size(); ++i) {
            const std::vector<glm::vec3>&a = expected.pictures[i].pixels, &b = found.pictures[i].pixels;
            ASSERT_EQ(a.size(), b.size());
            size_t different = 0;
            for (size_t p = 0; p < a.size(); ++p)
                different += exact ? a[p] != b[p] : glm::distance(a[p], b[p]) > 1e-4f * glm::length(a[p]);
            EXPECT_LE(different, exact ? 0 : a.size() / 50) << tuning << ", picture " << i;
            EXPECT_EQ(found.stats[i].nonFinite, expected.stats[i].nonFinite) << tuning;
            if (tuning.find("counters=off") != std::string::npos) {
                for (const auto& [kind, count] : found.stats[i].rays) EXPECT_EQ(count, 0u) << tuning << " " << kind;
            } else if (exact) {
                EXPECT_EQ(found.stats[i].rays, expected.stats[i].rays) << tuning;
                EXPECT_EQ(found.stats[i].shifts, expected.stats[i].shifts) << tuning;
                EXPECT_EQ(found.stats[i].treesPerPixel, expected.stats[i].treesPerPixel) << tuning;
            }
        }
    }
};

TEST_F(TuningOfRenderer, ChangesNeitherPicturesNorCounts)
{
    const bool matrix = std::getenv("TRICHROME_TEST_MATRIX") != nullptr;
    const scene::Scene scene = matrix ? support::cabinet() : builtIn("cornell");
    const Methods methods =
        matrix ? Methods{passes::Method::Pt, passes::Method::RgbRestir} : Methods{passes::Method::RgbRestir};
    const Result expected = render("contraction=allowed", scene, methods);
    uint64_t shifts = 0;
    for (const auto& [outcome, count] : expected.stats.back().shifts) shifts += count;
    EXPECT_GT(shifts, 0u);
    std::vector<std::string> tunings;
    if (matrix) {
        tunings = {""};
        for (const gpu::TuningText& text : gpu::describe({})) {
            std::vector<std::string> longer;
            for (const std::string& tuning : tunings)
                for (const std::string& value : text.values) {
                    if (value == "simplified") continue; // Mesa 22.3.6 renders them wrongly (tests/bench/LOG.md)
                    longer.push_back((tuning.empty() ? "" : tuning + ",") + text.name + "=" + value);
                }
            tunings = longer;
        }
    } else {
        tunings = {"tables=storage,counters=subgroup", "loops=start,stack=array,counters=off",
                   "tables=storage,loops=start,stack=array,counters=subgroup,contraction=forbidden"}; // a card's
    }
    const std::string forbids = "contraction=forbidden";
    const Result forbidden = render(forbids, scene, methods);
    compare(forbids, forbidden, expected, false);
    for (const std::string& tuning : tunings)
        compare(tuning, render(tuning, scene, methods),
                tuning.find(forbids) == std::string::npos ? expected : forbidden, true);
}

} // namespace
