#pragma once
// A glTF file opened: its checked structure as tinygltf types, and the bytes of its buffers.

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "engine/scene/gltf_animations.h"
#include "engine/scene/gltf_uri.h"
#include "engine/scene/scene.h"
#include "engine/scene/tinygltf.h"
#include "engine/scene/warnings.h"

namespace scene::gltf
{

// An image as the file gives it, not yet read.
struct ImageSource {
    std::string name;
    std::string uri;     // else
    int bufferView = -1; // from a buffer
};

struct Document {
    Folders folders;
    tinygltf::Model model; // structure; what the vectors below hold is empty in it
    std::vector<std::vector<std::byte>> buffers;
    std::vector<ImageSource> images;
    std::vector<Material> materials;          // as readMaterials() gives them
    AnimationSources animations;              // none, where they are not asked for
    std::vector<std::filesystem::path> files; // that the buffers came from

    std::span<const std::byte> view(int bufferView) const; // all bytes of a buffer view
};

// Reads .gltf or .glb (told apart by the first bytes), checks it (gltf_json_checks.h) and reads materials and all
// buffers. Throws Error.
Document openDocument(const std::filesystem::path& file, const std::filesystem::path& assetRoot, bool animations,
                      Warnings& warnings);

} // namespace scene::gltf
