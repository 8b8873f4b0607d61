#include <bit>
#include <cmath>
#include <random>

#include <glm/glm.hpp>
#include <glm/gtc/packing.hpp>

#include "tests/support/gpu_fixture.h"

namespace
{

using glm::dvec3;

class Basis : public GpuTest
{
  protected:
    struct Result {
        dvec3 tangent, bitangent, normal, unpacked;
    };
    std::vector<Result> compute(const std::vector<glm::vec4>& normals)
    {
        const gpu::Buffer in = upload("normals", normals), out = create<glm::vec4>("results", 4 * normals.size());
        run({.shader = TEST_SPIRV_DIR "/basis_test",
             .buffers = {{"Normals", &in}, {"Results", &out}},
             .threads = {uint32_t(normals.size())}});
        std::vector<Result> results;
        const std::vector<glm::vec4> columns = download<glm::vec4>(out);
        for (size_t i = 0; i < columns.size(); i += 4)
            results.push_back({columns[i], columns[i + 1], columns[i + 2], columns[i + 3]});
        return results;
    }
};

TEST_F(Basis, IsOrthonormalAndRightHanded)
{
    std::vector<glm::vec4> normals;
    for (const float sign : {-1.0f, 1.0f})
        for (const float small : {0.0f, 1e-30f, 1e-7f, 1e-4f}) { // the poles, where such formulas cancel
            normals.push_back({small, 0, sign, 0});
            normals.push_back({0, -small, sign, 0});
            normals.push_back({sign, small, small, 0});
            normals.push_back({small, sign, -small, 0});
        }
    std::mt19937 engine(1);
    std::normal_distribution<float> gauss;
    for (int i = 0; i < 10000; ++i)
        normals.push_back(glm::vec4(glm::normalize(glm::vec3(gauss(engine), gauss(engine), gauss(engine))), 0));
    const std::vector<Result> results = compute(normals);
    for (size_t i = 0; i < results.size(); ++i) {
        const auto& [t, b, n, unused] = results[i];
        ASSERT_EQ(n, dvec3(normals[i]));
        ASSERT_NEAR(glm::dot(t, t), 1, 2e-6) << i;
        ASSERT_NEAR(glm::dot(b, b), 1, 2e-6) << i;
        ASSERT_NEAR(glm::dot(t, n), 0, 2e-6) << i;
        ASSERT_NEAR(glm::dot(b, n), 0, 2e-6) << i;
        ASSERT_NEAR(glm::dot(glm::cross(t, b), n), 1, 4e-6) << i;
    }
}

// The octahedron's faces are flattened onto a square: |x| + |y| + |z| = 1, lower half folded outward.
TEST_F(Basis, UnpacksTheOctahedralMap)
{
    std::vector<glm::vec4> inputs;
    std::vector<dvec3> expected;
    for (int x = -4; x <= 4; ++x)
        for (int y = -4; y <= 4; ++y) {
            const glm::vec2 e(float(x) / 4, float(y) / 4);
            inputs.push_back({0, 0, 1, std::bit_cast<float>(glm::packSnorm2x16(e))});
            dvec3 v(e, 1 - std::abs(e.x) - std::abs(e.y));
            if (v.z < 0)
                v = {(1 - std::abs(e.y)) * (e.x >= 0 ? 1 : -1), (1 - std::abs(e.x)) * (e.y >= 0 ? 1 : -1), v.z};
            expected.push_back(glm::normalize(v));
        }
    const std::vector<Result> results = compute(inputs);
    for (size_t i = 0; i < results.size(); ++i)
        EXPECT_LT(glm::distance(results[i].unpacked, expected[i]), 1e-4) << i; // 16 bits a coordinate
}

} // namespace
