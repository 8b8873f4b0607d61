#include "engine/image/plane.h"

#include "engine/base/check.h"
#include "engine/base/error.h"

#include <algorithm>
#include <cmath>

namespace image
{

namespace
{

void requireFinite(const Image& picture, const char* which)
{
    for (size_t i = 0; i < picture.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c)
            if (!std::isfinite(picture.pixels[i][c]))
                throw Error("The {} of pixel ({}, {}) of the {} is {}, which is not finite.",
                            std::array{"red", "green", "blue"}[size_t(c)], i % picture.width, i / picture.width, which,
                            picture.pixels[i][c]);
}

} // namespace

Plane tonemapped(const Image& picture, int channel)
{
    Plane plane{int(picture.width), int(picture.height), {}};
    plane.values.reserve(picture.pixels.size());
    for (const glm::vec3& pixel : picture.pixels) {
        const double value = pixel[channel];
        plane.values.push_back(value / (1 + std::abs(value)));
    }
    return plane;
}

Plane partOf(const Plane& plane, Part part)
{
    Plane result = plane;
    for (double& value : result.values) value = std::max(part == Part::Above ? value : -value, 0.0);
    return result;
}

Plane filtered(const Plane& plane, std::span<const double> alongX, std::span<const double> alongY)
{
    CHECK_EQ(alongX.size() % 2, 1u);
    CHECK_EQ(alongY.size() % 2, 1u);
    const size_t width = size_t(plane.width), radius = alongX.size() / 2;
    Plane rows{plane.width, plane.height, std::vector<double>(plane.values.size())};
    std::vector<double> padded(width + 2 * radius);
    for (int y = 0; y < plane.height; ++y) {
        const double* const in = &plane.values[size_t(y) * width];
        double* const out = &rows.values[size_t(y) * width];
        std::fill_n(padded.begin(), radius, in[0]);
        std::copy_n(in, width, padded.begin() + ptrdiff_t(radius));
        std::fill_n(padded.end() - ptrdiff_t(radius), radius, in[width - 1]);
        for (size_t k = 0; k < alongX.size(); ++k)
            for (size_t x = 0; x < width; ++x) out[x] += alongX[k] * padded[x + k];
    }
    Plane result{plane.width, plane.height, std::vector<double>(plane.values.size())};
    const int radiusY = int(alongY.size() / 2);
    for (int y = 0; y < plane.height; ++y) {
        double* const out = &result.values[size_t(y) * width];
        for (int k = -radiusY; k <= radiusY; ++k) {
            const double* const in = &rows.values[size_t(std::clamp(y + k, 0, plane.height - 1)) * width];
            const double weight = alongY[size_t(k + radiusY)];
            for (size_t x = 0; x < width; ++x) out[x] += weight * in[x];
        }
    }
    return result;
}

std::vector<double> gaussian(double sigma, int radius)
{
    std::vector<double> kernel;
    for (int x = -radius; x <= radius; ++x) kernel.push_back(std::exp(-x * x / (2 * sigma * sigma)));
    return kernel;
}

size_t countBelowZero(const Image& picture)
{
    size_t count = 0;
    for (const glm::vec3& pixel : picture.pixels)
        for (int c = 0; c < 3; ++c) count += pixel[c] < 0;
    return count;
}

void requireComparable(const Image& reference, const Image& picture)
{
    if (reference.width != picture.width || reference.height != picture.height || reference.pixels.empty())
        throw Error("The reference has {}x{} pixels and the picture {}x{}, so they cannot be compared.",
                    reference.width, reference.height, picture.width, picture.height);
    requireFinite(reference, "reference");
    requireFinite(picture, "picture");
}

} // namespace image
