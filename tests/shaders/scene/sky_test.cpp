// A sky's texels: sampled and found by the same borders, in every row and column.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "engine/scene/shapes.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/scene_buffers.h"

namespace
{

constexpr double PI = std::numbers::pi;
constexpr double ROUNDING = 5e-7;           // radians, of a direction in float32
constexpr double MARGIN = 2 * PI * 0x1p-21; // by which samples keep away from edges

struct Answer {
    glm::vec3 direction; // of the place in the texel
    float unused = 0;
    glm::vec2 texelAgain; // found by it
    glm::vec2 texelFound; // found by the query, taken as a direction
};

struct Size {
    uint32_t columns, rows;
};

class Sky : public GpuTest, public testing::WithParamInterface<Size>
{
  protected:
    const double columnWidth_ = 2 * PI / GetParam().columns, rowHeight_ = PI / GetParam().rows;

    std::vector<Answer> ask(const std::vector<glm::vec4>& queries)
    {
        scene::Scene scene;
        scene::addQuad(scene, scene::addMaterial(scene, scene::diffuse("far", {1, 1, 1})), {0, -50, 0}, {1, 0, 0},
                       {0, 0, 1});
        const auto [columns, rows] = GetParam();
        scene.environment = {columns, rows, std::vector<glm::vec3>(size_t{columns} * rows, glm::vec3(1))};
        const support::SceneBuffers buffers(device(), scene);
        const gpu::Buffer in = upload("queries", queries), out = create<Answer>("results", queries.size());
        run({.shader = TEST_SPIRV_DIR "/sky_test",
             .buffers = buffers.with({{"Queries", &in}, {"Results", &out}}),
             .threads = {uint32_t(queries.size())}});
        return download<Answer>(out);
    }

    // All rows in some columns, and all columns in some rows.
    static std::vector<glm::uvec2> texels()
    {
        const auto [columns, rows] = GetParam();
        const auto some = [](uint32_t count) { return std::set<uint32_t>{0, count / 3, count / 2, count - 1}; };
        std::vector<glm::uvec2> result;
        for (uint32_t row = 0; row < rows; ++row)
            for (const uint32_t column : some(columns)) result.emplace_back(column, row);
        for (uint32_t column = 0; column < columns; ++column)
            for (const uint32_t row : some(rows)) result.emplace_back(column, row);
        return result;
    }

    // In float64. The nadir's rows need as many digits as the zenith's.
    static double polarAngle(const glm::dvec3& d) { return std::atan2(std::hypot(d.x, d.z), d.y); }
    static double azimuth(const glm::dvec3& d)
    {
        const double phi = std::atan2(d.z, d.x);
        return phi < 0 ? phi + 2 * PI : phi;
    }
};

// Uniform in azimuth and in the cosine of the polar angle, and found again.
TEST_P(Sky, TexelsAreFoundWhereTheyAreSampled)
{
    std::vector<glm::vec4> queries;
    for (const glm::uvec2 texel : texels())
        for (const glm::vec2 u :
             {glm::vec2(0, 0), glm::vec2(0, 1 - 0x1p-24f), glm::vec2(1 - 0x1p-24f, 0),
              glm::vec2(1 - 0x1p-24f, 1 - 0x1p-24f), glm::vec2(0.25f, 0.75f), glm::vec2(0.5f, 0.1f)})
            queries.emplace_back(glm::vec2(texel), u);
    const std::vector<Answer> answers = ask(queries);
    for (size_t i = 0; i < queries.size(); ++i) {
        const glm::dvec4 query = queries[i];
        const glm::dvec3 d = answers[i].direction;
        SCOPED_TRACE(testing::Message() << "texel " << query.x << ", " << query.y << " at " << query.z << ", "
                                        << query.w);
        ASSERT_NEAR(glm::length(d), 1, ROUNDING);
        ASSERT_EQ(answers[i].texelAgain, glm::vec2(queries[i]));
        ASSERT_EQ(std::floor(azimuth(d) / columnWidth_), query.x);
        ASSERT_EQ(std::floor(polarAngle(d) / rowHeight_), query.y);
        const auto allowed = [](double u, double margin) { return ROUNDING + (u > 0.01 && u < 0.99 ? 0 : margin); };
        ASSERT_NEAR(azimuth(d), (query.x + query.z) * columnWidth_, allowed(query.z, MARGIN));
        // From the nearer pole, by sin^2 of half the angle.
        const bool below = 2 * query.y >= GetParam().rows;
        const double row = below ? GetParam().rows - 1 - query.y : query.y;
        const double begin = std::pow(std::sin(row * rowHeight_ / 2), 2),
                     end = std::pow(std::sin((row + 1) * rowHeight_ / 2), 2);
        const double angle = 2 * std::asin(std::sqrt(std::lerp(begin, end, query.w)));
        // A margin of area is one of angle 1.5 times as wide in the second row, and the root of it at the nadir of one.
        const bool nadir = GetParam().rows == 1 && query.w > 0.99;
        const double margin = allowed(query.w, nadir ? 2 * std::sqrt(MARGIN / PI) : 1.51 * MARGIN);
        ASSERT_NEAR(below ? PI - polarAngle(d) : polarAngle(d), angle, margin);
    }
}

// What scattered rays find is right up to rounding on both sides of every edge.
TEST_P(Sky, TexelsEndAtTheirEdges)
{
    std::vector<glm::vec4> queries;
    std::vector<glm::uvec2> expected;
    const auto add = [&](double polar, double phi, uint32_t column, uint32_t row) {
        queries.emplace_back(std::sin(polar) * std::cos(phi), std::cos(polar), std::sin(polar) * std::sin(phi), 0);
        expected.emplace_back(column, row);
    };
    for (const glm::uvec2 texel : texels())
        for (const double side : {ROUNDING, 0.5 * rowHeight_, rowHeight_ - ROUNDING})
            for (const double turn : {ROUNDING, 0.5 * columnWidth_, columnWidth_ - ROUNDING})
                add(texel.y * rowHeight_ + side, texel.x * columnWidth_ + turn, texel.x, texel.y);
    const std::vector<Answer> answers = ask(queries);
    for (size_t i = 0; i < queries.size(); ++i)
        ASSERT_EQ(answers[i].texelFound, glm::vec2(expected[i]))
            << queries[i].x << ", " << queries[i].y << ", " << queries[i].z;
}

INSTANTIATE_TEST_SUITE_P(OfSize, Sky,
                         testing::Values(Size{1, 1}, Size{2, 2}, Size{7, 5}, Size{128, 64}, Size{2048, 1024},
                                         Size{3, 4096}, Size{8192, 3}),
                         [](const auto& test) {
                             return std::to_string(test.param.columns) + "x" + std::to_string(test.param.rows);
                         });

} // namespace
