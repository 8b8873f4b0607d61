#include "tests/support/reference_tracer.h"

#include "engine/base/check.h"
#include "passes/camera_path.h"
#include "tests/support/reference_material.h"
#include "tests/support/stored_meshes.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <thread>

namespace support
{

namespace
{

using glm::dvec3, glm::dot, glm::cross;

constexpr double PI = std::numbers::pi;
constexpr double INF = std::numeric_limits<double>::infinity();

struct Ray {
    dvec3 origin, direction;     // unit
    uint32_t from = scene::NONE; // the triangle it starts on, which it does not meet again
};

// Positions of triangles, ready for intersection; alpha is asked for where it matters.
class Geometry
{
  public:
    explicit Geometry(const scene::Scene& scene) : scene_(scene)
    {
        dvec3 low(INF), high(-INF);
        for (const scene::Triangle& triangle : scene.triangles) {
            const dvec3 a = scene.positions[triangle.vertices[0]], b = scene.positions[triangle.vertices[1]],
                        c = scene.positions[triangle.vertices[2]];
            const bool opaque = scene.materials[triangle.material].alpha == scene::Alpha::Opaque;
            triangles_.push_back({a, b - a, c - a, opaque});
            low = glm::min(low, glm::min(a, glm::min(b, c)));
            high = glm::max(high, glm::max(a, glm::max(b, c)));
        }
        closest_ = triangles_.empty() ? 0 : 1e-10 * glm::length(high - low);
    }

    // The first surface that exists on the ray, each translucent one by chance.
    std::optional<ReferencePoint> trace(const Ray& ray, Random& random) const
    {
        double nearest = INF;
        std::optional<ReferencePoint> found;
        for (uint32_t i = 0; i < triangles_.size(); ++i) {
            ReferencePoint at{i};
            const double t = i == ray.from ? INF : meet(ray, at);
            if (t >= nearest || (!triangles_[i].opaque && uniform(random) >= alphaOf(scene_, at))) continue;
            nearest = t;
            found = at;
        }
        return found;
    }

    // The probability that nothing is in the way up to `distance`, where `target` is.
    double visibility(const Ray& ray, double distance, uint32_t target = scene::NONE) const
    {
        double result = 1;
        for (uint32_t i = 0; i < triangles_.size() && result > 0; ++i) {
            ReferencePoint at{i};
            if (i == ray.from || i == target || meet(ray, at) >= distance) continue;
            result *= triangles_[i].opaque ? 0 : 1 - alphaOf(scene_, at);
        }
        return result;
    }

    double area(uint32_t triangle) const
    {
        return glm::length(cross(triangles_[triangle].edge1, triangles_[triangle].edge2)) / 2;
    }

  private:
    struct Positions {
        dvec3 corner, edge1, edge2;
        bool opaque;
    };

    // Moeller and Trumbore 1997; infinity: not met.
    double meet(const Ray& ray, ReferencePoint& at) const
    {
        const Positions& p = triangles_[at.triangle];
        const dvec3 normal = cross(ray.direction, p.edge2);
        const double determinant = dot(p.edge1, normal);
        if (determinant == 0) return INF;
        const dvec3 offset = ray.origin - p.corner;
        at.u = dot(offset, normal) / determinant;
        if (at.u < 0 || at.u > 1) return INF;
        const dvec3 q = cross(offset, p.edge1);
        at.v = dot(ray.direction, q) / determinant;
        if (at.v < 0 || at.u + at.v > 1) return INF;
        const double t = dot(p.edge2, q) / determinant;
        return t > closest_ ? t : INF;
    }

    const scene::Scene& scene_;
    std::vector<Positions> triangles_;
    double closest_ = 0; // hits nearer than that are the ray's own surface
};

// Index by weight: the inverse of a cumulative sum.
class Choice
{
  public:
    void add(double weight) { sums_.push_back(total() + weight); }
    double total() const { return sums_.empty() ? 0 : sums_.back(); }
    double probability(size_t i) const { return (sums_[i] - (i > 0 ? sums_[i - 1] : 0)) / total(); }
    size_t operator()(Random& random) const
    {
        const auto at = std::upper_bound(sums_.begin(), sums_.end(), uniform(random) * total());
        return std::min(static_cast<size_t>(at - sums_.begin()), sums_.size() - 1);
    }

  private:
    std::vector<double> sums_;
};

double sum(const dvec3& color)
{
    return color.x + color.y + color.z;
}

// A direction to light, and what comes from there.
struct LightSample {
    dvec3 direction = dvec3(0, 1, 0);
    double distance = INF;
    dvec3 radiance = dvec3(0);
    double density = 0; // per solid angle
    uint32_t triangle = scene::NONE;
};

class EnvironmentLight
{
  public:
    EnvironmentLight(const scene::Environment& environment, double scale) : map_(environment), scale_(scale)
    {
        for (uint32_t row = 0; row < map_.height; ++row)
            for (uint32_t column = 0; column < map_.width; ++column)
                choice_.add(sum(texel(row, column)) * solidAngle(row));
    }
    bool shines() const { return choice_.total() > 0; }

