#include "tests/bench/extreme_cases.h"

#include <cmath>
#include <numbers>
#include <random>

#include <fmt/format.h>

#include "engine/scene/procedural.h"
#include "engine/scene/shapes.h"
#include "tests/support/closed_forms.h"
#include "tests/support/reference_tracer.h"
#include "tests/support/scale_scenes.h"
#include "tests/support/test_scenes.h"

namespace bench
{

namespace
{

using glm::vec3, glm::dvec3;
using scene::Scene;

constexpr uint32_t SIZE = 16; // pixels, each side: four tiles
constexpr uint32_t RUNS = 50, FRAMES = 5;
constexpr uint64_t REFERENCE_SAMPLES = 1500, REFERENCE_SEED = 77; // per pixel

passes::Settings settingsOf(uint32_t maxBounces)
{
    passes::Settings settings;
    settings.width = settings.height = SIZE;
    settings.maxBounces = maxBounces;
    settings.frames = FRAMES;
    settings.average = false;
    settings.spatialRadius = 4;
    return settings;
}

auto referenceWith(uint64_t samples)
{
    return [samples](const Scene& scene, const passes::Settings& settings) {
        return support::pictureOf(support::reference(scene, settings, samples, REFERENCE_SEED));
    };
}

ExtremeCase sampled(const std::string& name, const std::string& stresses, const Scene& scene, uint32_t maxBounces = 3)
{
    return {name, stresses, scene, settingsOf(maxBounces), referenceWith(REFERENCE_SAMPLES), 2, RUNS};
}

ExtremeCase known(const std::string& name, const std::string& stresses, const support::ClosedForm& form)
{
    return {name,
            stresses,
            form.scene,
            settingsOf(form.settings.maxBounces),
            [form](const Scene&, const passes::Settings&) { return form.exactly(); },
            0,
            RUNS};
}

Scene glossyBall()
{
    return support::ballOf({.baseColor = {0.9f, 0.6f, 0.4f, 1}, .metallic = 0, .roughness = 0.5f});
}

// A lamp besides those of the ball's scene.
Scene withLamp(const vec3& radiance, const vec3& corner, const vec3& edge0, const vec3& edge1)
{
    Scene scene = glossyBall();
    scene::addQuad(scene, scene::addMaterial(scene, scene::emitter("extreme", radiance)), corner, edge0, edge1);
    return scene;
}

Scene dimmed(Scene scene, const vec3& factor)
{
    for (scene::Material& material : scene.materials) material.emission *= factor;
    for (vec3& radiance : scene.environment.radiance) radiance *= factor;
    return scene;
}

Scene scaled(Scene scene, float factor)
{
    for (vec3& position : scene.positions) position *= factor;
    for (scene::Camera& camera : scene.cameras) {
        camera.position *= double(factor);
        camera.target *= double(factor);
    }
    return scene;
}

// Everything in the picture is lit by a dim sky, but for one lamp that faces the camera and nothing else.
Scene wideRange()
{
    Scene scene = dimmed(glossyBall(), vec3(1e-2f));
    scene::addQuad(scene, scene::addMaterial(scene, scene::emitter("bright", vec3(1e6f))), {0.2f, 1.2f, 2.05f},
                   {0.3f, 0, 0}, {0, 0.3f, 0});
    return scene;
}

Scene nestedGlass()
{
    const auto glass = [](float ior) {
        return scene::Material{.baseColor = {0.95f, 0.9f, 0.97f, 1},
                               .metallic = 0,
                               .roughness = 0,
                               .ior = ior,
                               .transmission = 1,
                               .thin = false};
    };
    Scene scene = support::ballOf(glass(1.5f));
    for (const auto& [radius, ior] : {std::pair(0.65f, 1.1f), {0.45f, 1.8f}, {0.25f, 1.3f}})
        scene::addSphere(scene, scene::addMaterial(scene, glass(ior)), {0, 0.9f, 0}, radius, 0);
    return scene;
}

// All walls scatter all but 1e-4 of the light and emit 1e-4: L = 1 - albedo^(D + 1) everywhere.
support::ClosedForm whiteBox(uint32_t maxBounces)
{
    support::ClosedForm form;
    scene::Material wall = scene::diffuse("wall", vec3(1 - 1e-4f));
    wall.emission = vec3(1e-4f);
    wall.doubleSided = true; // the box is seen from inside
    scene::addBox(form.scene, scene::addMaterial(form.scene, wall), vec3(-1), vec3(1));
    form.scene.cameras.push_back(scene::lookAt("inside", {0.2, 0.1, 0.3}, {-0.4, -0.2, -0.5}, 60));
    form.settings = settingsOf(maxBounces);
    form.settings.width = form.settings.height = 8;
    const double albedo = double(wall.baseColor.r);
    const double radiance = double(wall.emission.r) * (1 - std::pow(albedo, maxBounces + 1.0)) / (1 - albedo);
    form.radiance = [radiance](double, double) { return dvec3(radiance); };
    return form;
}

Scene farCamera(double distance) // in sizes of the scene, the same field of it
{
    Scene scene = glossyBall();
    scene::Camera& camera = scene.cameras[0];
    const dvec3 target(0, 0.8, 0), direction = glm::normalize(camera.position - target);
    const double near = glm::length(camera.position - target), far = 4 * distance;
    const double field = 2 * std::atan(std::tan(camera.yfov / 2) * near / far);
    camera = scene::lookAt("far", target + far * direction, target, glm::degrees(field));
    return scene;
}

Scene brokenTriangles()
{
    Scene scene = glossyBall();
    const size_t count = scene.triangles.size();
    for (size_t i = 0; i < count; ++i) { // each once more, and once without area
        const scene::Triangle whole = scene.triangles[i];
        if (scene.materials[whole.material].emission != vec3(0)) continue;
        scene.triangles.push_back(whole);
        scene.triangles.push_back({{whole.vertices[0], whole.vertices[1], whole.vertices[0]}, whole.material});
    }
    const uint32_t needle = scene::addMaterial(scene, scene::diffuse("needle", {0.2f, 0.9f, 0.3f}));
    for (int i = 0; i < 16; ++i) { // 4 long, 1e-5 to 0.3 wide, just over the floor
        const float width = 1e-5f * std::pow(10.0f, 0.28f * float(i));
        scene::addQuad(scene, needle, {-2, 1e-3f, 1.9f - 0.2f * float(i)}, {4, 0, 0}, {0, 0, -width});
    }
    return scene;
}

Scene coplanar() // two floors of one material in one plane, overlapping in part
{
    Scene scene = glossyBall();
    scene::addQuad(scene, 0, {-1, 0, 1.5f}, {2.5f, 0, 0}, {0, 0, -2});
    return scene;
}

// Two planes that meet at 5 degrees: neighboring vertices of a path come as near to each other as numbers allow.
Scene wedge()
{
    Scene scene;
    const uint32_t white = scene::addMaterial(scene, scene::diffuse("white", {0.9f, 0.8f, 0.7f}));
    scene::addQuad(scene, white, {-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
    scene::addQuad(scene, white, {-2, 0, -2}, {4, 0, 0}, {0, 4 * std::sin(0.087f), 4 * std::cos(0.087f)}); // front down
    scene.environment = {2, 2, {{1, 0.5f, 0.2f}, {0.2f, 0.5f, 1}, {0.5f, 1, 0.5f}, {1, 1, 1}}};
    scene.cameras.push_back(scene::lookAt("camera", {0.3, 0.3, 3.4}, {0, 0.05, -1}, 20));
    return scene;
}

support::ClosedForm manyPoints(uint32_t count)
{
    support::ClosedForm form{.name = "ManyPoints", .scene = support::floorFromAbove(), .settings = settingsOf(1)};
    std::mt19937 random(5);
    const auto uniform = [&] { return float(random() >> 8) / float(1 << 24); };
    for (uint32_t i = 0; i < count; ++i) {
        const vec3 hue(uniform(), uniform(), uniform());
        const float strength = std::pow(10.0f, -3 * uniform()) / float(count); // over three decades
        form.scene.lights.push_back({.intensity = 10 * strength * hue,
                                     .position = {2 * uniform() - 1, 0.5f + 0.5f * uniform(), 2 * uniform() - 1}});
    }
    form.radiance = [lights = form.scene.lights](double x, double y) {
        dvec3 sum(0);
        for (const scene::PunctualLight& light : lights) {
            const dvec3 to = dvec3(light.position) - dvec3(x, 0, y);
            const double r = glm::length(to);
            sum += dvec3(light.intensity) * to.y / (r * r * r);
        }
        return dvec3(support::FLOOR_ALBEDO) / std::numbers::pi * sum;
    };
    return form;
}

support::ClosedForm grazingSun(float cosine)
{
    support::ClosedForm form{.name = "GrazingSun", .scene = support::floorFromAbove(), .settings = settingsOf(1)};
    const vec3 direction = glm::normalize(vec3(1, -cosine, 0));
    form.scene.lights.push_back(
        {.kind = scene::LightKind::Directional, .intensity = {1, 2, 3}, .direction = direction});
    form.radiance = [=](double, double) {
        return dvec3(support::FLOOR_ALBEDO) / std::numbers::pi * -double(direction.y) * dvec3(1, 2, 3);
    };
    return form;
}

void addMaterials(std::vector<ExtremeCase>& cases)
{
    for (const float roughness : {0.0f, 1e-4f, 1e-3f, 0.01f, 0.0157f, 0.1f, 1.0f}) {
        const scene::Material metal = {.baseColor = {0.9f, 0.6f, 0.4f, 1}, .metallic = 1, .roughness = roughness};
        cases.push_back(
            sampled(fmt::format("roughness {:g}", roughness), "GGX from a mirror to matt", support::ballOf(metal)));
    }
    cases.push_back(sampled("nested glass, 32 bounces", "long chains of Dirac events", nestedGlass(), 32));
    ExtremeCase box =
        known("box of albedo 0.9999, 256 bounces", "mean path length 10^4, cut: 1 - albedo^257", whiteBox(256));
    box.settings.width = box.settings.height = 8;
    box.settings.frames = 3;
    box.runs = 120;
    cases.push_back(box);
    for (const double cosine : {1e-2, 1e-4, 1e-6})
        cases.push_back(known(fmt::format("seen at cosine {:g}", cosine), "GGX masking at grazing angles",
                              support::ggxUnderWhiteSky(SIZE, 0.5f, cosine)));
}

void addLights(std::vector<ExtremeCase>& cases)
{
    for (const float scale : {1e-20f, 1e-6f, 1.0f, 1e6f, 1e20f}) {
        cases.push_back(sampled(fmt::format("radiance times {:g}", scale), "exponents of weights and of their products",
                                dimmed(glossyBall(), vec3(scale))));
        cases.back().quick = scale == 1e20f;
    }
    cases.push_back(sampled("1e8 inside one picture", "a lamp of 1e6 over surfaces of 1e-2", wideRange()));
    cases.push_back(sampled("red light only", "targets that are 0 in two channels", dimmed(glossyBall(), {1, 0, 0})));
    cases.back().runs = 200;
    cases.push_back(sampled("blue lamp of 1000", "channels far apart",
                            withLamp({0, 0, 1e3f}, {1.5f, 0.2f, 0.5f}, {0.1f, 0, 0}, {0, 0.1f, 0})));
    cases.push_back(sampled("no light", "no weight at all", dimmed(glossyBall(), vec3(0))));
    cases.push_back(sampled("emitter 1e-4 wide", "tiny densities of scattering into light",
                            withLamp(vec3(1e4f), {1.5f, 0.2f, 0.5f}, {1e-4f, 0, 0}, {0, 1, 0})));
    cases.push_back(sampled("emitter standing on the floor", "light distances down to 0",
                            withLamp(vec3(10), {0.9f, 0, 0.9f}, {0.6f, 0, 0}, {0, 0.3f, 0})));
    cases.push_back(known("10^5 point lights", "light tables; powers over three decades", manyPoints(100000)));
    cases.push_back(
        known("10^5 emissive triangles", "light tables; tiny areas", support::rectangleLight(SIZE, 250, 200)));
    for (const float cosine : {1e-2f, 1e-4f, 1e-6f})
        cases.push_back(known(fmt::format("sun at cosine {:g}", cosine), "grazing light", grazingSun(cosine)));
}

void addGeometry(std::vector<ExtremeCase>& cases)
{
    for (const float scale : {1e-4f, 1e6f}) {
        cases.push_back(sampled(fmt::format("scene times {:g}", scale), "lengths, areas and densities",
                                scaled(glossyBall(), scale)));
    }
    cases.push_back(
        sampled("a triangle 40 km away", "lengths of a ten thousandth of the scene", support::farTriangle()));
    cases.push_back(
        sampled("a pane and a sheet under a dome of 10 km", "surfaces millimeters apart", support::dome(), 4));
    cases.push_back(sampled("a pane on a ground of 40 km", "points known to millimeters", support::wideGround(), 4));
    cases.push_back(sampled("camera 10^4 sizes away", "cancellation on the camera's rays", farCamera(1e4)));
    cases.push_back(sampled("degenerate, duplicate and needle triangles", "normals and areas of 0; equal distances",
                            brokenTriangles()));
    cases.push_back(sampled("coplanar surfaces", "equal distances", coplanar()));
    for (const passes::Shift shift : {passes::Shift::Reconnection, passes::Shift::Hybrid}) {
        cases.push_back(sampled(shift == passes::Shift::Hybrid ? "wedge, hybrid shift" : "wedge, reconnection shift",
                                "reconnection distances to 0, grazing Jacobians", wedge(), 4));
        cases.back().settings.shift = shift;
    }
}

void addHistories(std::vector<ExtremeCase>& cases)
{
    for (const uint32_t maxConfidence : {1u, 1u << 15, 1u << 16, 1u << 20}) {
        ExtremeCase c =
            sampled(fmt::format("M_c = {}", maxConfidence), "confidences; the complement in merges", glossyBall());
        c.settings.maxConfidence = maxConfidence;
        c.settings.frames = 20;
        c.runs = 72;
        cases.push_back(c);
    }
    for (const auto& [width, height, runs] :
         {std::tuple(1u, 1u, 400u), std::tuple(1u, 4096u, 20u), std::tuple(17u, 13u, RUNS)}) {
        ExtremeCase c =
            sampled(fmt::format("{}x{} pixels", width, height), "sizes that fill no workgroup", glossyBall());
        c.settings.width = width;
        c.settings.height = height;
        c.runs = runs;
        if (width * height == 1) c.truth = referenceWith(100 * REFERENCE_SAMPLES);
        if (height == 4096) c.truth = referenceWith(1000);
        cases.push_back(c);
    }
    // The film's sum of all frames, of reservoirs that stand for all of them.
    ExtremeCase film =
        known("10^6 frames accumulated", "the film's sum; M_c = 2^20 at rest", support::rectangleLight(8));
    film.settings.width = film.settings.height = 8;
    film.settings.maxConfidence = 1u << 20;
    film.settings.spatial = 0;
    film.settings.frames = 1000000;
    film.settings.average = true;
    film.runs = 2; // half an hour for each method
    cases.push_back(film);
}

} // namespace

std::vector<ExtremeCase> extremeCases()
{
    std::vector<ExtremeCase> cases;
    addMaterials(cases);
    addLights(cases);
    addGeometry(cases);
    addHistories(cases);
    return cases;
}

} // namespace bench
