#include "engine/scene/light_tables.h"

#include "engine/base/check.h"
#include "engine/image/image.h"
#include "engine/scene/alias_table.h"
#include "engine/scene/motion.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace scene
{

namespace
{

using std::numbers::pi;

// cos a - cos b, as a product: the difference has no digits left for small angles.
double cosineDifference(double a, double b)
{
    return 2 * std::sin((a + b) / 2) * std::sin((b - a) / 2);
}

double largest(const glm::dvec3& v)
{
    return std::max(std::max(v.x, v.y), v.z);
}

glm::uvec4 row(const glm::dvec3& v, double w)
{
    return std::bit_cast<glm::uvec4>(glm::vec4(float(v.x), float(v.y), float(v.z), float(w)));
}

// Mean of the largest channel over the whole image, linear: how much of the emission a texture lets through, roughly.
double meanOfLargest(const Image& image)
{
    double sum = 0;
    for (size_t i = 0; i < image.sampleCount(); i += 4)
        sum += image::linearFromSrgb(std::max(std::max(image.sample(i), image.sample(i + 1)), image.sample(i + 2)));
    return sum / (double(image.sampleCount()) / 4);
}

// Intensity in scaled lengths: E = I / d^2 stays the same irradiance.
glm::dvec3 scaledIntensity(const PunctualLight& light, double lengthScale)
{
    const double factor = light.kind == LightKind::Directional ? 1 : lengthScale * lengthScale;
    return glm::dvec3(light.intensity) * factor;
}

double largestLight(const Scene& scene, double lengthScale)
{
    double value = 0;
    const std::vector<bool> used = usedMaterials(scene);
    for (size_t i = 0; i < used.size(); ++i) {
        const Material& material = scene.materials[i];
        if (!used[i]) continue;
        value = std::max(value, largest(glm::dvec3(material.emission)));
        if (material.unlit) value = std::max(value, largest(glm::dvec3(glm::vec3(material.baseColor))));
    }
    for (const glm::vec3& radiance : scene.environment.radiance) value = std::max(value, largest(glm::dvec3(radiance)));
    for (const PunctualLight& light : scene.lights)
        value = std::max(value, largest(scaledIntensity(light, lengthScale)));
    return value;
}

// Scaled. In float as the shaders have it: what has no area there cannot be sampled there, and has 0 here.
double areaOf(const Scene& scene, const std::vector<glm::vec3>& positions, uint32_t triangle)
{
    const auto corner = [&](size_t i) { return positions[scene.triangles[triangle].vertices[i]]; };
    const float twice = glm::length(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
    return twice > 0 && std::isfinite(twice) ? 0.5 * double(twice) : 0;
}

struct Candidate {
    uint32_t kind = 0;
    uint32_t index = 0;
    double power = 0;
};

// Emissive triangles of positive area; with `moves`, of any, and those that an animation may make emit.
std::vector<uint32_t> emittersOf(const Scene& scene, const std::vector<glm::vec3>& positions,
                                 const std::vector<double>& emissiveMeans, bool moves)
{
    std::vector<bool> painted(scene.materials.size());
    if (moves)
        for (const Motion::Paint& paint : scene.motion->paints) painted[paint.material] = true;
    std::vector<bool> emits;
    for (size_t i = 0; i < scene.materials.size(); ++i) {
        const Material& material = scene.materials[i];
        const bool shines = painted[i] || largest(glm::dvec3(material.emission)) > 0;
        emits.push_back(!material.unlit && shines && emissiveMeans[i] > 0);
    }
    std::vector<uint32_t> emitters;
    for (uint32_t t = 0; t < scene.triangles.size(); ++t)
        if (emits[scene.triangles[t].material] && (moves || areaOf(scene, positions, t) > 0)) emitters.push_back(t);
    return emitters;
}

// A textured emitter counts with its image's mean: the pick probability may be rough, the estimate stays unbiased.
void addTriangles(const Scene& scene, const std::vector<glm::vec3>& positions, const LightTables& tables,
                  std::vector<Candidate>& candidates)
{
    for (const uint32_t t : tables.emitters) {
        const uint32_t index = scene.triangles[t].material;
        const Material& material = scene.materials[index];
        const double exitance = pi * tables.radianceScale * largest(glm::dvec3(material.emission)) *
                                (material.doubleSided ? 2 : 1) * tables.emissiveMeans[index];
        candidates.push_back({shared::LIGHT_TRIANGLE, t, exitance * areaOf(scene, positions, t)});
    }
}

double punctualPower(const PunctualLight& light, const glm::dvec3& intensity, double radius)
{
    switch (light.kind) {
    case LightKind::Point: return 4 * pi * largest(intensity);
    case LightKind::Spot: return 2 * pi * cosineDifference(0, double(light.outerConeAngle)) * largest(intensity);
    case LightKind::Directional: return pi * radius * radius * largest(intensity);
    }
    return 0;
}

void addPunctual(const Scene& scene, double lengthScale, double radius, LightTables& tables,
                 std::vector<Candidate>& candidates)
{
    for (size_t i = 0; i < scene.lights.size(); ++i) {
        const PunctualLight& light = scene.lights[i];
        const glm::dvec3 intensity = scaledIntensity(light, lengthScale) * tables.radianceScale;
        const double inner = double(light.innerConeAngle), outer = double(light.outerConeAngle);
        const bool spot = light.kind == LightKind::Spot;
        tables.punctual.push_back(row(glm::dvec3(light.position) * lengthScale, cosineDifference(0, outer)));
        tables.punctual.push_back(row(intensity, spot ? 1 / cosineDifference(inner, outer) : 0));
        tables.punctual.push_back(row(glm::dvec3(light.direction), 0));
        tables.counts.points += light.kind == LightKind::Point;
        tables.counts.spots += spot;
        tables.counts.directionals += light.kind == LightKind::Directional;
        const double power = punctualPower(light, intensity, radius);
        const uint32_t kind = light.kind == LightKind::Directional ? shared::LIGHT_DIRECTIONAL : shared::LIGHT_PUNCTUAL;
        if (power > 0) candidates.push_back({kind, uint32_t(i), power});
    }
}

std::vector<double> emissiveMeansOf(const Scene& scene)
{
    std::vector<double> means;
    for (const Material& material : scene.materials) {
        const uint32_t image = material.emissiveTexture.image;
        means.push_back(image == NONE ? 1 : meanOfLargest(scene.images[image]));
    }
    return means;
}

// The environment's rows, and its power: radiance over the sphere of directions, through a disk of radius 1.
void addEnvironment(const Environment& environment, LightTables& tables)
{
    if (environment.width == 0) return;
    const size_t count = environment.radiance.size();
    std::vector<double> power(count), solidAngle(environment.height);
    double total = 0;
    for (uint32_t y = 0; y < environment.height; ++y)
        solidAngle[y] = 2 * pi / environment.width *
                        cosineDifference(pi * y / environment.height, pi * (y + 1.0) / environment.height);
    for (size_t i = 0; i < count; ++i) {
        power[i] =
            largest(glm::dvec3(environment.radiance[i]) * tables.radianceScale) * solidAngle[i / environment.width];
        total += power[i];
    }
    const std::vector<AliasEntry> aliases = buildAliasTable(power);
    for (size_t i = 0; i < count; ++i)
        tables.environment.push_back(row(glm::dvec3(environment.radiance[i]) * tables.radianceScale,
                                         total > 0 ? power[i] / total / solidAngle[i / environment.width] : 0));
    for (size_t i = 0; i < count; i += 2) {
        const AliasEntry& a = aliases[i];
        const AliasEntry& b = aliases[std::min(i + 1, count - 1)];
        tables.environmentAliases.emplace_back(std::bit_cast<uint32_t>(a.threshold), a.alias,
                                               std::bit_cast<uint32_t>(b.threshold), b.alias);
    }
    tables.environmentPower = pi * total;
}

} // namespace

namespace
{

// What differs from pose to pose.
void pickLights(const Scene& scene, const std::vector<glm::vec3>& positions, double lengthScale, double radius,
                LightTables& tables)
{
    std::vector<Candidate> candidates;
    addTriangles(scene, positions, tables, candidates);
    tables.counts.emissiveTriangles =
        uint64_t(std::ranges::count_if(candidates, [](const Candidate& c) { return c.power > 0; }));
    addPunctual(scene, lengthScale, radius, tables, candidates);
    tables.counts.environments = scene.environment.width > 0;
    const double environmentPower = tables.environmentPower * std::max(radius, 0.5) * std::max(radius, 0.5);
    if (environmentPower > 0) candidates.push_back({shared::LIGHT_ENVIRONMENT, 0, environmentPower});

    std::vector<double> powers;
    for (const Candidate& candidate : candidates) powers.push_back(candidate.power);
    const std::vector<AliasEntry> aliases = buildAliasTable(powers);
    for (size_t i = 0; i < candidates.size(); ++i) {
        const Candidate& candidate = candidates[i];
        CHECK(candidate.index < 1u << 30);
        tables.lights.emplace_back(std::bit_cast<uint32_t>(aliases[i].threshold), aliases[i].alias,
                                   std::bit_cast<uint32_t>(aliases[i].probability),
                                   candidate.kind | candidate.index << 2);
        if (candidate.kind == shared::LIGHT_ENVIRONMENT) tables.environmentPick = aliases[i].probability;
    }
    tables.shine = std::ranges::any_of(powers, [](double power) { return power > 0; });
}

} // namespace

LightTables makeLightTables(const Scene& scene, const std::vector<glm::vec3>& positions, double lengthScale,
                            double radius, bool moves)
{
    LightTables tables;
    const double value = largestLight(scene, lengthScale);
    if (value > 0) tables.radianceScale = std::exp2(-std::round(std::log2(value)));
    tables.emissiveMeans = emissiveMeansOf(scene);
    addEnvironment(scene.environment, tables);
    tables.emitters = emittersOf(scene, positions, tables.emissiveMeans, moves);
    tables.lightOfTriangle.assign(scene.triangles.size(), shared::NO_INDEX);
    for (size_t i = 0; i < tables.emitters.size(); ++i) tables.lightOfTriangle[tables.emitters[i]] = uint32_t(i);
    pickLights(scene, positions, lengthScale, radius, tables);
    return tables;
}

LightTables makeLightTables(const Scene& posed, const std::vector<glm::vec3>& positions, double lengthScale,
                            double radius, const LightTables& rest)
{
    LightTables tables;
    tables.radianceScale = rest.radianceScale;
    tables.environmentPower = rest.environmentPower;
    tables.emissiveMeans = rest.emissiveMeans;
    tables.emitters = rest.emitters;
    pickLights(posed, positions, lengthScale, radius, tables);
    return tables;
}

} // namespace scene