    dvec3 radiance(const dvec3& direction) const
    {
        const double v = std::acos(std::clamp(direction.y, -1.0, 1.0)) / PI;
        const double azimuth = std::atan2(direction.z, direction.x) / (2 * PI), u = azimuth < 0 ? azimuth + 1 : azimuth;
        const auto at = [](double x, uint32_t size) { return std::min(static_cast<uint32_t>(x * size), size - 1); };
        return texel(at(v, map_.height), at(u, map_.width));
    }
    double density(const dvec3& direction) const { return sum(radiance(direction)) / choice_.total(); }

    LightSample sample(Random& random) const
    {
        const size_t i = choice_(random);
        const auto row = static_cast<uint32_t>(i / map_.width), column = static_cast<uint32_t>(i % map_.width);
        const double y = std::lerp(cosTheta(row), cosTheta(row + 1), uniform(random));
        const double phi = 2 * PI * (column + uniform(random)) / map_.width, r = std::sqrt(std::max(0.0, 1 - y * y));
        return {.direction = {r * std::cos(phi), y, r * std::sin(phi)},
                .radiance = texel(row, column),
                .density = sum(texel(row, column)) / choice_.total()};
    }

  private:
    dvec3 texel(uint32_t row, uint32_t column) const
    {
        return scale_ * dvec3(map_.radiance[row * map_.width + column]);
    }
    double cosTheta(uint32_t row) const { return std::cos(PI * row / map_.height); }
    double solidAngle(uint32_t row) const { return (cosTheta(row) - cosTheta(row + 1)) * 2 * PI / map_.width; }

    const scene::Environment& map_;
    double scale_;
    Choice choice_;
};

class Tracer
{
  public:
    Tracer(const scene::Scene& scene, const passes::Settings& settings)
        : scene_(scene), geometry_(scene), environment_(scene.environment, double{settings.environmentScale}),
          maxBounces_(settings.maxBounces)
    {
        for (uint32_t i = 0; i < scene.triangles.size(); ++i) {
            const scene::Material& m = scene.materials[scene.triangles[i].material];
            emission_.add(m.unlit ? 0 : geometry_.area(i) * sum(dvec3(m.emission)));
        }
    }

    // One path; its expectation is the radiance that arrives along the camera ray.
    dvec3 radiance(Ray ray, Random& random) const
    {
        dvec3 result(0), throughput(1);
        double density = INF; // of the ray's direction; infinite where next-event estimation cannot find it
        for (uint32_t events = 0;; ++events) {
            const std::optional<ReferencePoint> hit = geometry_.trace(ray, random);
            const dvec3 wo = -ray.direction;
            if (!hit) {
                if (environment_.shines())
                    result += throughput * environment_.radiance(ray.direction) *
                              share(density, environment_.density(ray.direction));
                return result;
            }
            const dvec3 position = positionOf(scene_, *hit);
            const dvec3 emitted = emissionOf(scene_, *hit, wo);
            if (emitted != dvec3(0)) result += throughput * emitted * share(density, densityOf(ray, *hit, position));
            if (events == maxBounces_) return result;

            const ReferenceSurface surface(scene_, *hit, wo);
            result += throughput * direct(surface, position, hit->triangle, random);
            const ReferenceSurface::Sample next = surface.sample(random);
            throughput *= next.weight;
            if (throughput == dvec3(0)) return result;
            density = next.dirac ? INF : surface.density(next.wi);
            ray = {position, next.wi, hit->triangle};
        }
    }

  private:
    // The balance heuristic (Veach 1997).
    static double share(double mine, double other) { return mine == INF ? 1 : mine / (mine + other); }

    // With which next-event estimation would have found this point from the ray's origin.
    double densityOf(const Ray& ray, const ReferencePoint& at, const dvec3& position) const
    {
        if (emission_.total() == 0) return 0;
        const dvec3 offset = position - ray.origin;
        const double cosine = std::abs(dot(frontNormal(scene_, at.triangle), ray.direction));
        return emission_.probability(at.triangle) / geometry_.area(at.triangle) * dot(offset, offset) / cosine;
    }

    LightSample sampleEmitter(const dvec3& from, Random& random) const
    {
        ReferencePoint at{static_cast<uint32_t>(emission_(random))};
        const double a = std::sqrt(uniform(random)), b = uniform(random);
        at.u = a * (1 - b);
        at.v = a * b;
        const dvec3 position = positionOf(scene_, at), offset = position - from;
        LightSample result = {.distance = glm::length(offset), .triangle = at.triangle};
        result.direction = offset / result.distance;
        result.radiance = emissionOf(scene_, at, -result.direction) * alphaOf(scene_, at);
        result.density = densityOf({from, result.direction}, at, position);
        return result;
    }

