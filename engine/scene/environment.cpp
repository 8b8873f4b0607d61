#include "engine/scene/environment.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace scene
{

namespace
{

constexpr float MAX_RADIANCE = 1e12f; // as for lights: products must stay far inside float32

// One axis of a reduction: for each new cell the old ones that it covers, with weights that sum to 1.
struct Cover {
    uint32_t first = 0;
    std::vector<double> weights;
};

// `measure(a, b)` is the size of the interval from a to b, in old cells.
std::vector<Cover> coverAxis(uint32_t oldSize, uint32_t newSize, const std::function<double(double, double)>& measure)
{
    std::vector<Cover> covers(newSize);
    for (uint32_t i = 0; i < newSize; ++i) {
        const double begin = double(i) * oldSize / newSize;
        const double end = double(i + 1) * oldSize / newSize;
        covers[i].first = static_cast<uint32_t>(begin);
        for (uint32_t old = covers[i].first; old < end && old < oldSize; ++old)
            covers[i].weights.push_back(measure(std::max<double>(begin, old), std::min<double>(end, old + 1)) /
                                        measure(begin, end));
    }
    return covers;
}

Environment reduce(const Environment& from, uint32_t width, uint32_t height)
{
    const auto columns = coverAxis(from.width, width, [](double a, double b) { return b - a; });
    const auto rows = coverAxis(from.height, height, [&](double a, double b) {
        const double step = std::numbers::pi / from.height;
        return std::cos(a * step) - std::cos(b * step);
    });
    Environment to{width, height, {}};
    to.radiance.reserve(size_t{width} * height);
    for (const Cover& row : rows) {
        for (const Cover& column : columns) {
            glm::dvec3 sum(0);
            for (size_t y = 0; y < row.weights.size(); ++y) {
                const glm::vec3* texels = &from.radiance[(row.first + y) * from.width + column.first];
                for (size_t x = 0; x < column.weights.size(); ++x)
                    sum += row.weights[y] * column.weights[x] * glm::dvec3(texels[x]);
            }
            to.radiance.emplace_back(sum);
        }
    }
    return to;
}

} // namespace

Environment environmentFrom(const image::Image& picture, const std::string& what, Warnings& warnings)
{
    Environment environment{picture.width, picture.height, picture.pixels};
    size_t replaced = 0, tooBright = 0;
    for (glm::vec3& texel : environment.radiance) {
        for (int c = 0; c < 3; ++c) {
            if (!std::isfinite(texel[c]) || texel[c] < 0) {
                texel[c] = 0;
                ++replaced;
            } else if (texel[c] > MAX_RADIANCE) {
                texel[c] = MAX_RADIANCE;
                ++tooBright;
            }
        }
    }
    if (replaced > 0)
        warnings.add(fmt::format("{} has {} values that are negative or not finite: took 0 instead.", what, replaced));
    if (tooBright > 0)
        warnings.add(fmt::format("{} has {} values above {}: took that instead.", what, tooBright, MAX_RADIANCE));

    // Azimuth 0 is +x.
    for (auto row = environment.radiance.begin(); row != environment.radiance.end(); row += picture.width)
        std::rotate(row, row + picture.width / 2, row + picture.width);
    if (picture.width <= MAX_ENVIRONMENT_WIDTH && picture.height <= MAX_ENVIRONMENT_WIDTH) return environment;

    const double shrink = double(MAX_ENVIRONMENT_WIDTH) / std::max(picture.width, picture.height);
    const auto shrunk = [&](uint32_t size) { return std::max(1u, static_cast<uint32_t>(std::lround(size * shrink))); };
    warnings.add(fmt::format("{} is {} x {} pixels: reduced to {} x {}.", what, picture.width, picture.height,
                             shrunk(picture.width), shrunk(picture.height)));
    return reduce(environment, shrunk(picture.width), shrunk(picture.height));
}

void setEnvironment(Scene& scene, const std::filesystem::path& file, float scale)
{
    if (!file.empty()) {
        Warnings warnings;
        const std::string what = fmt::format("Environment \"{}\"", file.string());
        const image::Loaded loaded = image::read(file);
        for (const std::string& sentence : loaded.warnings) warnings.add(sentence);
        scene.environment = environmentFrom(loaded.image, what, warnings);
        for (const std::string& sentence : warnings.sentences()) scene.warnings.push_back(sentence);
    }
    for (glm::vec3& texel : scene.environment.radiance) texel *= scale;
}

} // namespace scene
