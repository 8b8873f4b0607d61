#include "engine/scene/gltf_materials.h"

#include <array>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <thread>

#include "engine/base/error.h"
#include "engine/scene/gltf_json.h"
#include "engine/scene/gltf_values.h"
#include "engine/scene/texture_image.h"

namespace scene::gltf
{

namespace
{

constexpr uint64_t MAX_TOTAL_PIXELS = uint64_t{1} << 30; // of all images of a scene

Wrap wrapOf(int value, Warnings& warnings)
{
    switch (value) {
    case TINYGLTF_TEXTURE_WRAP_REPEAT: return Wrap::Repeat;
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE: return Wrap::Clamp;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT: return Wrap::Mirror;
    default:
        warnings.add(fmt::format("Took repeat for the unknown wrap mode {} of a sampler.", value));
        return Wrap::Repeat;
    }
}

class MaterialReader
{
  public:
    MaterialReader(const Document& document, Warnings& warnings) : document_(document), warnings_(warnings) {}

    Material read(const tinygltf::Material& source);

  private:
    double in(double value, double minimum, double maximum, const char* what)
    {
        return clamped(value, minimum, maximum, fmt::format("the {} of a material", what), warnings_);
    }
    glm::vec3 colorIn(const glm::dvec3& color, double maximum, const char* what)
    {
        return {in(color.x, 0, maximum, what), in(color.y, 0, maximum, what), in(color.z, 0, maximum, what)};
    }
    TextureUse texture(int index, int uvSet, const tinygltf::Value* transform);
    TextureUse texture(const tinygltf::TextureInfo& info)
    {
        return texture(info.index, info.texCoord, findExtension(info.extensions, "KHR_texture_transform"));
    }
    TextureUse texture(const tinygltf::Value& extension, const char* key);
    void readExtensions(const tinygltf::Material& source, Material& material);

