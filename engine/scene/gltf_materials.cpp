#include "engine/scene/gltf_materials.h"

#include <algorithm>
#include <cmath>

#include "engine/base/error.h"
#include "engine/scene/gltf_values.h"

namespace scene::gltf
{

namespace
{

Wrap wrapOf(double value, Warnings& warnings)
{
    if (value == 10497) return Wrap::Repeat;
    if (value == 33071) return Wrap::Clamp;
    if (value == 33648) return Wrap::Mirror;
    warnings.add(fmt::format("Took repeat for the unknown wrap mode {} of a sampler.", value));
    return Wrap::Repeat;
}

class MaterialReader
{
  public:
    explicit MaterialReader(Warnings& warnings) : warnings_(warnings) {}

    Material read(const Object& source);

    double in(double value, double minimum, double maximum, const char* what)
    {
        return clamped(value, minimum, maximum, fmt::format("the {} of a material", what), warnings_);
    }
    // A number of the file, or what it is where it is absent, within its range.
    float number(const Object& owner, const char* key, double absent, double minimum, double maximum, const char* what)
    {
        return static_cast<float>(in(owner.number(key).value_or(absent), minimum, maximum, what));
    }
    glm::vec3 colorIn(const glm::dvec3& color, double maximum, const char* what)
    {
        return {in(color.x, 0, maximum, what), in(color.y, 0, maximum, what), in(color.z, 0, maximum, what)};
    }
    TextureUse texture(const Object& owner, const char* key); // none where there is no such member
    void warn(const std::string& sentence) { warnings_.add(sentence); }
    double emissiveStrength = 1; // of the material that is being read

  private:
    void readMetallicRoughness(const Object& source, Material& material);
    void place(TextureUse& use, const Object& transform, size_t index);

