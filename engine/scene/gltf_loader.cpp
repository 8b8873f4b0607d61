#include "engine/scene/gltf_loader.h"

#include <algorithm>
#include <cmath>

#include "engine/base/error.h"
#include "engine/scene/gltf_document.h"
#include "engine/scene/gltf_geometry.h"
#include "engine/scene/gltf_images.h"
#include "engine/scene/gltf_nodes.h"
#include "engine/scene/instances.h"

namespace scene
{

namespace
{

// Materials that no triangle has cost images and shader features: leave them out. Returns where the others are now.
std::vector<uint32_t> keepUsedMaterials(Scene& scene)
{
    std::vector<uint32_t> newIndex(scene.materials.size(), NONE);
    const std::vector<bool> used = usedMaterials(scene);
    std::vector<Material> kept;
    for (size_t i = 0; i < scene.materials.size(); ++i) {
        if (!used[i]) continue;
        newIndex[i] = static_cast<uint32_t>(kept.size());
        kept.push_back(std::move(scene.materials[i]));
    }
    const auto rename = [&](Geometry& geometry) {
        for (Triangle& triangle : geometry.triangles) triangle.material = newIndex[triangle.material];
    };
    rename(scene);
    std::ranges::for_each(scene.meshes, rename);
    scene.materials = std::move(kept);
    return newIndex;
}

double boundingRadius(const Scene& scene)
{
    float squared = 0;
    for (const Triangle& triangle : scene.triangles) {
        for (const uint32_t v : triangle.vertices)
            squared = std::max(squared, glm::dot(scene.positions[v], scene.positions[v]));
    }
    squared = std::max(squared, static_cast<float>(squaredRadiusOfInstances(scene, boxesOf(scene.meshes))));
    return squared > 0 ? std::sqrt(static_cast<double>(squared)) : 1;
}

void placeCameras(Scene& scene, const std::vector<gltf::WorldCamera>& cameras, double radius, Warnings& warnings)
{
    for (const gltf::WorldCamera& source : cameras) {
        Camera& camera = scene.cameras.emplace_back(source.camera);
        camera.position -= scene.origin;
        aim(camera, radius);
    }
    if (!scene.cameras.empty()) return;

    // From the front (glTF assets face +z), a little above and to the side; the whole sphere fits the narrower side.
    Camera camera;
    camera.name = "default";
    const glm::dvec3 towards = glm::normalize(glm::dvec3(0.35, 0.25, 1));
    camera.position = towards * (radius / std::sin(camera.yfov / 2));
    camera.forward = -towards;
    camera.right = glm::normalize(glm::cross(camera.forward, glm::dvec3(0, 1, 0)));
    camera.up = glm::cross(camera.right, camera.forward);
    camera.target = {0, 0, 0};
    scene.cameras.push_back(camera);
    warnings.add("The file has no camera: placed one in front that sees the whole scene.");
}

void placeLights(Scene& scene, const std::vector<gltf::WorldLight>& lights)
{
    for (const gltf::WorldLight& source : lights)
        scene.lights.emplace_back(source.light).position = glm::vec3(source.position - scene.origin);
}

bool movesEmission(const Motion& motion)
{
    return std::ranges::any_of(motion.animations, [](const Animation& animation) {
        return std::ranges::any_of(animation.channels, [](const Channel& channel) {
            return channel.property == Property::EmissiveFactor || channel.property == Property::EmissiveStrength;
        });
    });
}

void addSkyWhenDark(Scene& scene, Warnings& warnings)
{
    const bool shines = std::any_of(scene.materials.begin(), scene.materials.end(), [](const Material& material) {
        return material.unlit || material.emission != glm::vec3(0);
    });
    if (!scene.lights.empty() || shines || (scene.motion && movesEmission(*scene.motion))) return;
    scene.environment = {.width = 1, .height = 1, .radiance = {glm::vec3(1)}};
    warnings.add("The file has no light: added a uniform sky of radiance 1.");
}

Scene load(const std::filesystem::path& file, const LoadOptions& options)
{
    const auto report = [&](const char* what) {
        return [&options, what](double fraction) {
            if (options.progress) options.progress(what, fraction);
        };
    };
    Warnings warnings;
    report("Reading")(0);
    gltf::Document document = gltf::openDocument(file, options.assetRoot, options.animations, warnings);
    const gltf::NodeTree tree = gltf::resolveNodes(document, warnings);
    Scene scene;
    scene.name = file.stem().string();
    scene.materials = std::move(document.materials);
    gltf::MotionPlan plan =
        gltf::readGeometry(document, tree, scene, options.instancing, warnings, report("Building geometry"));
    const std::vector<uint32_t> materialOf = keepUsedMaterials(scene);
    scene.files = document.files;
    scene.images = gltf::readImages(document, scene.materials, scene.files, report("Decoding images"));
    const std::vector<gltf::WorldCamera> cameras = gltf::readCameras(document, tree, warnings);
    const double radius = boundingRadius(scene);
    placeCameras(scene, cameras, radius, warnings);
    const std::vector<gltf::WorldLight> lights = gltf::readLights(document, tree, warnings);
    placeLights(scene, lights);
    if (plan.motion) {
        plan.motion->radius = radius;
        gltf::completeMotion(plan, document, cameras, lights, materialOf, scene);
        pose(scene, {}, 0); // hides what is not visible or has no area
    }
    if (options.sky) addSkyWhenDark(scene, warnings);
    if (scene.triangles.empty() && scene.instances.empty()) warnings.add("The scene has no triangle.");
    scene.warnings = warnings.sentences();
    return scene;
}

} // namespace

Scene loadGltf(const std::filesystem::path& file, const LoadOptions& options)
{
    try {
        return load(file, options);
    } catch (const Error& error) {
        throw Error("Cannot load \"{}\": {}", file.string(), error.what());
    }
}

} // namespace scene