    // Light that scatters here as its last event and is found by looking for it.
    dvec3 direct(const ReferenceSurface& surface, const dvec3& position, uint32_t triangle, Random& random) const
    {
        dvec3 result(0);
        const auto add = [&](const LightSample& light, double weight) {
            const dvec3 f = surface.evaluate(light.direction);
            if (light.radiance == dvec3(0) || f == dvec3(0)) return;
            result += light.radiance * f * surface.cosine(light.direction) * weight *
                      geometry_.visibility({position, light.direction, triangle}, light.distance, light.triangle);
        };
        for (const scene::PunctualLight& light : scene_.lights) add(punctual(light, position), 1);
        const auto addSampled = [&](const LightSample& light) {
            if (!(light.density > 0)) return;
            add(light, share(light.density, surface.density(light.direction)) / light.density);
        };
        if (emission_.total() > 0) {
            const LightSample light = sampleEmitter(position, random);
            if (light.triangle != triangle) addSampled(light);
        }
        if (environment_.shines()) addSampled(environment_.sample(random));
        return result;
    }

    // `radiance` is the irradiance of a surface that faces the light.
    static LightSample punctual(const scene::PunctualLight& light, const dvec3& from)
    {
        LightSample result = {.radiance = light.intensity};
        if (light.kind == scene::LightKind::Directional) {
            result.direction = -dvec3(light.direction);
            return result;
        }
        const dvec3 offset = dvec3(light.position) - from;
        result.distance = glm::length(offset);
        result.direction = offset / result.distance;
        result.radiance /= result.distance * result.distance;
        if (light.kind == scene::LightKind::Spot) {
            const double outer = std::cos(double{light.outerConeAngle}), inner = std::cos(double{light.innerConeAngle});
            const double x = (-dot(result.direction, dvec3(light.direction)) - outer) / (inner - outer);
            result.radiance *= std::pow(std::clamp(x, 0.0, 1.0), 2);
        }
        return result;
    }

    const scene::Scene& scene_;
    Geometry geometry_;
    EnvironmentLight environment_;
    uint32_t maxBounces_;
    Choice emission_; // of triangles
};

// Through (x, y) of the picture, in pixels from its top left corner.
Ray cameraRay(const scene::Camera& camera, const passes::Settings& settings, double x, double y)
{
    const double s = 2 * x / settings.width - 1, t = 1 - 2 * y / settings.height;
    const double aspect = double(settings.width) / settings.height;
    const double halfHeight = camera.orthographic ? camera.ymag : std::tan(camera.yfov / 2);
    const dvec3 offset = halfHeight * (s * aspect * camera.right + t * camera.up);
    if (camera.orthographic) return {camera.position + offset, camera.forward};
    return {camera.position, glm::normalize(camera.forward + offset)};
}

} // namespace

PixelEstimates reference(const scene::Scene& world, const passes::Settings& settings, uint64_t samplesPerPixel,
                         uint64_t seed)
{
    CHECK(samplesPerPixel >= 2);
    const scene::Scene scene = expanded(world);
    const Tracer tracer(scene, settings);
    const scene::Camera& camera = scene.cameras[passes::chooseCamera(scene, settings.camera)];
    PixelEstimates result{settings.width, settings.height, {}};
    result.pixels.resize(size_t{settings.width} * settings.height);

    const auto renderPixel = [&](uint32_t pixel) {
        std::seed_seq sequence{static_cast<uint32_t>(seed), static_cast<uint32_t>(seed >> 32), pixel};
        Random random(sequence);
        std::array<Moments, 3> moments;
        for (uint64_t i = 0; i < samplesPerPixel; ++i) {
            const bool box = settings.pixelFilter == passes::PixelFilter::Box;
            const double dx = box ? uniform(random) : 0.5, dy = box ? uniform(random) : 0.5;
            const uint32_t x = pixel % settings.width, y = pixel / settings.width;
            const dvec3 radiance = tracer.radiance(cameraRay(camera, settings, x + dx, y + dy), random);
            for (int c = 0; c < 3; ++c) moments[static_cast<size_t>(c)].add(radiance[c]);
        }
        result.pixels[pixel] = {estimateOf(moments[0]), estimateOf(moments[1]), estimateOf(moments[2])};
    };

    std::atomic<uint32_t> next = 0;
    const auto work = [&] {
        for (uint32_t pixel = next++; pixel < result.pixels.size(); pixel = next++) renderPixel(pixel);
    };
    std::vector<std::jthread> threads;
    for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i) threads.emplace_back(work);
    threads.clear(); // joins
    return result;
}

} // namespace support
