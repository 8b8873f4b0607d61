#include "tests/support/test_scenes.h"

#include "tests/support/scale_scenes.h"

#include <functional>
#include <random>

#include <glm/gtc/matrix_transform.hpp>

#include "engine/scene/shapes.h"
#include "tests/support/noise_images.h"
#include "tests/support/stored_meshes.h"

namespace support
{

namespace
{

using glm::vec2, glm::vec3, glm::vec4;
using scene::Material, scene::Scene, scene::TextureUse, scene::Wrap;

constexpr vec4 COPPER = {0.9f, 0.6f, 0.3f, 1};

scene::Environment paleSky()
{
    return {4,
            2,
            {{0.9f, 0.5f, 0.3f},
             {0.3f, 0.8f, 0.4f},
             {0.4f, 0.5f, 1.0f},
             {0.7f, 0.7f, 0.2f},
             {0.2f, 0.3f, 0.2f},
             {0.4f, 0.2f, 0.1f},
             {0.1f, 0.2f, 0.4f},
             {0.3f, 0.3f, 0.3f}}};
}

void addFloor(Scene& scene)
{
    scene::addQuad(scene, scene::addMaterial(scene, scene::diffuse("floor", {0.6f, 0.5f, 0.4f})), {-2, 0, 2}, {4, 0, 0},
                   {0, 0, -4});
}

void addLamp(Scene& scene, vec3 radiance)
{
    scene::addQuad(scene, scene::addMaterial(scene, scene::emitter("lamp", radiance)), {-0.6f, 2.8f, -0.4f},
                   {1.2f, 0, 0}, {0, 0, 1}); // front down
}

void addCamera(Scene& scene)
{
    scene.cameras.push_back(scene::lookAt("camera", {0.3, 1.7, 3.4}, {0, 0.8, 0}, 45));
}

Scene floorUnderSky()
{
    Scene scene;
    addFloor(scene);
    scene.environment = paleSky();
    addCamera(scene);
    return scene;
}

// A white wall that faces the camera, for pictures of textures; (0, 0) to (1, 1) of uv0 is its left upper part.
Scene wallOf(const Material& material)
{
    Scene scene = floorUnderSky();
    scene::addQuad(scene, scene::addMaterial(scene, material), {-1.3f, 0.1f, -0.3f}, {2.6f, 0.2f, 0}, {0, 2, -0.3f});
    return scene;
}

// Vertex data from positions: `uv1` differs from `uv0`, tangents go along +x, across the normals.
void addAttributes(Scene& scene)
{
    for (size_t i = 0; i < scene.positions.size(); ++i) {
        const vec3 p = scene.positions[i], n = scene.normals[i];
        scene.uv0.push_back(vec2(p.x + 1, 1.6f - p.y) * 0.8f);
        scene.uv1.push_back(vec2(p.y - 0.3f, p.x + 0.2f) * 0.9f);
        const vec3 across = glm::normalize(vec3(1, 0, 0) - n.x * n);
        scene.tangents.push_back(vec4(across, i % 8 < 4 ? 1 : -1));
    }
}

void addColors(Scene& scene)
{
    for (size_t i = 0; i < scene.positions.size(); ++i) {
        const auto level = [&](size_t step) { return 0.3f + 0.7f * static_cast<float>(i * step % 7) / 6; };
        scene.colors.push_back({level(1), level(3), level(5), 1});
    }
}

Scene lambert()
{
    return ballOf(scene::diffuse("ball", {0.8f, 0.5f, 0.3f}));
}
Scene roughMetal()
{
    return ballOf({.baseColor = COPPER, .metallic = 1, .roughness = 0.7f});
}
Scene smoothMetal()
{
    return ballOf({.baseColor = COPPER, .metallic = 1, .roughness = 0.3f});
}
Scene mirror()
{
    return ballOf({.baseColor = COPPER, .metallic = 1, .roughness = 0});
}
Scene glossy()
{
    return ballOf({.baseColor = COPPER, .metallic = 0, .roughness = 0.5f});
}
Scene polished()
{
    return ballOf({.baseColor = COPPER,
                   .metallic = 0,
                   .roughness = 0.01f,
                   .ior = 2.2f,
                   .specular = 0.8f,
                   .specularColor = {1, 0.5f, 0.8f}});
}
Scene halfMetal()
{
    return ballOf({.baseColor = COPPER, .metallic = 0.5f, .roughness = 0.6f, .ior = 1.9f, .specular = 0.6f});
}

// Panes that stand before the floor, one leaning.
Scene panes(const Material& material)
{
    Scene scene = floorUnderSky();
    addLamp(scene, {4, 4, 4});
    const uint32_t pane = scene::addMaterial(scene, material);
    scene::addQuad(scene, pane, {-1, 0.1f, 0.5f}, {1.1f, 0, 0.2f}, {0, 1.4f, 0});
    scene::addQuad(scene, pane, {0.1f, 0.1f, -0.4f}, {1, 0, 0}, {0, 1.2f, -0.6f});
    return scene;
}
Scene clearPane()
{
    return panes({.baseColor = COPPER, .metallic = 0, .roughness = 0, .transmission = 0.8f});
}
Scene frostedPane()
{
    return panes({.baseColor = COPPER, .metallic = 0.2f, .roughness = 0.5f, .specular = 0.9f, .transmission = 0.7f});
}
Scene clearGlass()
{
    Scene scene = floorUnderSky();
    const uint32_t glass = scene::addMaterial(
        scene, {.baseColor = {0.9f, 0.95f, 0.7f, 1}, .metallic = 0, .roughness = 0, .transmission = 1, .thin = false});
    const glm::mat4 place = glm::rotate(glm::translate(glm::mat4(1), {0, 0.75f, 0}), 0.5f, {0, 1, 0});
    scene::addBox(scene, glass, glm::scale(place, vec3(0.6f)));
    return scene;
}
Scene clearGlassBall() // shading normals that differ from the facets'
{
    return ballOf(
        {.baseColor = COPPER, .metallic = 0, .roughness = 0, .ior = 1.3f, .transmission = 0.9f, .thin = false});
}
Scene frostedGlass()
{
    return ballOf({.baseColor = COPPER, .metallic = 0, .roughness = 0.6f, .transmission = 0.9f, .thin = false});
}

Scene texturesOf(Scene scene, uint32_t wallImage, uint32_t floorImage)
{
    Material& wall = scene.materials.back();
    wall.baseColorTexture = {.image = wallImage, .wrapU = Wrap::Mirror, .wrapV = Wrap::Clamp};
    wall.baseColorTexture.row0 = {1.2f, 0.4f, -0.1f};
    wall.baseColorTexture.row1 = {-0.3f, 1.4f, 0.2f};
    scene.materials[0].baseColorTexture = {.image = floorImage, .uvSet = 1, .nearest = true};
    addAttributes(scene);
    return scene;
}
Scene textures()
{
    Scene scene = wallOf({.metallic = 0, .specular = 0});
    const uint32_t image = addNoise(scene, 7, 5, 20, 1);
    return texturesOf(std::move(scene), image, image);
}
Scene deepTextures() // beside one of 8 bits
{
    Scene scene = wallOf({.metallic = 0, .specular = 0});
    const uint32_t floor = addNoise(scene, 3, 3, 20, 1);
    const uint32_t wall = addDeepNoise(scene, 7, 5, 20, 2);
    return texturesOf(std::move(scene), wall, floor);
}
Scene metallicRoughnessMap()
{
    Scene scene = wallOf({.baseColor = COPPER});
    scene.materials.back().metallicRoughnessTexture = {.image = addNoise(scene, 4, 4, 60, 2), .uvSet = 1};
    addAttributes(scene);
    return scene;
}
Scene normalMap()
{
    Scene scene = wallOf({.baseColor = COPPER, .metallic = 0, .roughness = 0.5f, .normalScale = 0.8f});
    scene.materials.back().normalTexture = {.image = addBumps(scene)};
    scene.materials[0].normalTexture = {.image = scene.materials.back().normalTexture.image};
    addAttributes(scene);
    return scene;
}
Scene specularMaps()
{
    Scene scene = wallOf({.baseColor = {0.3f, 0.3f, 0.3f, 1}, .metallic = 0, .roughness = 0.4f, .ior = 2.5f});
    const uint32_t image = addNoise(scene, 4, 3, 0, 4);
    scene.materials.back().specularTexture = {.image = image};
    scene.materials.back().specularColorTexture = {.image = image, .wrapU = Wrap::Clamp};
    addAttributes(scene);
    return scene;
}
Scene transmissionMap()
{
    Scene scene = wallOf({.baseColor = COPPER, .metallic = 0, .roughness = 0.5f, .transmission = 1});
    scene.materials.back().transmissionTexture = {.image = addNoise(scene, 3, 3, 0, 5)};
    addAttributes(scene);
    return scene;
}
Scene vertexColors()
{
    Scene scene = ballOf({.baseColor = COPPER, .metallic = 0.3f, .roughness = 0.6f});
    addColors(scene);
    return scene;
}
Scene alphaMask()
{
    Scene scene = wallOf({.metallic = 0, .alpha = scene::Alpha::Mask, .alphaCutoff = 0.55f});
    addLamp(scene, {5, 5, 5});
    scene.materials[1].baseColorTexture = {.image = addNoise(scene, 8, 8, 0, 6), .nearest = true};
    Material& lamp = scene.materials.back();
    lamp.alpha = scene::Alpha::Mask;
    lamp.baseColorTexture = {.image = 0};
    addAttributes(scene);
    return scene;
}
Scene alphaBlend()
{
    Scene scene = wallOf({.baseColor = {0.7f, 0.5f, 0.9f, 0.7f}, .metallic = 0, .alpha = scene::Alpha::Blend});
    addLamp(scene, {8, 6, 5});
    scene.materials.back().alpha = scene::Alpha::Blend;
    scene.materials.back().baseColor.a = 0.4f;
    scene::addQuad(scene, 1, {-0.8f, 1, 0.2f}, {1, 0, 0}, {0, 0, 1});
    scene.materials[1].baseColorTexture = {.image = addNoise(scene, 4, 4, 0, 7)};
    addAttributes(scene);
    return scene;
}
// A ball with normal map and vertex colors in four places: as it was, flattened, mirrored, and both.
Scene copies()
{
    Scene scene = ballOf({.baseColor = COPPER, .metallic = 0.3f, .roughness = 0.4f, .normalScale = 0.6f});
    scene.materials[1].normalTexture = {.image = addBumps(scene)};
    addAttributes(scene);
    for (glm::vec4& tangent : scene.tangents) tangent.w = -1; // seams are split: each triangle has one handedness
    addColors(scene);
    const auto place = [](glm::dvec3 to, double angle, glm::dvec3 scale) {
        const glm::dmat4 turned = glm::rotate(glm::translate(glm::dmat4(1), to), angle, glm::dvec3(0.3, 1, 0.2));
        return glm::scale(turned, scale);
    };
    return storedOnce(std::move(scene), 1,
                      {place({-0.6, 0, -0.7}, 0, {0.9, 0.9, 0.9}), place({0.8, 0, -0.4}, 0.7, {0.7, 0.4, 0.9}),
                       place({0.1, 0.05, 0.9}, 2, {-0.4, 0.4, 0.4}), place({-0.9, 0.1, 0.6}, -1, {0.3, 0.5, -0.4})});
}
// A wall with holes, twice.
Scene maskedCopies()
{
    const glm::dmat4 left = glm::translate(glm::dmat4(1), {-0.4, 0, 0.2});
    const glm::dmat4 right = glm::rotate(glm::translate(glm::dmat4(1), {0.5, 0, 0.5}), 0.9, glm::dvec3(0, 1, 0));
    return storedOnce(alphaMask(), 1, {glm::scale(left, {-0.7, 0.8, 1}), glm::scale(right, glm::dvec3(0.6))});
}
// Closed bodies that touch the floor and each other.
Scene glassCopies()
{
    const glm::dmat4 left = glm::translate(glm::dmat4(1), {-0.6, -0.15, 0});
    const glm::dmat4 right = glm::rotate(glm::translate(glm::dmat4(1), {0.7, 0, 0.3}), 0.4, glm::dvec3(0, 1, 0));
    return storedOnce(clearGlass(), 1, {left, glm::scale(right, {-0.8, 1.2, 0.8})});
}
Scene unlit()
{
    Scene scene = ballOf({.baseColor = COPPER, .unlit = true});
    addColors(scene);
    return scene;
}

Scene lightOnly(const scene::PunctualLight& light)
{
    Scene scene = ballOf({.baseColor = COPPER, .metallic = 0, .roughness = 0.5f});
    for (Material& m : scene.materials) m.emission = vec3(0);
    scene.environment = {};
    scene.lights.push_back(light);
    return scene;
}
Scene pointLight()
{
    return lightOnly({.intensity = {8, 5, 3}, .position = {0.8f, 2.1f, 1.2f}});
}
Scene spotLight()
{
    return lightOnly({.kind = scene::LightKind::Spot,
                      .intensity = {30, 40, 20},
                      .position = {1, 2.6f, 1.5f},
                      .direction = glm::normalize(vec3(-1, -2, -1.3f)),
                      .innerConeAngle = 0.1f,
                      .outerConeAngle = 0.6f});
}
Scene directionalLight()
{
    return lightOnly({.kind = scene::LightKind::Directional,
                      .intensity = {1, 2, 3},
                      .direction = glm::normalize(vec3(-0.5f, -1, -0.3f))});
}
Scene severalLights()
{
    Scene scene = pointLight();
    for (const Scene& other : {spotLight(), directionalLight()}) scene.lights.push_back(other.lights[0]);
    scene.environment = paleSky();
    scene.materials.back().emission = {3, 0, 3};
    return scene;
}
Scene twoSidedLamp() // with a texture, seen from both sides, beside a floor and a ceiling
{
    Scene scene;
    addFloor(scene);
    addCamera(scene);
    addLamp(scene, {3, 3, 3});
    scene.materials.back().doubleSided = true;
    scene.materials.back().emissiveTexture = {.image = addNoise(scene, 3, 3, 0, 8)};
    for (vec3& p : scene.positions)
        if (p.y > 2) p = {p.x, 1 + 0.3f * p.x, p.z};
    scene::addQuad(scene, 0, {-2, 2.2f, -2}, {4, 0, 0}, {0, 0, 4});
    addAttributes(scene);
    return scene;
}
Scene manyLamps() // of very different strength
{
    Scene scene = ballOf({.baseColor = COPPER, .metallic = 0, .roughness = 0.4f});
    scene.environment = {};
    for (int i = 0; i < 8; ++i) {
        const vec3 hue(i % 2, i % 3 == 0, i % 4 == 1);
        const auto x = static_cast<float>(i) * 0.45f - 1.7f;
        scene::addQuad(scene, scene::addMaterial(scene, scene::emitter("spark", std::pow(3.0f, float(i % 5)) * hue)),
                       {x, 0.2f, 1 - 0.1f * x}, {0.1f, 0, 0}, {0, 0.05f * float(i + 1), 0});
    }
    return scene;
}
Scene sunnySky()
{
    Scene scene = ballOf({.baseColor = COPPER, .metallic = 0, .roughness = 0.4f});
    scene.materials.back().emission = vec3(0);
    scene.environment = {32, 16, std::vector<vec3>(512, vec3(0.2f, 0.3f, 0.5f))};
    scene.environment.radiance[4 * 32 + 5] = {90, 80, 60};
    scene.environment.radiance[9 * 32 + 20] = {0, 9, 0};
    return scene;
}
Scene orthographic()
{
    Scene scene = lambert();
    scene.cameras[0].orthographic = true;
    scene.cameras[0].ymag = 1.3;
    return scene;
}
Scene room() // closed: light scatters until the limit
{
    Scene scene;
    scene::addBox(scene, scene::addMaterial(scene, scene::diffuse("walls", {0.8f, 0.7f, 0.5f})),
                  glm::scale(glm::translate(glm::mat4(1), {0, 1.5f, 0}), {2, 1.5f, 4}));
    scene::addBox(scene, scene::addMaterial(scene, {.baseColor = COPPER, .metallic = 1, .roughness = 0.4f}),
                  {-0.6f, 0, -0.6f}, {0.6f, 1.1f, 0.6f});
    addLamp(scene, {10, 10, 10});
    addCamera(scene);
    return scene;
}

} // namespace

Scene ballOf(const Material& material)
{
    Scene scene = floorUnderSky();
    scene::addSphere(scene, scene::addMaterial(scene, material), {0, 0.9f, 0}, 0.85f, 0);
    addLamp(scene, {6, 5, 4});
    return scene;
}

Scene cabinet()
{
    Scene scene = ballOf({.baseColor = COPPER, .metallic = 0, .roughness = 0.5f});
    const auto quad = [&](const Material& material, vec3 corner, vec3 u, vec3 v) {
        scene::addQuad(scene, scene::addMaterial(scene, material), corner, u, v);
    };
    quad(scene::diffuse("back", {0.4f, 0.6f, 0.7f}), {-2, 0, -1.4f}, {4, 0, 0}, {0, 2.6f, 0});
    quad({.baseColor = COPPER, .metallic = 1, .roughness = 0.3f}, {-1.6f, 0, 1}, {0.3f, 0, -2}, {0, 1.6f, 0});
    quad({.baseColor = {0.3f, 0.8f, 0.5f, 1}, .metallic = 0, .roughness = 0.1f, .ior = 2}, {1.3f, 0, -1}, {0.3f, 0, 2},
         {0, 1.2f, 0.1f});
    quad({.baseColor = {0.9f, 0.9f, 0.9f, 1}, .metallic = 1, .roughness = 0}, {0.9f, 0.01f, 1.2f}, {0.7f, 0, 0},
         {0, 0.5f, -0.5f});
    quad({.baseColor = COPPER, .metallic = 0.2f, .roughness = 0.5f, .specular = 0.9f, .transmission = 0.7f},
         {-1.1f, 0.05f, 1.1f}, {0.9f, 0, 0.2f}, {0, 1, -0.1f});
    scene::addSphere(scene,
                     scene::addMaterial(scene, {.baseColor = {0.9f, 0.95f, 0.7f, 1},
                                                .metallic = 0,
                                                .roughness = 0.6f,
                                                .transmission = 0.9f,
                                                .thin = false}),
                     {0.55f, 0.45f, 1}, 0.4f, 1);
    scene.lights = pointLight().lights;
    return scene;
}

// Three translucent panes behind each other, near enough to each other for reuse to take one for the other.
Scene panes()
{
    Scene scene = wallOf(scene::diffuse("wall", {0.9f, 0.6f, 0.3f}));
    const vec3 colors[] = {{0.9f, 0.1f, 0.1f}, {0.1f, 0.8f, 0.2f}, {0.2f, 0.2f, 0.9f}};
    for (int i = 0; i < 3; ++i) {
        Material pane = scene::diffuse("pane", colors[i]);
        pane.baseColor.a = 1.0f / 3;
        pane.alpha = scene::Alpha::Blend;
        pane.doubleSided = true;
        scene::addQuad(scene, scene::addMaterial(scene, pane), {-1.3f, 0.1f, 0.03f * float(i + 1)}, {2.6f, 0.1f, 0},
                       {0, 2, -0.1f});
    }
    return scene;
}

passes::Settings TestScene::settings() const
{
    passes::Settings result;
    result.width = result.height = 32;
    result.maxBounces = maxBounces;
    result.pixelFilter = filter;
    return result;
}

std::vector<TestScene> testScenes()
{
    return {
        {"Lambert", lambert},
        {"RoughMetal", roughMetal},
        {"SmoothMetal", smoothMetal},
        {"Mirror", mirror},
        {"Glossy", glossy},
        {"Polished", polished},
        {"HalfMetal", halfMetal},
        {"ClearPane", clearPane, 4},
        {"FrostedPane", frostedPane, 4},
        {"ClearGlass", clearGlass, 5},
        {"ClearGlassBall", clearGlassBall, 5},
        {"FrostedGlass", frostedGlass, 5},
        {"Textures", textures, 2},
        {"DeepTextures", deepTextures, 2},
        {"MetallicRoughnessMap", metallicRoughnessMap, 2},
        {"NormalMap", normalMap, 2},
        {"SpecularMaps", specularMaps, 2},
        {"TransmissionMap", transmissionMap, 2},
        {"VertexColors", vertexColors, 2},
        {"AlphaMask", alphaMask, 2},
        {"AlphaBlend", alphaBlend, 2},
        {"Panes", panes, 2},
        {"FarTriangle", farTriangle},
        {"Dome", dome, 4},
        {"WideGround", wideGround},
        {"Copies", copies, 2},
        {"MaskedCopies", maskedCopies, 2},
        {"GlassCopies", glassCopies, 3},
        {"Unlit", unlit, 2},
        {"PointLight", pointLight, 2},
        {"SpotLight", spotLight, 2},
        {"DirectionalLight", directionalLight, 2},
        {"SeveralLights", severalLights, 2},
        {"TwoSidedLamp", twoSidedLamp},
        {"ManyLamps", manyLamps, 1},
        {"SunnySky", sunnySky, 2},
        {"Orthographic", orthographic, 2, passes::PixelFilter::Box},
        {"Room", room, 8},
        {"SeenDirectly", sunnySky, 0, passes::PixelFilter::Box},
    };
}

void PrintTo(const TestScene& scene, std::ostream* os)
{
    *os << scene.name;
}

} // namespace support
