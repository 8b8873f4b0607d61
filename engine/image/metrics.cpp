#include "engine/image/metrics.h"

#include "engine/image/flip.h"
#include "engine/image/plane.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace image
{

namespace
{

constexpr int WINDOW = 5; // radius of SSIM's Gaussian

Plane mean(const Plane& plane)
{
    std::vector<double> kernel = gaussian(1.5, WINDOW);
    const double sum = std::accumulate(kernel.begin(), kernel.end(), 0.0);
    for (double& weight : kernel) weight /= sum;
    return filtered(plane, kernel, kernel);
}

Plane meanOfProduct(const Plane& a, const Plane& b)
{
    Plane product = a;
    for (size_t i = 0; i < product.values.size(); ++i) product.values[i] *= b.values[i];
    return mean(product);
}

// Of the window about each pixel.
Plane ssimMap(const Plane& a, const Plane& b)
{
    const double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
    const Plane meanA = mean(a), meanB = mean(b);
    const Plane aa = meanOfProduct(a, a), bb = meanOfProduct(b, b), ab = meanOfProduct(a, b);
    Plane map = meanA;
    for (size_t i = 0; i < map.values.size(); ++i) {
        const double m = meanA.values[i], n = meanB.values[i];
        map.values[i] = (2 * m * n + c1) * (2 * (ab.values[i] - m * n) + c2) /
                        ((m * m + n * n + c1) * (aa.values[i] - m * m + bb.values[i] - n * n + c2));
    }
    return map;
}

// Over windows that lie inside the picture; along a side shorter than a window, over all, the edge repeated. What is
// below 0 is compared as a picture of its own, and the worse of a pixel's two counts: with signs, the formula takes a
// picture and its negative for almost the same, since both of its factors change sign.
double ssimOf(const Plane& a, const Plane& b, bool signs)
{
    Plane map = ssimMap(partOf(a, Part::Above), partOf(b, Part::Above));
    if (signs) {
        const Plane below = ssimMap(partOf(a, Part::Below), partOf(b, Part::Below));
        for (size_t i = 0; i < map.values.size(); ++i) map.values[i] = std::min(map.values[i], below.values[i]);
    }
    const int cutX = a.width > 2 * WINDOW ? WINDOW : 0, cutY = a.height > 2 * WINDOW ? WINDOW : 0;
    double sum = 0, count = 0;
    for (int y = cutY; y < a.height - cutY; ++y)
        for (int x = cutX; x < a.width - cutX; ++x) {
            sum += map.values[size_t(y) * size_t(a.width) + size_t(x)];
            ++count;
        }
    return sum / count;
}

} // namespace

Metrics measure(const Image& reference, const Image& picture)
{
    requireComparable(reference, picture);
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
        const glm::dvec3 split = yCoCg(d);
        result.lumaMse += split.x * split.x / pixels;
        result.chromaMse += (split.y * split.y + split.z * split.z) / pixels;
    }
    double tonemappedMse = 0;
    const bool signs = countBelowZero(reference) + countBelowZero(picture) > 0;
    for (int c = 0; c < 3; ++c) {
        if (sum[c] != referenceSum[c]) result.meanRatio[c] = sum[c] / referenceSum[c];
        const Plane r = tonemapped(reference, c), x = tonemapped(picture, c);
        for (size_t i = 0; i < r.values.size(); ++i) {
            const double d = x.values[i] - r.values[i];
            tonemappedMse += d * d / (3 * pixels);
        }
        result.ssim += ssimOf(r, x, signs) / 3;
    }
    result.psnr = -10 * std::log10(tonemappedMse);
    result.flip = meanOf(flipErrors(reference, picture));
    return result;
}

} // namespace image
