// What the inspector reads against what is known otherwise: counters, definitions, and how histories grow.

#include "passes/inspector.h"

#include "engine/scene/procedural.h"
#include "tests/support/gpu_fixture.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace
{

class InspectorTest : public RendererFixture
{
  protected:
    static passes::Settings small(passes::Method method)
    {
        passes::Settings settings;
        settings.method = method;
        settings.width = 32;
        settings.height = 24;
        settings.maxBounces = 2;
        settings.spatialRadius = 8; // far enough that some shifts fail
        return settings;
    }
    static uint64_t sum(const std::map<std::string, uint64_t>& counts)
    {
        uint64_t all = 0;
        for (const auto& [name, count] : counts) all += count;
        return all;
    }
    // Pixels from the left and the top.
    static glm::dvec2 inPicture(const shared::PathPoint& point, const passes::Settings& settings)
    {
        return {(0.5 + 0.5 * point.x / point.depth) * settings.width,
                (0.5 - 0.5 * point.y / point.depth) * settings.height};
    }
    glm::dvec2 inPicture(glm::dvec3 position, const passes::Settings& settings) const
    {
        const scene::Camera& camera = scene_.cameras[0];
        const glm::dvec3 d = position - camera.position;
        const double pixel = 2 * std::tan(camera.yfov / 2) / settings.height * glm::dot(d, camera.forward);
        return {settings.width / 2.0 + glm::dot(d, camera.right) / pixel,
                settings.height / 2.0 - glm::dot(d, camera.up) / pixel};
    }
    const scene::Scene scene_ = scene::builtInScenes()[0].make();
};

// One reservoir and one frame: every spatial shift is counted by the stage that made it, too. The inspector counts it
// twice: where it starts and where it arrives.
TEST_F(InspectorTest, ShiftsAreThoseThatTheStagesCounted)
{
    passes::Settings settings = small(passes::Method::RestirPt);
    settings.shift = passes::Shift::Hybrid;
    settings.spatial = 4;
    passes::Renderer renderer(device(), scene_, settings);
    passes::Inspector inspector(renderer);
    renderer.renderFrame();
    uint64_t tried = 0, failed = 0;
    for (const shared::Inspection& seen : inspector.reservoirs()) {
        tried += seen.lengthAndShifts >> 16 & 0xff;
        failed += seen.lengthAndShifts >> 24;
        EXPECT_LE(seen.lengthAndShifts & 0xffff, settings.maxBounces);
    }
    const passes::RenderStats stats = renderer.stats();
    EXPECT_EQ(tried, 2 * sum(stats.shifts));
    EXPECT_EQ(tried - failed, 2 * stats.shifts.at("done"));
    EXPECT_GT(failed, 0u);

    passes::ShiftCounts all{};
    for (const passes::ShiftCounts& counts : inspector.shifts())
        for (size_t i = 0; i < all.size(); ++i) all[i] += counts[i];
    const char* const names[] = {"done", "ended", "joined-earlier", "not-joinable", "hidden", "dark"};
    for (size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i], stats.shifts.at(names[i])) << names[i];
    EXPECT_GT(stats.shifts.at("hidden"), 0u);
    EXPECT_GT(stats.shifts.at("ended"), 0u);
    EXPECT_GT(stats.shifts.at("joined-earlier"), 0u);
}

