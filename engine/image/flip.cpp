#include "engine/image/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

namespace image
{

namespace
{

constexpr double PIXELS_PER_DEGREE = 67; // 0.7 m from a screen 0.7 m wide of 3840 pixels

// The color of a pixel, or a color in another space, always three planes or a vector.
using Planes = std::array<Plane, 3>;

// Linear Rec. 709 to XYZ, as the authors have it; columns. White is the sum of the columns.
const glm::dmat3 XYZ_FROM_RGB = {
    {0.4123866, 0.2126368, 0.0193306}, {0.3575915, 0.7151830, 0.1191972}, {0.1804505, 0.0721802, 0.9503726}};
const glm::dmat3 RGB_FROM_XYZ = glm::inverse(XYZ_FROM_RGB);
const glm::dvec3 WHITE = XYZ_FROM_RGB * glm::dvec3(1);

// The opponent space Y Cx Cz, and its shape in L* a* b*.
glm::dvec3 opponent(const glm::dvec3& v)
{
    return {116 * v.y - 16, 500 * (v.x - v.y), 200 * (v.y - v.z)};
}

glm::dvec3 opponentFromRgb(const glm::dvec3& rgb)
{
    return opponent(XYZ_FROM_RGB * rgb / WHITE);
}

glm::dvec3 rgbFromOpponent(const glm::dvec3& color)
{
    const double y = (color.x + 16) / 116;
    return RGB_FROM_XYZ * (WHITE * glm::dvec3(y + color.y / 500, y, y - color.z / 200));
}

// L* a* b* with a* and b* weighted by lightness (Hunt).
glm::dvec3 huntLabFromRgb(const glm::dvec3& rgb)
{
    constexpr double DELTA = 6.0 / 29;
    glm::dvec3 v = XYZ_FROM_RGB * rgb / WHITE;
    for (int c = 0; c < 3; ++c)
        v[c] = v[c] > DELTA * DELTA * DELTA ? std::cbrt(v[c]) : v[c] / (3 * DELTA * DELTA) + 4.0 / 29;
    const glm::dvec3 lab = opponent(v);
    return {lab.x, 0.01 * lab.x * lab.y, 0.01 * lab.x * lab.z};
}

double hyab(const glm::dvec3& a, const glm::dvec3& b)
{
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

Planes opponentPlanes(const Image& picture, Part part)
{
    Planes planes;
    for (size_t c = 0; c < 3; ++c) planes[c] = partOf(tonemapped(picture, int(c)), part);
    for (size_t i = 0; i < picture.pixels.size(); ++i) {
        const glm::dvec3 color = opponentFromRgb({planes[0].values[i], planes[1].values[i], planes[2].values[i]});
        for (int c = 0; c < 3; ++c) planes[size_t(c)].values[i] = color[c];
    }
    return planes;
}

// Contrast sensitivity as a sum of a sqrt(pi / b) exp(-pi^2 d^2 / b) over degrees d.
struct Sensitivity {
    double a, b;
};
const std::array<std::vector<Sensitivity>, 3> SENSITIVITIES = {
    {{{1, 0.0047}}, {{1, 0.0053}}, {{34.1, 0.04}, {13.5, 0.025}}}};

// What the eye resolves of a plane, at weights that sum to 1.
Plane seen(const Plane& plane, const std::vector<Sensitivity>& terms)
{
    constexpr double WIDEST = 0.04; // b
    const auto sigma = [](double b) { return std::sqrt(b / 2) / std::numbers::pi * PIXELS_PER_DEGREE; };
    const int radius = int(std::ceil(3 * sigma(WIDEST)));
    Plane result{plane.width, plane.height, std::vector<double>(plane.values.size())};
    double total = 0;
    for (const auto& [a, b] : terms) {
        const std::vector<double> kernel = gaussian(sigma(b), radius);
        const double weight = a * std::sqrt(std::numbers::pi / b);
        const double sum = std::accumulate(kernel.begin(), kernel.end(), 0.0);
        total += weight * sum * sum;
        const Plane part = filtered(plane, kernel, kernel);
        for (size_t i = 0; i < part.values.size(); ++i) result.values[i] += weight * part.values[i];
    }
    for (double& value : result.values) value /= total;
    return result;
}

std::vector<glm::dvec3> perceivedColors(const Planes& planes)
{
    Planes blurred;
    for (size_t c = 0; c < 3; ++c) blurred[c] = seen(planes[c], SENSITIVITIES[c]);
    std::vector<glm::dvec3> colors;
    colors.reserve(blurred[0].values.size());
    for (size_t i = 0; i < blurred[0].values.size(); ++i) {
        const glm::dvec3 rgb = rgbFromOpponent({blurred[0].values[i], blurred[1].values[i], blurred[2].values[i]});
        colors.push_back(huntLabFromRgb(glm::clamp(rgb, 0.0, 1.0)));
    }
    return colors;
}

// Weights above 0 sum to 1, those below to -1.
std::vector<double> balanced(std::vector<double> kernel)
{
    double above = 0, below = 0;
    for (const double weight : kernel) (weight > 0 ? above : below) += weight;
    for (double& weight : kernel) weight /= weight > 0 ? above : -below;
    return kernel;
}

// Strength of edges and of points in the achromatic plane.
struct Features {
    std::vector<double> edges, points;
};

Features featuresOf(const Plane& achromatic)
{
    constexpr double SIGMA = 0.5 * 0.082 * PIXELS_PER_DEGREE;
    const int radius = int(std::ceil(3 * SIGMA));
    Plane y = achromatic;
    for (double& value : y.values) value = (value + 16) / 116;

    std::vector<double> across = gaussian(SIGMA, radius), first = across, second = across;
    for (int x = -radius; x <= radius; ++x) {
        first[size_t(x + radius)] *= -x;
        second[size_t(x + radius)] *= x * x / (SIGMA * SIGMA) - 1;
    }
    const double sum = std::accumulate(across.begin(), across.end(), 0.0);
    for (double& weight : across) weight /= sum;
    const auto strength = [&](const std::vector<double>& derivative) {
        Plane along = filtered(y, derivative, across);
        const Plane other = filtered(y, across, derivative);
        for (size_t i = 0; i < along.values.size(); ++i) along.values[i] = std::hypot(along.values[i], other.values[i]);
        return along.values;
    };
    return {strength(balanced(first)), strength(balanced(second))};
}

// Compresses large errors, so that the largest of all, green against blue, is 1.
double redistributed(double distance)
{
    constexpr double EXPONENT = 0.7, KNEE = 0.4, KNEE_ERROR = 0.95;
    static const double LARGEST = std::pow(hyab(huntLabFromRgb({0, 1, 0}), huntLabFromRgb({0, 0, 1})), EXPONENT);
    const double error = std::pow(distance, EXPONENT) / LARGEST;
    return error < KNEE ? error * KNEE_ERROR / KNEE : KNEE_ERROR + (error - KNEE) / (1 - KNEE) * (1 - KNEE_ERROR);
}

Plane errorsOf(const Image& reference, const Image& picture, Part part)
{
    const Planes a = opponentPlanes(reference, part), b = opponentPlanes(picture, part);
    const std::vector<glm::dvec3> colorsA = perceivedColors(a), colorsB = perceivedColors(b);
    const Features featuresA = featuresOf(a[0]), featuresB = featuresOf(b[0]);

    Plane errors{a[0].width, a[0].height, std::vector<double>(a[0].values.size())};
    for (size_t i = 0; i < errors.values.size(); ++i) {
        const double color = redistributed(hyab(colorsA[i], colorsB[i]));
        const double feature = std::max(std::abs(featuresA.edges[i] - featuresB.edges[i]),
                                        std::abs(featuresA.points[i] - featuresB.points[i]));
        errors.values[i] = std::pow(color, 1 - std::sqrt(feature / std::numbers::sqrt2));
    }
    return errors;
}

} // namespace

Plane flipErrors(const Image& reference, const Image& picture)
{
    requireComparable(reference, picture);
    Plane errors = errorsOf(reference, picture, Part::Above);
    if (countBelowZero(reference) + countBelowZero(picture) == 0) return errors;
    const Plane below = errorsOf(reference, picture, Part::Below);
    for (size_t i = 0; i < errors.values.size(); ++i) errors.values[i] = std::max(errors.values[i], below.values[i]);
    return errors;
}

double meanOf(const Plane& plane)
{
    return std::accumulate(plane.values.begin(), plane.values.end(), 0.0) / double(plane.values.size());
}

} // namespace image
