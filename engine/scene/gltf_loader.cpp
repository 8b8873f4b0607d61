#include "engine/scene/gltf_loader.h"

#include <algorithm>
#include <cmath>

#include "engine/base/error.h"
#include "engine/scene/gltf_document.h"
#include "engine/scene/gltf_geometry.h"
#include "engine/scene/gltf_images.h"
#include "engine/scene/gltf_nodes.h"

namespace scene
{

namespace
{

// Materials that no triangle has cost images and shader features: leave them out.
void keepUsedMaterials(Scene& scene)
{
    std::vector<uint32_t> newIndex(scene.materials.size(), NONE);
    std::vector<Material> used;
    for (const Triangle& triangle : scene.triangles) newIndex[triangle.material] = 0;
    for (size_t i = 0; i < scene.materials.size(); ++i) {
        if (newIndex[i] == NONE) continue;
        newIndex[i] = static_cast<uint32_t>(used.size());
        used.push_back(std::move(scene.materials[i]));
    }
    for (Triangle& triangle : scene.triangles) triangle.material = newIndex[triangle.material];
    scene.materials = std::move(used);
}

double boundingRadius(const Scene& scene)
{
    float squared = 0;
    for (const Triangle& triangle : scene.triangles) {
        for (const uint32_t v : triangle.vertices)
            squared = std::max(squared, glm::dot(scene.positions[v], scene.positions[v]));
    }
    return squared > 0 ? std::sqrt(static_cast<double>(squared)) : 1;
}

void placeCameras(Scene& scene, Warnings& warnings)
{
    const double radius = boundingRadius(scene);
    for (Camera& camera : scene.cameras) {
        // What lies in front: the point of the view axis nearest to the scene's centre.
        const double ahead = glm::dot(-camera.position, camera.forward);
        camera.target = camera.position + camera.forward * (ahead > 0.01 * radius ? ahead : 0.5 * radius);
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

void addSkyWhenDark(Scene& scene, Warnings& warnings)
{
    const bool shines = std::any_of(scene.materials.begin(), scene.materials.end(), [](const Material& material) {
        return material.unlit || material.emission != glm::vec3(0);
    });
    if (!scene.lights.empty() || shines) return;
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
    gltf::Document document = gltf::openDocument(file, options.assetRoot, warnings);
    const gltf::NodeTree tree = gltf::resolveNodes(document, warnings);
    Scene scene;
    scene.name = file.stem().string();
    scene.materials = std::move(document.materials);
    gltf::readGeometry(document, tree, scene, warnings, report("Building geometry"));
    keepUsedMaterials(scene);
    scene.files = document.files;
    scene.images = gltf::readImages(document, scene.materials, scene.files, report("Decoding images"));
    scene.cameras = gltf::readCameras(document, tree, scene.origin, warnings);
    placeCameras(scene, warnings);
    scene.lights = gltf::readLights(document, tree, scene.origin, warnings);
    if (options.sky) addSkyWhenDark(scene, warnings);
    if (scene.triangles.empty()) warnings.add("The scene has no triangle.");
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
