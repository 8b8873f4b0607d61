#pragma once
// Materials, and the images they use.

#include <functional>
#include <vector>

#include "engine/scene/gltf_document.h"
#include "engine/scene/scene.h"

namespace scene::gltf
{

// All materials of the file, then glTF's default material. TextureUse::image counts images of the file.
std::vector<Material> readMaterials(const Document& document, Warnings& warnings);

// Calls visit(use) for each texture use of a material that has an image.
template <class AnyMaterial, class Visit>
void eachTexture(AnyMaterial& material, Visit&& visit)
{
    for (auto* use : {&material.baseColorTexture, &material.metallicRoughnessTexture, &material.normalTexture,
                      &material.emissiveTexture, &material.transmissionTexture, &material.specularTexture,
                      &material.specularColorTexture}) {
        if (use->image != NONE) visit(*use);
    }
}

// Decodes the images that `materials` use, on two threads, and points the uses to them. Adds to `files` those that they
// came from. Throws Error.
std::vector<Image> readImages(const Document& document, std::vector<Material>& materials,
                              std::vector<std::filesystem::path>& files, const std::function<void(double)>& progress);

} // namespace scene::gltf
