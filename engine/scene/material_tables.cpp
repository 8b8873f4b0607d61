#include "engine/scene/material_tables.h"

#include "engine/base/check.h"
#include "engine/scene/motion.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>

namespace scene
{

namespace
{

// As in shaders/scene/bsdf.glsl: below, specular lobes are Dirac.
constexpr float DIRAC_ROUGHNESS = 1.0f / 64.0f;
// A solid body of almost the index of air bends nothing: it is thin and clear (docs/LIGHT_TRANSPORT.md).
constexpr float INDEX_OF_AIR = 1.0f / 1024.0f;

glm::uvec4 row(float x, float y, float z, float w)
{
    return std::bit_cast<glm::uvec4>(glm::vec4(x, y, z, w));
}

bool isIdentity(const TextureUse& use)
{
    return use.row0 == glm::vec3(1, 0, 0) && use.row1 == glm::vec3(0, 1, 0);
}

// Smallest and largest value of the image's green channel (roughness), in [0, 1].
std::pair<float, float> greenRange(const Image& image)
{
    double low = 1, high = 0;
    for (size_t i = 1; i < image.sampleCount(); i += 4) {
        low = std::min(low, image.sample(i));
        high = std::max(high, image.sample(i));
    }
    return {float(low), float(high)};
}

// Has it lobes of a width?
bool isRough(const Material& material)
{
    return material.specular > 0 || material.metallic > 0 || material.transmission > 0;
}

// As the shaders take it.
Material plain(Material material)
{
    if (material.ior == 0) material.transmission = 0; // glTF: 0 means total reflection
    if (!material.thin && std::abs(material.ior - 1) < INDEX_OF_AIR) {
        material.thin = true;
        material.roughness = 0;
        material.metallicRoughnessTexture.image = NONE;
    }
    if (!isRough(material)) material.roughness = 1; // of lobes that are not there; at 0 they would be 0 times infinity
    return material;
}

using Head = std::array<glm::uvec4, shared::MATERIAL_HEAD_ROWS>;
Head headOf(const Material& material, double radianceScale)
{
    uint32_t flags = 0;
    if (material.doubleSided) flags |= shared::MATERIAL_DOUBLE_SIDED;
    if (material.unlit) flags |= shared::MATERIAL_UNLIT;
    if (material.transmission > 0) flags |= shared::MATERIAL_TRANSMISSIVE;
    if (material.transmission > 0 && !material.thin) flags |= shared::MATERIAL_SOLID;
    if (material.alpha == Alpha::Mask) flags |= shared::MATERIAL_MASK;
    if (material.alpha == Alpha::Blend) flags |= shared::MATERIAL_BLEND;

    const glm::vec3 emission(glm::dvec3(material.emission) * radianceScale);
    const glm::vec3 baseColor = glm::vec3(material.baseColor) * (material.unlit ? float(radianceScale) : 1.0f);
    const glm::vec3& tint = material.specularColor;
    return {row(baseColor.x, baseColor.y, baseColor.z, material.baseColor.w),
            row(emission.x, emission.y, emission.z, std::bit_cast<float>(flags)),
            row(material.metallic, material.roughness, material.ior, material.specular),
            row(tint.x, tint.y, tint.z, material.transmission), row(material.normalScale, material.alphaCutoff, 0, 0)};
}

class Builder
{
  public:
    explicit Builder(const Scene& scene, double radianceScale) : scene_(scene), radianceScale_(radianceScale) {}

    MaterialTables build(bool moves)
    {
        const std::vector<bool> used = usedMaterials(scene_);
        std::vector<bool> painted(scene_.materials.size(), false);
        if (moves)
            for (const Motion::Paint& paint : scene_.motion->paints) painted[paint.material] = true;
        for (size_t i = 0; i < scene_.materials.size(); ++i) {
            Material material = plain(scene_.materials[i]);
            if (!isRough(material) && !painted[i]) material.metallicRoughnessTexture.image = NONE;
            addMaterial(material, used[i]);
            if (painted[i] && used[i]) noteExtremes(scene_.materials[i]);
        }
        tables_.features.HAS_MANY_MATERIALS = scene_.materials.size() > 1;
        if (tables_.texels.empty()) tables_.texels.emplace_back(0);
        return std::move(tables_);
    }

  private:
    void addMaterial(const Material& material, bool used)
    {
        if (used) noteFeatures(material);
        auto& rows = tables_.rows;
        const Head head = headOf(material, radianceScale_);
        rows.insert(rows.end(), head.begin(), head.end());
        // In the order of TEXTURE_BASE_COLOR and so on; true: decoded from sRGB.
        addUse(material.baseColorTexture, true);
        addUse(material.metallicRoughnessTexture, false);
        addUse(material.normalTexture, false);
        addUse(material.emissiveTexture, true);
        addUse(material.transmissionTexture, false);
        addUse(material.specularTexture, false);
        addUse(material.specularColorTexture, true);
        CHECK_EQ(rows.size() % shared::MATERIAL_ROWS, 0u);
    }

    void addUse(const TextureUse& use, bool srgb)
    {
        auto& rows = tables_.rows;
        if (use.image == NONE) {
            rows.insert(rows.end(), shared::TEXTURE_ROWS, glm::uvec4(shared::NO_INDEX, 0, 0, 0));
            return;
        }
        const Image& image = scene_.images[use.image];
        uint32_t flags = uint32_t(use.wrapU) << shared::TEXTURE_WRAP_U_SHIFT | uint32_t(use.wrapV)
                                                                                   << shared::TEXTURE_WRAP_V_SHIFT;
        if (use.nearest) flags |= shared::TEXTURE_NEAREST;
        if (use.uvSet == 1) flags |= shared::TEXTURE_SECOND_UV;
        if (srgb) flags |= shared::TEXTURE_SRGB;
        if (!image.deep.empty()) flags |= shared::TEXTURE_DEEP;
        rows.emplace_back(firstBlock(use.image), image.width | image.height << 16, flags, 0);
        rows.push_back(row(use.row0.x, use.row0.y, use.row0.z, 0));
        rows.push_back(row(use.row1.x, use.row1.y, use.row1.z, 0));
    }

