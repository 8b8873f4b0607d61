#include "tests/support/closed_forms.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "engine/scene/procedural.h"
#include "engine/scene/shapes.h"

namespace support
{

namespace
{

using glm::dvec3;

constexpr double PI = std::numbers::pi;
passes::Settings square(uint32_t size, uint32_t maxBounces)
{
    passes::Settings settings;
    settings.width = settings.height = size;
    settings.maxBounces = maxBounces;
    return settings;
}

ClosedForm pointLight(uint32_t size)
{
    scene::Scene scene = floorFromAbove();
    const dvec3 at(0.25, 0.75, -0.125), intensity(1, 2, 3);
    scene.lights.push_back({.intensity = intensity, .position = at});
    return {"PointLight", scene, square(size, 1), [=](double x, double y) {
                const dvec3 to = at - dvec3(x, 0, y);
                const double r = glm::length(to);
                return dvec3(FLOOR_ALBEDO) / PI * intensity * to.y / (r * r * r);
            }};
}

ClosedForm spotLight(uint32_t size)
{
    scene::Scene scene = floorFromAbove();
    const float inner = 0.2f, outer = 0.6f;
    scene.lights.push_back({.kind = scene::LightKind::Spot,
                            .position = {0, 1, 0},
                            .direction = {0, -1, 0},
                            .innerConeAngle = inner,
                            .outerConeAngle = outer});
    return {"SpotLight", scene, square(size, 1), [=](double x, double y) {
                const double r2 = x * x + y * y + 1, cosine = 1 / std::sqrt(r2);
                const double cosInner = std::cos(double{inner}), cosOuter = std::cos(double{outer});
                const double s = std::clamp((cosine - cosOuter) / (cosInner - cosOuter), 0.0, 1.0);
                return dvec3(FLOOR_ALBEDO) / PI * (s * s * cosine / r2);
            }};
}

ClosedForm directionalLight(uint32_t size)
{
    scene::Scene scene = floorFromAbove();
    scene.lights.push_back(
        {.kind = scene::LightKind::Directional, .intensity = {1, 2, 3}, .direction = {0.6f, -0.8f, 0}});
    return {"DirectionalLight", scene, square(size, 1),
            [](double, double) { return dvec3(FLOOR_ALBEDO) / PI * 0.8 * dvec3(1, 2, 3); }};
}

// Each texel fills half the azimuth; the rows end at 45 and 90 degrees: half of the floor's irradiance each.
ClosedForm sky(uint32_t size)
{
    scene::Scene scene = floorFromAbove();
    scene.environment = {
        2, 4, {{1, 0, 0}, {0, 1, 0}, {0, 0, 3}, {0, 0, 5}, {9, 9, 9}, {9, 9, 9}, {9, 9, 9}, {9, 9, 9}}};
    return {"Sky", scene, square(size, 1), [](double, double) { return dvec3(FLOOR_ALBEDO) * dvec3(0.25, 0.25, 2); }};
}

// Irradiance of a floor that faces a texel of radiance 1: the integral of cos theta over it, as a product.
double irradianceOfTexel(const scene::Environment& sky, uint32_t row)
{
    return PI / sky.width * std::sin((2.0 * row + 1) * PI / sky.height) * std::sin(PI / sky.height);
}

} // namespace

const glm::vec3 FLOOR_ALBEDO = {0.5f, 0.4f, 0.3f};

scene::Scene floorFromAbove()
{
    scene::Scene scene;
    scene::addQuad(scene, scene::addMaterial(scene, scene::diffuse("floor", FLOOR_ALBEDO)), {-2, 0, 2}, {4, 0, 0},
                   {0, 0, -4});
    scene::Camera camera;
    camera.position = {0, 1, 0};
    camera.right = {1, 0, 0};
    camera.up = {0, 0, -1};
    camera.forward = {0, -1, 0};
    camera.yfov = PI / 2;
    scene.cameras.push_back(camera);
    return scene;
}

// Four corner configurations make the form factor of any parallel rectangle (Siegel and Howell).
ClosedForm rectangleLight(uint32_t size, uint32_t columns, uint32_t rows)
{
    scene::Scene scene = floorFromAbove();
    const uint32_t light = scene::addMaterial(scene, scene::emitter("light", {1, 2, 4}));
    const float width = 1.5f / float(columns), depth = 0.75f / float(rows);
    for (uint32_t i = 0; i < columns; ++i)
        for (uint32_t j = 0; j < rows; ++j) // front down
            scene::addQuad(scene, light, {width * float(i), 1.25f, depth * float(j)}, {width, 0, 0}, {0, 0, depth});
    return {"RectangleLight", scene, square(size, 1), [](double x, double y) {
                const auto corner = [](double u, double v) {
                    const double a = u / 1.25, b = v / 1.25, A = std::sqrt(1 + a * a), B = std::sqrt(1 + b * b);
                    return (a / A * std::atan(b / A) + b / B * std::atan(a / B)) / (2 * PI);
                };
                const double factor =
                    corner(1.5 - x, 0.75 - y) - corner(-x, 0.75 - y) - corner(1.5 - x, -y) + corner(-x, -y);
                return dvec3(FLOOR_ALBEDO) * factor * dvec3(1, 2, 4);
            }};
}

ClosedForm texelOfASky(uint32_t size, uint32_t columns, uint32_t rows, uint32_t row)
{
    scene::Scene scene = floorFromAbove();
    scene.environment = {columns, rows, std::vector<glm::vec3>(size_t{columns} * rows, glm::vec3(0))};
    const double received = std::abs(irradianceOfTexel(scene.environment, row)); // at radiance 1
    const auto radiance = glm::vec3(float(PI / received));
    scene.environment.radiance[size_t{row} * columns + columns / 3] = radiance;
    if (2 * row >= rows) {
        scene::Camera& camera = scene.cameras[0];
        camera.position = -camera.position;
        camera.up = -camera.up;
        camera.forward = -camera.forward;
    }
    const dvec3 leaving = dvec3(FLOOR_ALBEDO) / PI * received * dvec3(radiance);
    return {"TexelOfASky", scene, square(size, 1), [=](double, double) { return leaving; }};
}

ClosedForm sunInASky(uint32_t size)
{
    constexpr uint32_t ROWS = 1024;
    constexpr double STEP = PI / ROWS, RADIUS = 0.25 * PI / 180;
    scene::Scene scene = floorFromAbove();
    scene.environment = {2 * ROWS, ROWS, {}};
    const auto towards = [](double polar, double azimuth) {
        return dvec3(std::sin(polar) * std::cos(azimuth), std::cos(polar), std::sin(polar) * std::sin(azimuth));
    };
    const dvec3 sun = towards(50 * PI / 180, 2);
    dvec3 received(0);
    for (uint32_t row = 0; row < ROWS; ++row)
        for (uint32_t column = 0; column < 2 * ROWS; ++column) {
            const dvec3 middle = towards((row + 0.5) * STEP, (column + 0.5) * STEP);
            const bool inside = glm::length(middle - sun) < 2 * std::sin(RADIUS / 2);
            const glm::vec3 radiance = inside ? glm::vec3(8e4f, 7e4f, 6e4f) : glm::vec3(0.01f, 0.02f, 0.03f);
            scene.environment.radiance.push_back(radiance);
            if (row < ROWS / 2) received += dvec3(radiance) * irradianceOfTexel(scene.environment, row);
        }
    const dvec3 leaving = dvec3(FLOOR_ALBEDO) / PI * received;
    return {"SunInASky", scene, square(size, 1), [=](double, double) { return leaving; }};
}

ClosedForm furnace(uint32_t size, uint32_t maxBounces)
{
    return {"Furnace", scene::makeFurnace(), square(size, maxBounces),
            [=](double, double) { return 1.0 - glm::pow(dvec3(scene::FURNACE_ALBEDO), dvec3(maxBounces + 1.0)); }};
}

// E = integral over half vectors of D G2 (o.h) / cos o, where the mirrored direction leaves the surface; the variable u
// of h is the cumulative sum of D cos h, so that narrow lobes are as smooth as wide ones. At grazing angles half
// vectors near the horizon count, so that steps shrink towards both ends of u.
double ggxAlbedo(double width, double cosine)
{
    constexpr int STEPS = 1000;
    const auto lambda = [&](double c) { return (std::sqrt(1 + width * width * (1 - c * c) / (c * c)) - 1) / 2; };
    const double sine = std::sqrt(1 - cosine * cosine);
    double sum = 0;
    for (int i = 0; i < STEPS; ++i) {
        const double t = (i + 0.5) / STEPS, rest = (1 - t) * (1 - t) * (1 + 2 * t), u = 1 - rest, du = 6 * t * (1 - t);
        const double cosH = std::sqrt(rest / (1 + (width * width - 1) * u)), sinH = std::sqrt(1 - cosH * cosH);
        for (int j = 0; j < STEPS; ++j) {
            const double oh = cosine * cosH + sine * sinH * std::cos(PI * (j + 0.5) / STEPS);
            const double cosI = 2 * oh * cosH - cosine;
            if (oh > 0 && cosI > 0) sum += du * oh / (cosine * cosH * (1 + lambda(cosine) + lambda(cosI)));
        }
    }
    return sum / (double{STEPS} * STEPS);
}

ClosedForm ggxUnderWhiteSky(uint32_t size, float roughness, double cosine)
{
    scene::Scene scene;
    scene::addQuad(scene, scene::addMaterial(scene, {.metallic = 1, .roughness = roughness}), {-1, 0, 1}, {2, 0, 0},
                   {0, 0, -2});
    scene.environment = {1, 1, {glm::vec3(1)}};
    scene::Camera camera = scene::lookAt("camera", dvec3(0, cosine, std::sqrt(1 - cosine * cosine)), dvec3(0), 45);
    camera.orthographic = true;
    camera.ymag = 0.1 * cosine; // the picture is all floor
    scene.cameras.push_back(camera);
    const double albedo = ggxAlbedo(double{roughness} * roughness, cosine);
    return {"GgxUnderWhiteSky", scene, square(size, 1), [=](double, double) { return dvec3(albedo); }};
}

std::vector<ClosedForm> closedForms(uint32_t size)
{
    return {pointLight(size), spotLight(size), directionalLight(size), rectangleLight(size), sky(size)};
}

PictureEstimates ClosedForm::exactly() const
{
    PixelEstimates picture{settings.width, settings.height, {}};
    for (uint32_t y = 0; y < picture.height; ++y)
        for (uint32_t x = 0; x < picture.width; ++x) {
            const dvec3 value = radiance(2 * (x + 0.5) / picture.width - 1, 2 * (y + 0.5) / picture.height - 1);
            const auto estimate = [](double mean) {
                return Estimate{mean, 0, std::numeric_limits<double>::infinity()};
            };
            picture.pixels.push_back({estimate(value.x), estimate(value.y), estimate(value.z)});
        }
    return pictureOf(picture);
}

void PrintTo(const ClosedForm& form, std::ostream* os)
{
    *os << form.name;
}

} // namespace support
