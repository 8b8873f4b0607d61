#include "tests/support/scale_scenes.h"

#include "engine/scene/shapes.h"
#include "tests/support/test_scenes.h"

namespace support
{

namespace
{

using glm::vec3;
using scene::Material, scene::Scene;

const Material GLASS = {.baseColor = {0.8f, 0.95f, 0.9f, 1},
                        .metallic = 0,
                        .roughness = 0.3f,
                        .ior = 1.5f,
                        .transmission = 1,
                        .thin = false};

uint32_t add(Scene& scene, Material material, bool doubleSided = false)
{
    material.doubleSided = doubleSided;
    return scene::addMaterial(scene, material);
}

void addLampAndCamera(Scene& scene)
{
    scene::addQuad(scene, add(scene, scene::emitter("lamp", {9, 8, 7})), {-0.6f, 2.8f, -0.4f}, {1.2f, 0, 0}, {0, 0, 1});
    scene.cameras.push_back(scene::lookAt("camera", {0.3, 1.7, 3.4}, {0, 0.8, 0}, 45));
}

} // namespace

Scene farTriangle()
{
    Scene scene = ballOf(scene::glossy("ball", {0.9f, 0.6f, 0.4f}, 0.5f));
    const auto first = uint32_t(scene.positions.size());
    for (const vec3& corner : {vec3(4e4f, 0, 0), {4e4f, 1, 0}, {4e4f, 0, 1}}) {
        scene.positions.push_back(corner);
        scene.normals.emplace_back(-1, 0, 0);
    }
    scene.triangles.push_back({{first, first + 2, first + 1}, 0});
    return scene;
}

Scene dome()
{
    Scene scene;
    scene::addQuad(scene, add(scene, scene::diffuse("floor", {0.6f, 0.5f, 0.4f})), {-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
    addLampAndCamera(scene);
    scene::addBox(scene, add(scene, GLASS), {-1, 0.4f, 0}, {1, 1.6f, 0.005f});
    scene::addQuad(scene, add(scene, scene::diffuse("sheet", {0.3f, 0.9f, 0.4f}), true), {-0.8f, 0.002f, 1.2f},
                   {1.6f, 0, 0}, {0, 0, -0.9f});
    Material sky = scene::diffuse("sky", {0.3f, 0.4f, 0.6f});
    sky.unlit = true;
    scene::addSphere(scene, add(scene, sky), vec3(0), 1e4f, 1, scene::Normals::Flat, scene::Facing::Inward);
    return scene;
}

Scene wideGround()
{
    Scene scene;
    scene::addQuad(scene, add(scene, scene::diffuse("ground", {0.6f, 0.5f, 0.4f})), {-2e4f, 0, 2e4f}, {4e4f, 0, 0},
                   {0, 0, -4e4f});
    addLampAndCamera(scene);
    scene::addBox(scene, add(scene, GLASS), {-1, 0.3f, 0.2f}, {1, 1.6f, 0.201f});
    scene::addSphere(scene, add(scene, scene::glossy("ball", {0.9f, 0.6f, 0.4f}, 0.5f)), {0.2f, 0.5f, -0.7f}, 0.5f, 1);
    return scene;
}

} // namespace support