    Warnings& warnings_;
};

// What an extension says of a material.
struct Extension {
    const char* name;
    void (*read)(MaterialReader& reader, const Object& extension, Material& material);
};
constexpr Extension EXTENSIONS[] = {
    {"KHR_materials_emissive_strength",
     [](MaterialReader& reader, const Object& extension, Material&) {
         reader.emissiveStrength = extension.number("emissiveStrength").value_or(1);
     }},
    {"KHR_materials_ior",
     [](MaterialReader& reader, const Object& extension, Material& material) {
         // 0 stands for infinity (total reflection); 1000 reflects 0.996.
         constexpr double LARGEST = 1000;
         const double value = extension.number("ior").value_or(1.5);
         material.ior = static_cast<float>(value == 0 ? LARGEST : reader.in(value, 1, LARGEST, "ior"));
     }},
    {"KHR_materials_specular",
     [](MaterialReader& reader, const Object& extension, Material& material) {
         material.specular = reader.number(extension, "specularFactor", 1, 0, 1, "specular factor");
         material.specularColor =
             reader.colorIn(extension.vector<3>("specularColorFactor").value_or(glm::dvec3(1)), 1000, "specular color");
         material.specularTexture = reader.texture(extension, "specularTexture");
         material.specularColorTexture = reader.texture(extension, "specularColorTexture");
     }},
    {"KHR_materials_transmission",
     [](MaterialReader& reader, const Object& extension, Material& material) {
         material.transmission = reader.number(extension, "transmissionFactor", 0, 0, 1, "transmission");
         material.transmissionTexture = reader.texture(extension, "transmissionTexture");
     }},
    {"KHR_materials_unlit", [](MaterialReader&, const Object&, Material& material) { material.unlit = true; }},
    {"KHR_materials_volume", [](MaterialReader& reader, const Object& extension, Material& material) {
         material.thin = !(extension.number("thicknessFactor").value_or(0) > 0);
         const glm::dvec3 color = extension.vector<3>("attenuationColor").value_or(glm::dvec3(1));
         const bool absorbs = extension.number("attenuationDistance") && color != glm::dvec3(1);
         if (!material.thin && absorbs) reader.warn("Ignored the attenuation of KHR_materials_volume on a material.");
     }}};

TextureUse MaterialReader::texture(const Object& owner, const char* key)
{
    TextureUse use;
    owner.object(key, [&](const Object& info) {
        const uint32_t index = info.required("index", info.index("index", "textures"));
        uint64_t uvSet = info.integer("texCoord", 0, 255).value_or(0);
        const Object source = info.root().at("textures", index);
        const std::optional<uint32_t> image = source.index("source", "images");
        if (!image) {
            warnings_.add(fmt::format("Ignored textures[{}], which has no image that can be read.", index));
            return;
        }
        info.extension("KHR_texture_transform", [&](const Object& transform) {
            uvSet = transform.integer("texCoord", 0, 255).value_or(uvSet);
            place(use, transform, index);
        });
        if (uvSet > 1) {
            warnings_.add(
                fmt::format("Ignored a texture that uses TEXCOORD_{}: only sets 0 and 1 are supported.", uvSet));
            return;
        }
        use.image = *image;
        use.uvSet = static_cast<uint32_t>(uvSet);
        if (const auto samplerIndex = source.index("sampler", "samplers")) {
            constexpr double REPEAT = 10497, NEAREST = 9728;
            const Object sampler = info.root().at("samplers", *samplerIndex);
            use.wrapU = wrapOf(sampler.number("wrapS").value_or(REPEAT), warnings_);
            use.wrapV = wrapOf(sampler.number("wrapT").value_or(REPEAT), warnings_);
            use.nearest = sampler.number("magFilter") == NEAREST;
        }
    });
    return use.image == NONE ? TextureUse{} : use;
}

void MaterialReader::place(TextureUse& use, const Object& transform, size_t index)
{
    // Counter-clockwise in the picture, whose v runs down: the sense of the extension's example and test model.
    const glm::dvec2 offset = transform.vector<2>("offset").value_or(glm::dvec2(0));
    const glm::dvec2 scale = transform.vector<2>("scale").value_or(glm::dvec2(1));
    const double angle = transform.number("rotation").value_or(0);
    use.row0 = glm::dvec3(std::cos(angle) * scale.x, std::sin(angle) * scale.y, offset.x);
    use.row1 = glm::dvec3(-std::sin(angle) * scale.x, std::cos(angle) * scale.y, offset.y);
    constexpr float LARGEST = 1e6f; // where float32 has lost the texel anyway
    for (const glm::vec3& row : {use.row0, use.row1}) {
        if (!(glm::length(row) < LARGEST))
            throw Error("The KHR_texture_transform of a use of textures[{}] exceeds 1e6.", index);
    }
}

void MaterialReader::readMetallicRoughness(const Object& source, Material& material)
{
    const glm::dvec4 color = source.vector<4>("baseColorFactor").value_or(glm::dvec4(1));
    for (int c = 0; c < 4; ++c) material.baseColor[c] = static_cast<float>(in(color[c], 0, 1, "base color"));
    material.metallic = number(source, "metallicFactor", 1, 0, 1, "metallic factor");
    material.roughness = number(source, "roughnessFactor", 1, 0, 1, "roughness");
    material.baseColorTexture = texture(source, "baseColorTexture");
    material.metallicRoughnessTexture = texture(source, "metallicRoughnessTexture");
}

Material MaterialReader::read(const Object& source)
{
    Material material;
    if (const std::string* name = source.string("name")) material.name = shown(*name);
    source.object("pbrMetallicRoughness", [&](const Object& pbr) { readMetallicRoughness(pbr, material); });
    material.normalTexture = texture(source, "normalTexture");
    source.object("normalTexture", [&](const Object& info) {
        material.normalScale = number(info, "scale", 1, -1000, 1000, "normal scale");
    });
    material.emissiveTexture = texture(source, "emissiveTexture");

    const std::string* mode = source.string("alphaMode");
    if (mode && *mode != "OPAQUE" && *mode != "MASK" && *mode != "BLEND")
        throw Error("{} is \"{}\", not OPAQUE, MASK or BLEND.", source.path("alphaMode"), shown(*mode));
    material.alpha = !mode || *mode == "OPAQUE" ? Alpha::Opaque : *mode == "MASK" ? Alpha::Mask : Alpha::Blend;
    material.alphaCutoff = number(source, "alphaCutoff", 0.5, 0, 2, "alpha cutoff"); // above 1: never there
    material.doubleSided = source.boolean("doubleSided").value_or(false);

    emissiveStrength = 1;
    for (const Extension& one : EXTENSIONS)
        source.extension(one.name, [&](const Object& extension) { one.read(*this, extension, material); });
    const glm::dvec3 emissive = source.vector<3>("emissiveFactor").value_or(glm::dvec3(0));
    material.emission = colorIn(emissive * emissiveStrength, MAX_RADIANCE, "emission");
    return material;
}

} // namespace

std::vector<Material> readMaterials(const Object& document, Warnings& warnings)
{
    MaterialReader reader(warnings);
    std::vector<Material> materials;
    document.eachObject("materials",
                        [&](const Object& material, size_t) { materials.push_back(reader.read(material)); });
    materials.emplace_back().name = "default";
    return materials;
}

bool isMaterialExtension(const std::string& name)
{
    return std::ranges::find(EXTENSIONS, name, &Extension::name) != std::end(EXTENSIONS);
}

} // namespace scene::gltf
