#include "engine/image/metrics.h"

#include "engine/base/error.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace image
{

namespace
{

constexpr int WINDOW = 5; // radius of SSIM's Gaussian

struct Plane {
    int width, height;
    std::vector<double> values;

    double at(int x, int y) const
    {
        const int inX = std::clamp(x, 0, width - 1), inY = std::clamp(y, 0, height - 1);
        return values[size_t(inY) * size_t(width) + size_t(inX)];
    }
};

Plane tonemapped(const Image& picture, int channel)
{
    Plane plane{int(picture.width), int(picture.height), {}};
    for (const glm::vec3& pixel : picture.pixels) {
        const double value = std::max(double(pixel[channel]), 0.0);
        plane.values.push_back(value / (1 + value));
    }
    return plane;
}

// One pass of the window, along x or along y.
Plane blurred(const Plane& plane, int stepX, int stepY)
{
    std::array<double, 2 * WINDOW + 1> weights;
    double sum = 0;
    for (int i = -WINDOW; i <= WINDOW; ++i) sum += weights[size_t(i + WINDOW)] = std::exp(-i * i / (2 * 1.5 * 1.5));
    Plane result = plane;
    for (int y = 0; y < plane.height; ++y)
        for (int x = 0; x < plane.width; ++x) {
            double value = 0;
            for (int i = -WINDOW; i <= WINDOW; ++i)
                value += weights[size_t(i + WINDOW)] * plane.at(x + i * stepX, y + i * stepY);
            result.values[size_t(y) * size_t(plane.width) + size_t(x)] = value / sum;
        }
    return result;
}

Plane meanOfProduct(const Plane& a, const Plane& b)
{
    Plane product = a;
    for (size_t i = 0; i < product.values.size(); ++i) product.values[i] *= b.values[i];
    return blurred(blurred(product, 1, 0), 0, 1);
}

Plane mean(const Plane& a)
{
    return blurred(blurred(a, 1, 0), 0, 1);
}

// Over windows that lie inside the picture; along a side shorter than a window, over all, the edge repeated.
double ssimOf(const Plane& a, const Plane& b)
{
    const double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
    const Plane meanA = mean(a), meanB = mean(b);
    const Plane aa = meanOfProduct(a, a), bb = meanOfProduct(b, b), ab = meanOfProduct(a, b);
    const int cutX = a.width > 2 * WINDOW ? WINDOW : 0, cutY = a.height > 2 * WINDOW ? WINDOW : 0;
    double sum = 0, count = 0;
    for (int y = cutY; y < a.height - cutY; ++y)
        for (int x = cutX; x < a.width - cutX; ++x) {
            const double m = meanA.at(x, y), n = meanB.at(x, y);
            sum += (2 * m * n + c1) * (2 * (ab.at(x, y) - m * n) + c2) /
                   ((m * m + n * n + c1) * (aa.at(x, y) - m * m + bb.at(x, y) - n * n + c2));
            ++count;
        }
    return sum / count;
}

void requireFinite(const Image& picture)
{
    for (size_t i = 0; i < picture.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c)
            if (!std::isfinite(picture.pixels[i][c]))
                throw Error("Pixel {}, {} of a picture to measure is {}, not finite.", i % picture.width,
                            i / picture.width, picture.pixels[i][c]);
}

} // namespace

Metrics measure(const Image& reference, const Image& picture)
{
    if (reference.width != picture.width || reference.height != picture.height || reference.pixels.empty())
        throw Error("Pictures of {}x{} and {}x{} pixels cannot be compared.", reference.width, reference.height,
                    picture.width, picture.height);
    requireFinite(reference);
    requireFinite(picture);

    Metrics result;
    const double pixels = double(picture.pixels.size());
    glm::dvec3 sum(0), referenceSum(0);
    for (size_t i = 0; i < picture.pixels.size(); ++i) {
        const glm::dvec3 r(reference.pixels[i]), x(picture.pixels[i]), d = x - r;
        sum += x;
        referenceSum += r;
        for (int c = 0; c < 3; ++c) {
            result.mse += d[c] * d[c] / (3 * pixels);
            result.relmse += d[c] * d[c] / (r[c] * r[c] + RELATIVE_EPSILON) / (3 * pixels);
            result.mape += std::abs(d[c]) / (std::abs(r[c]) + RELATIVE_EPSILON) / (3 * pixels);
        }
        const double luma = d.r / 4 + d.g / 2 + d.b / 4, orange = (d.r - d.b) / 2, green = d.g / 2 - (d.r + d.b) / 4;
        result.lumaMse += luma * luma / pixels;
        result.chromaMse += (orange * orange + green * green) / pixels;
    }
    double tonemappedMse = 0;
    for (int c = 0; c < 3; ++c) {
        if (sum[c] != referenceSum[c]) result.meanRatio[c] = sum[c] / referenceSum[c];
        const Plane r = tonemapped(reference, c), x = tonemapped(picture, c);
        for (size_t i = 0; i < r.values.size(); ++i) {
            const double d = x.values[i] - r.values[i];
            tonemappedMse += d * d / (3 * pixels);
        }
        result.ssim += ssimOf(r, x) / 3;
    }
    result.psnr = -10 * std::log10(tonemappedMse);
    return result;
}

} // namespace image