    // Where the image's texels start in table Texels; packs it on first use.
    uint32_t firstBlock(uint32_t imageIndex)
    {
        const auto [entry, isNew] = blocks_.try_emplace(imageIndex, uint32_t(tables_.texels.size()));
        if (!isNew) return entry->second;
        const Image& image = scene_.images[imageIndex];
        CHECK(image.width > 0 && image.height > 0 && image.width < 65536 && image.height < 65536);
        for (uint32_t y = 0; y < image.height; y += 2)
            for (uint32_t x = 0; x < image.width; x += 2) addBlock(image, x, y);
        return entry->second;
    }

    // Four texels, as shaders/scene/texture.glsl reads them.
    void addBlock(const Image& image, uint32_t left, uint32_t top)
    {
        const auto start = [&](uint32_t x, uint32_t y) { // the odd edge of the last block is never read
            return 4 * (size_t{std::min(y, image.height - 1)} * image.width + std::min(x, image.width - 1));
        };
        const auto texel = [&](uint32_t x, uint32_t y) {
            const uint8_t* p = &image.rgba[start(x, y)];
            return uint32_t(p[0]) | uint32_t(p[1]) << 8 | uint32_t(p[2]) << 16 | uint32_t(p[3]) << 24;
        };
        const auto deepTexel = [&](uint32_t x, uint32_t y) {
            const uint16_t* p = &image.deep[start(x, y)];
            return glm::uvec2(uint32_t(p[0]) | uint32_t(p[1]) << 16, uint32_t(p[2]) | uint32_t(p[3]) << 16);
        };
        if (image.deep.empty())
            tables_.texels.emplace_back(texel(left, top), texel(left + 1, top), texel(left, top + 1),
                                        texel(left + 1, top + 1));
        else
            for (const uint32_t y : {top, top + 1})
                tables_.texels.emplace_back(deepTexel(left, y), deepTexel(left + 1, y));
    }

    void noteFeatures(const Material& material)
    {
        SceneFeatures& f = tables_.features;
        f.HAS_UNLIT |= material.unlit;
        f.HAS_ALPHA |= material.alpha != Alpha::Opaque;
        f.blend |= material.alpha == Alpha::Blend;
        f.HAS_VERTEX_COLORS |= !scene_.colors.empty() ||
                               std::ranges::any_of(scene_.meshes, [](const Geometry& g) { return !g.colors.empty(); });
        noteTexture(material.baseColorTexture, f.HAS_BASE_COLOR_TEXTURE);
        noteTexture(material.normalTexture, f.HAS_NORMAL_MAP);
        if (material.emission != glm::vec3(0)) noteTexture(material.emissiveTexture, f.HAS_EMISSIVE_TEXTURE);
        if (material.unlit) return;

        const bool transmits = material.transmission > 0;
        f.HAS_TRANSMISSION |= transmits;
        f.HAS_SOLID |= transmits && !material.thin;
        f.HAS_SPECULAR |= material.specular > 0 || material.metallic > 0;
        if (!isRough(material)) return;
        noteTexture(material.metallicRoughnessTexture, f.HAS_METALLIC_ROUGHNESS_TEXTURE);
        noteTexture(material.specularTexture, f.HAS_SPECULAR_TEXTURE);
        noteTexture(material.specularColorTexture, f.HAS_SPECULAR_TEXTURE);
        if (transmits) noteTexture(material.transmissionTexture, f.HAS_TRANSMISSION_TEXTURE);
        float low = material.roughness, high = material.roughness;
        if (material.metallicRoughnessTexture.image != NONE) {
            const auto [darkest, brightest] = greenRange(scene_.images[material.metallicRoughnessTexture.image]);
            low *= darkest;
            high *= brightest;
        }
        f.HAS_DIRAC |= low < DIRAC_ROUGHNESS;
        f.HAS_ROUGH |= high >= DIRAC_ROUGHNESS;
    }

    // Of what an animation may make of it. More metal and more light need all that less of them needs.
    void noteExtremes(Material material)
    {
        material.metallic = 1;
        material.emission = glm::vec3(1);
        for (const float roughness : {0.0f, 1.0f}) {
            material.roughness = roughness;
            noteFeatures(plain(material));
        }
    }

    void noteTexture(const TextureUse& use, bool& feature)
    {
        if (use.image == NONE) return;
        feature = true;
        tables_.features.HAS_DEEP_TEXTURE |= !scene_.images[use.image].deep.empty();
        tables_.features.HAS_SECOND_UV |= use.uvSet == 1;
        tables_.features.HAS_TEXTURE_TRANSFORM |= !isIdentity(use);
    }

    const Scene& scene_;
    const double radianceScale_;
    MaterialTables tables_;
    std::map<uint32_t, uint32_t> blocks_; // image index -> first block
};

} // namespace

MaterialTables makeMaterialTables(const Scene& scene, double radianceScale, bool moves)
{
    return Builder(scene, radianceScale).build(moves);
}

std::vector<glm::uvec4> repaint(std::vector<glm::uvec4> rows, const Scene& scene, double radianceScale)
{
    for (size_t i = 0; i < scene.materials.size(); ++i)
        std::ranges::copy(headOf(plain(scene.materials[i]), radianceScale),
                          rows.begin() + std::ptrdiff_t(i * shared::MATERIAL_ROWS));
    return rows;
}

} // namespace scene