// A path begins at what its pixel sees and ends at light, with as many scattering events as the reservoir says, also
// when it was drawn by another pixel and reconnected here. The hall's lights are spots, whose places are known, and
// windows, which all are in the picture: it is bright where such a path ends.
TEST_F(InspectorTest, PathsLeadFromThePixelToLight)
{
    const uint32_t ENLARGED = 10; // the emitters' picture
    for (const passes::Shift shift : {passes::Shift::Replay, passes::Shift::Hybrid}) {
        passes::Settings settings = small(passes::Method::RgbRestir);
        settings.maxBounces = 3;
        settings.shift = shift;
        passes::Renderer renderer(device(), scene_, settings);
        passes::Inspector inspector(renderer);
        for (int frame = 0; frame < 3; ++frame) renderer.renderFrame();
        const std::vector<shared::Inspection> held = inspector.reservoirs();
        passes::Settings dark = settings;
        dark.method = passes::Method::Pt;
        dark.maxBounces = 0;
        dark.width *= ENLARGED;
        dark.height *= ENLARGED;
        passes::Renderer emitters(renderer, dark);
        emitters.renderFrame();
        const image::Image emission = emitters.read(passes::LAST_FRAME);
        const uint32_t pixels = settings.width * settings.height;
        uint32_t spots = 0, windows = 0, joined = 0, foreign = 0;
        for (uint32_t pixel = 0; pixel < pixels; pixel += 13) {
            const auto paths = inspector.paths(pixel);
            ASSERT_EQ(paths.size(), 3u);
            for (uint32_t c = 0; c < 3; ++c) {
                const shared::Inspection& seen = held[c * pixels + pixel];
                const std::vector<shared::PathPoint>& path = paths[c];
                if (!(seen.weightSum > 0)) {
                    EXPECT_TRUE(path.empty());
                    continue;
                }
                ASSERT_EQ(path.size(), (seen.lengthAndShifts & 0xffff) + 1) << "pixel " << pixel << ", reservoir " << c;
                EXPECT_EQ(path.back().kind, shared::POINT_LIGHT);
                const glm::dvec2 begin = inPicture(path[0], settings), end = inPicture(path.back(), settings);
                const uint32_t column = pixel % settings.width, row = pixel / settings.width;
                EXPECT_NEAR(begin.x, column + 0.5, 0.02);
                EXPECT_NEAR(begin.y, row + 0.5, 0.02);
                joined += seen.pathIdAndReconnection >> 16 > 0;
                foreign += seen.seedPixel != pixel;
                const bool atSpot = std::any_of(scene_.lights.begin(), scene_.lights.end(), [&](const auto& light) {
                    return glm::distance(end, inPicture(glm::dvec3(light.position), settings)) < 0.02;
                });
                spots += atSpot;
                windows += !atSpot;
                if (atSpot) continue;
                uint32_t bright = 0; // of the pixels that touch this point: its edge is somebody else's
                for (const double dx : {-0.5, 0.5})
                    for (const double dy : {-0.5, 0.5}) {
                        const double x = end.x * ENLARGED + dx, y = end.y * ENLARGED + dy;
                        if (x >= 0 && y >= 0 && x < dark.width && y < dark.height)
                            bright += emission.at(uint32_t(x), uint32_t(y)).r > 0;
                    }
                EXPECT_GT(bright, 0u) << end.x << ", " << end.y;
            }
        }
        EXPECT_GT(spots, pixels / 30);
        EXPECT_GT(windows, pixels / 180);
        EXPECT_GT(foreign, pixels / 60);
        if (shift == passes::Shift::Hybrid) {
            EXPECT_GT(joined, pixels / 60);
        }
    }
}

TEST_F(InspectorTest, ThePathTracerHasNoReservoirsButAWalk)
{
    passes::Renderer renderer(device(), scene_, small(passes::Method::Pt));
    passes::Inspector inspector(renderer);
    renderer.renderFrame();
    EXPECT_TRUE(inspector.reservoirs().empty());
    EXPECT_TRUE(inspector.shifts().empty());
    const auto paths = inspector.paths(24 * 32 / 2 + 16);
    ASSERT_EQ(paths.size(), 1u);
    EXPECT_GE(paths[0].size(), 2u);
    for (const shared::PathPoint& point : paths[0]) EXPECT_EQ(point.kind, shared::POINT_SURFACE);
}

TEST_F(InspectorTest, WeightsTreesAndConfidenceAreWhatTheyMean)
{
    passes::Settings settings = small(passes::Method::RgbRestir);
    settings.spatial = 0;
    settings.maxConfidence = 3;
    passes::Renderer renderer(device(), scene_, settings);
    passes::Inspector inspector(renderer);
    const size_t pixels = size_t{settings.width} * settings.height;
    double held = 0, trees = 0;
    for (uint32_t frame = 1; frame <= 6; ++frame) {
        renderer.renderFrame();
        const std::vector<shared::Inspection> all = inspector.reservoirs();
        ASSERT_EQ(all.size(), 3 * pixels);
        uint32_t most = 0;
        for (const shared::Inspection& seen : all) {
            EXPECT_NEAR(seen.weight * seen.target, seen.weightSum, 1e-5f * seen.weightSum);
            most = std::max(most, seen.confidence);
            EXPECT_LT(seen.seedFrame, frame);
            EXPECT_LT(seen.seedPixel, pixels);
        }
        EXPECT_EQ(most, std::min(frame, 4u)); // M_c of history and this frame's own
        for (size_t p = 0; p < pixels; ++p) {
            std::set<std::pair<uint32_t, uint32_t>> seeds;
            bool holds = true;
            for (size_t c = 0; c < 3; ++c) {
                const shared::Inspection& seen = all[c * pixels + p];
                seeds.emplace(seen.seedFrame, seen.seedPixel);
                holds = holds && seen.weightSum > 0;
            }
            held += holds;
            trees += holds ? double(seeds.size()) : 0;
        }
    }
    EXPECT_NEAR(renderer.stats().treesPerPixel, trees / held, 1e-9);
    EXPECT_GT(trees, held); // they do not always agree
}

} // namespace
