#include "tests/support/lobe_numbers.h"

#include <cmath>
#include <numbers>

namespace support
{

namespace
{

using glm::dvec2, glm::dvec3;
using shared::Scattering;

constexpr double TURN = 2 * std::numbers::pi;
constexpr double STEP = 1e-6; // of the coordinates, for central differences

double wrapped(double x) // into [0, 1)
{
    return x - std::floor(x);
}

// Directions are drawn with their density's height over the disk: u = (radius^2, angle).
dvec2 numbersOfCosine(const dvec3& w)
{
    return {w.x * w.x + w.y * w.y, wrapped(std::atan2(w.y, w.x) / TURN)};
}

// The visible normal h is drawn as a point c of the sphere's cap above -w (both stretched), h = c + w: u = (angle,
// height of c from the top).
std::optional<dvec2> numbersOfVisibleNormal(const dvec3& wo, double alpha, const dvec3& h)
{
    const dvec3 w = glm::normalize(dvec3(alpha * wo.x, alpha * wo.y, wo.z));
    const dvec3 stretched = glm::normalize(dvec3(h.x / alpha, h.y / alpha, h.z));
    const double length = 2 * glm::dot(stretched, w); // so that c has length 1
    if (h.z <= 0 || length <= 0) return std::nullopt;
    const dvec3 c = length * stretched - w;
    return dvec2(wrapped(std::atan2(c.y, c.x) / TURN), (1 - c.z) / (1 + w.z));
}

double pickOf(const Scattering& at, Lobe lobe)
{
    return double{at.pick[int(lobe)]};
}

} // namespace

std::optional<dvec2> numbersOf(const Scattering& at, Lobe lobe, const dvec3& direction)
{
    const dvec3 wo(at.wo);
    const dvec3 wi(glm::dot(direction, dvec3(at.tangent)), glm::dot(direction, dvec3(at.bitangent)),
                   glm::dot(direction, dvec3(at.normal)));
    const double alpha = double{at.tangent.w}, eta = double{at.bitangent.w};
    const bool solid = at.normal.w != 0;
    if (pickOf(at, lobe) == 0 || (lobe == Lobe::Transmission ? wi.z >= 0 : wi.z <= 0)) return std::nullopt;
    if (lobe == Lobe::Diffuse) return numbersOfCosine(wi);
    if (lobe == Lobe::Reflection) return numbersOfVisibleNormal(wo, alpha, glm::normalize(wo + wi));
    if (!solid) return numbersOfVisibleNormal(wo, alpha, glm::normalize(wo + dvec3(wi.x, wi.y, -wi.z)));
    // Snell: the facet lies in the plane of both directions, along wo + eta wi.
    dvec3 h = glm::normalize(wo + eta * wi);
    if (h.z < 0) h = -h;
    if (glm::dot(wo, h) <= 0 || glm::dot(wi, h) >= 0) return std::nullopt;
    return numbersOfVisibleNormal(wo, alpha, h);
}

double densityOver(const Scattering& at, const Patch& patch)
{
    double sum = 0;
    for (const Lobe lobe : LOBES) {
        dvec2 slope[2];
        bool drawn = true;
        for (int i = 0; i < 2; ++i) {
            dvec2 step(0);
            step[i] = STEP;
            const auto after = numbersOf(at, lobe, patch(step)), before = numbersOf(at, lobe, patch(-step));
            drawn = drawn && after && before;
            if (!drawn) break;
            slope[i] = *after - *before;
            slope[i] = (slope[i] - glm::round(slope[i])) / (2 * STEP); // angles are known up to whole turns
        }
        if (drawn) sum += pickOf(at, lobe) * std::abs(slope[0].x * slope[1].y - slope[0].y * slope[1].x);
    }
    return sum;
}

std::optional<dvec3> numbersOf(const Scattering& at, const dvec3& direction)
{
    const dvec3 tangent =
        glm::normalize(glm::cross(direction, std::abs(direction.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
    const Patch around = [&](const dvec2& q) {
        return glm::normalize(direction + q.x * tangent + q.y * glm::cross(direction, tangent));
    };
    std::optional<dvec3> best;
    double most = 0, below = 0; // picks before this lobe's
    for (const Lobe lobe : LOBES) {
        Scattering alone = at;
        for (const Lobe other : LOBES)
            if (other != lobe) alone.pick[int(other)] = 0;
        const double density = densityOver(alone, around);
        const auto pair = numbersOf(at, lobe, direction);
        if (pair && density > most) {
            most = density;
            best = dvec3(below + pickOf(at, lobe) / 2, pair->x, pair->y);
        }
        below += pickOf(at, lobe);
    }
    return best;
}

} // namespace support