    const Document& document_;
    Warnings& warnings_;
};

TextureUse MaterialReader::texture(int index, int uvSet, const tinygltf::Value* transform)
{
    TextureUse use;
    if (index < 0) return use;
    const tinygltf::Texture& source = document_.model.textures[static_cast<size_t>(index)];
    if (source.source < 0) {
        warnings_.add(fmt::format("Ignored textures[{}], which has no image that can be read.", index));
        return use;
    }
    if (transform) {
        uvSet = static_cast<int>(numberOf(*transform, "texCoord", uvSet));
        const auto pair = [&](const char* key, double absent) -> glm::dvec2 {
            if (!transform->Has(key)) return glm::dvec2(absent);
            return {transform->Get(key).Get(0).GetNumberAsDouble(), transform->Get(key).Get(1).GetNumberAsDouble()};
        };
        // Counter-clockwise in the picture, whose v runs down: the sense of the extension's example and test model.
        const glm::dvec2 offset = pair("offset", 0), scale = pair("scale", 1);
        const double angle = numberOf(*transform, "rotation", 0);
        use.row0 = glm::dvec3(std::cos(angle) * scale.x, std::sin(angle) * scale.y, offset.x);
        use.row1 = glm::dvec3(-std::sin(angle) * scale.x, std::cos(angle) * scale.y, offset.y);
        constexpr float LARGEST = 1e6f; // where float32 has lost the texel anyway
        for (const glm::vec3& row : {use.row0, use.row1}) {
            if (!(glm::length(row) < LARGEST))
                throw Error("The KHR_texture_transform of a use of textures[{}] exceeds 1e6.", index);
        }
    }
    if (uvSet > 1) {
        warnings_.add(fmt::format("Ignored a texture that uses TEXCOORD_{}: only sets 0 and 1 are supported.", uvSet));
        return {};
    }
    use.image = static_cast<uint32_t>(source.source);
    use.uvSet = static_cast<uint32_t>(uvSet);
    if (source.sampler >= 0) {
        const tinygltf::Sampler& sampler = document_.model.samplers[static_cast<size_t>(source.sampler)];
        use.wrapU = wrapOf(sampler.wrapS, warnings_);
        use.wrapV = wrapOf(sampler.wrapT, warnings_);
        use.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
    }
    return use;
}

TextureUse MaterialReader::texture(const tinygltf::Value& extension, const char* key)
{
    if (!extension.Has(key)) return {};
    const tinygltf::Value& info = extension.Get(key);
    const tinygltf::Value* transform = nullptr;
    if (info.Has("extensions") && info.Get("extensions").Has("KHR_texture_transform"))
        transform = &info.Get("extensions").Get("KHR_texture_transform");
    return texture(static_cast<int>(numberOf(info, "index", -1)), static_cast<int>(numberOf(info, "texCoord", 0)),
                   transform);
}

void MaterialReader::readExtensions(const tinygltf::Material& source, Material& material)
{
    const auto find = [&](const char* name) { return findExtension(source.extensions, name); };
    material.unlit = find("KHR_materials_unlit") != nullptr;
    if (const auto* ior = find("KHR_materials_ior")) {
        // 0 stands for infinity (total reflection); 1000 reflects 0.996.
        constexpr double LARGEST = 1000;
        const double value = numberOf(*ior, "ior", 1.5);
        material.ior = static_cast<float>(value == 0 ? LARGEST : in(value, 1, LARGEST, "ior"));
    }
    if (const auto* specular = find("KHR_materials_specular")) {
        material.specular = static_cast<float>(in(numberOf(*specular, "specularFactor", 1), 0, 1, "specular factor"));
        material.specularColor =
            colorIn(vec3Of(*specular, "specularColorFactor", glm::dvec3(1)), 1000, "specular color");
        material.specularTexture = texture(*specular, "specularTexture");
        material.specularColorTexture = texture(*specular, "specularColorTexture");
    }
    if (const auto* transmission = find("KHR_materials_transmission")) {
        material.transmission =
            static_cast<float>(in(numberOf(*transmission, "transmissionFactor", 0), 0, 1, "transmission"));
        material.transmissionTexture = texture(*transmission, "transmissionTexture");
    }
    if (const auto* volume = find("KHR_materials_volume")) {
        material.thin = !(numberOf(*volume, "thicknessFactor", 0) > 0);
        const bool absorbs =
            volume->Has("attenuationDistance") && vec3Of(*volume, "attenuationColor", glm::dvec3(1)) != glm::dvec3(1);
        if (!material.thin && absorbs) warnings_.add("Ignored the attenuation of KHR_materials_volume on a material.");
    }
}

Material MaterialReader::read(const tinygltf::Material& source)
{
    Material material;
    material.name = shown(source.name);
    const auto& pbr = source.pbrMetallicRoughness;
    for (int c = 0; c < 4; ++c)
        material.baseColor[c] = static_cast<float>(in(pbr.baseColorFactor[static_cast<size_t>(c)], 0, 1, "base color"));
    material.metallic = static_cast<float>(in(pbr.metallicFactor, 0, 1, "metallic factor"));
    material.roughness = static_cast<float>(in(pbr.roughnessFactor, 0, 1, "roughness"));
    material.baseColorTexture = texture(pbr.baseColorTexture);
    material.metallicRoughnessTexture = texture(pbr.metallicRoughnessTexture);

    const auto& normal = source.normalTexture;
    material.normalTexture =
        texture(normal.index, normal.texCoord, findExtension(normal.extensions, "KHR_texture_transform"));
    material.normalScale = static_cast<float>(in(normal.scale, -1000, 1000, "normal scale"));

    const tinygltf::Value* strength = findExtension(source.extensions, "KHR_materials_emissive_strength");
    const double factor = strength ? numberOf(*strength, "emissiveStrength", 1) : 1;
    const glm::dvec3 emissive(source.emissiveFactor[0], source.emissiveFactor[1], source.emissiveFactor[2]);
    material.emission = colorIn(emissive * factor, MAX_RADIANCE, "emission");
    material.emissiveTexture = texture(source.emissiveTexture);

    material.alpha = source.alphaMode == "MASK"    ? Alpha::Mask
                     : source.alphaMode == "BLEND" ? Alpha::Blend
                                                   : Alpha::Opaque;
    material.alphaCutoff = static_cast<float>(in(source.alphaCutoff, 0, 2, "alpha cutoff")); // above 1: never there
    material.doubleSided = source.doubleSided;
    readExtensions(source, material);
    return material;
}

Image readImage(const Document& document, const ImageSource& source)
{
    if (source.bufferView >= 0) return decodeTexture(document.view(source.bufferView), source.name);
    return decodeTexture(readUri(source.uri, document.folders), source.name);
}

} // namespace

std::vector<Material> readMaterials(const Document& document, Warnings& warnings)
{
    MaterialReader reader(document, warnings);
    std::vector<Material> materials;
    for (const tinygltf::Material& source : document.model.materials) materials.push_back(reader.read(source));
    materials.emplace_back().name = "default";
    return materials;
}

std::vector<Image> readImages(const Document& document, std::vector<Material>& materials,
                              std::vector<std::filesystem::path>& files, const std::function<void(double)>& progress)
{
    std::vector<uint32_t> newIndex(document.images.size(), NONE), used;
    for (Material& material : materials) {
        eachTexture(material, [&](TextureUse& use) {
            uint32_t& index = newIndex[use.image];
            if (index == NONE) {
                index = static_cast<uint32_t>(used.size());
                used.push_back(use.image);
            }
            use.image = index;
        });
    }

    // The failure reported is that of the first image in order, whichever thread meets one first.
    std::vector<Image> images(used.size());
    std::vector<std::exception_ptr> failures(used.size());
    std::atomic<size_t> next = 0, done = 0;
    std::atomic<uint64_t> pixels = 0;
    const auto work = [&](bool reports) {
        for (size_t i = next++; i < used.size(); i = next++) {
            try {
                images[i] = readImage(document, document.images[used[i]]);
                pixels += uint64_t{images[i].width} * images[i].height;
                if (pixels > MAX_TOTAL_PIXELS)
                    throw Error("The images have more than {} pixels together.", MAX_TOTAL_PIXELS);
            } catch (...) {
                failures[i] = std::current_exception();
                next = used.size();
            }
            ++done;
            if (reports && progress) progress(static_cast<double>(done) / static_cast<double>(used.size()));
        }
    };
    std::thread helper(work, false);
    work(true);
    helper.join();
    for (const std::exception_ptr& failure : failures) {
        if (failure) std::rethrow_exception(failure);
    }
    for (const uint32_t index : used) {
        const ImageSource& source = document.images[index];
        if (const auto file = source.bufferView < 0 ? fileOf(source.uri, document.folders) : std::nullopt)
            files.push_back(*file);
    }
    return images;
}

} // namespace scene::gltf
