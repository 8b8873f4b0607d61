#pragma once
// The images that materials use.

#include <functional>
#include <vector>

#include "engine/scene/gltf_document.h"
#include "engine/scene/scene.h"

namespace scene::gltf
{

// Decodes the images that `materials` use, on two threads, and points the uses to them. Adds to `files` those that they
// came from. Throws Error.
std::vector<Image> readImages(const Document& document, std::vector<Material>& materials,
                              std::vector<std::filesystem::path>& files, const std::function<void(double)>& progress);

} // namespace scene::gltf
