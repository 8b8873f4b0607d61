#pragma once
// Materials: their JSON is checked while it is read.

#include <string>
#include <vector>

#include "engine/scene/gltf_json.h"
#include "engine/scene/scene.h"
#include "engine/scene/warnings.h"

namespace scene::gltf
{

// All materials of a document, then glTF's default material. TextureUse::image counts images of the file. Throws Error.
std::vector<Material> readMaterials(const Object& document, Warnings& warnings);

bool isMaterialExtension(const std::string& name); // one that readMaterials reads

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

} // namespace scene::gltf
