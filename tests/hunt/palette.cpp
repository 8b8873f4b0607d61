#include "tests/hunt/palette.h"

#include <algorithm>

#include "engine/scene/shapes.h"

namespace hunt
{

using glm::vec2, glm::vec3, glm::vec4;
using scene::Material, scene::Scene, scene::TextureUse;

bool Palette::has(Stuff one) const
{
    return std::ranges::find(stuff, one) != stuff.end();
}

Stuff Palette::any(Draw& draw) const
{
    return stuff[draw.below(uint32_t(stuff.size()))];
}

Stuff Palette::anyOpaque(Draw& draw) const
{
    std::vector<Stuff> opaque;
    for (const Stuff one : stuff)
        if (one == Stuff::Diffuse || one == Stuff::Glossy || one == Stuff::RoughMetal || one == Stuff::Mirror)
            opaque.push_back(one);
    return opaque.empty() ? Stuff::Diffuse : opaque[draw.below(uint32_t(opaque.size()))];
}

void Palette::addRandomTextures(Draw& draw)
{
    for (bool* flag : {&baseColorTexture, &metallicRoughnessTexture, &normalTexture, &emissiveTexture,
                       &transmissionTexture, &specularTexture})
        *flag = draw.chance(0.2);
    vertexColors = draw.chance(0.2);
    secondUv = textured() && draw.chance(0.3);
    transforms = textured() && draw.chance(0.3);
}

Material Palette::material(Draw& draw, Stuff one) const
{
    const vec4 color(draw.color(), 1);
    const auto rough = [&] {
        return float(smooth && draw.chance(0.3) ? draw.logBetween(0.0157, 0.2) : draw.between(0.2, 1));
    };
    const auto index = [&] { return float(draw.chance(0.2) ? draw.between(1.005, 3) : draw.between(1.2, 1.8)); };
    Material m = {.name = "stuff", .baseColor = color, .metallic = 0, .roughness = 1, .specular = 0};
    switch (one) {
    case Stuff::Diffuse: break;
    case Stuff::Glossy:
        m.roughness = rough();
        m.ior = index();
        m.specular = draw.chance(0.5) ? 1 : float(draw.between(0.1, 1));
        if (draw.chance(0.3)) m.specularColor = draw.color(0.2, 1);
        if (draw.chance(0.3)) m.metallic = float(draw.between(0, 1));
        break;
    case Stuff::RoughMetal:
        m.metallic = 1;
        m.roughness = rough();
        m.specular = 1;
        break;
    case Stuff::Mirror:
        m.metallic = draw.chance(0.5) ? 1 : float(draw.between(0, 1));
        m.roughness = draw.chance(0.5) ? 0 : 0.01f;
        m.specular = 1;
        m.ior = index();
        break;
    case Stuff::ThinClear:
    case Stuff::ThinRough:
    case Stuff::SolidClear:
    case Stuff::SolidRough:
        m.specular = 1;
        m.transmission = draw.chance(0.5) ? 1 : float(draw.between(0.2, 1));
        m.roughness = one == Stuff::ThinRough || one == Stuff::SolidRough ? rough() : 0;
        m.ior = index();
        m.thin = one == Stuff::ThinClear || one == Stuff::ThinRough;
        break;
    case Stuff::Blend:
        m.alpha = scene::Alpha::Blend;
        m.baseColor.a = draw.chance(0.3) ? 1.0f / 3 : float(draw.between(0.1, 0.9));
        break;
    case Stuff::Mask:
        m.alpha = scene::Alpha::Mask;
        m.alphaCutoff = float(draw.between(0.2, 0.8));
        break;
    case Stuff::Unlit: m.unlit = true; break;
    }
    m.doubleSided = draw.chance(0.3);
    addTextures(draw, m);
    return m;
}

Material Palette::lamp(Draw& draw, double radiance) const
{
    Material m = scene::emitter("lamp", draw.color(0.3, 1) * float(radiance));
    m.doubleSided = draw.chance(0.3);
    if (emissiveTexture) m.emissiveTexture.image = 0;
    if (has(Stuff::Blend) && draw.chance(0.2)) {
        m.alpha = scene::Alpha::Blend;
        m.baseColor.a = float(draw.between(0.2, 0.9));
    }
    return m;
}

void Palette::addTextures(Draw& draw, Material& m) const
{
    const auto use = [&](bool wanted, TextureUse& texture, uint32_t image) {
        if (!wanted) return;
        texture.image = image;
        texture.nearest = draw.chance(0.3);
        texture.wrapU = draw.of({scene::Wrap::Repeat, scene::Wrap::Clamp, scene::Wrap::Mirror});
        texture.wrapV = draw.of({scene::Wrap::Repeat, scene::Wrap::Clamp, scene::Wrap::Mirror});
        if (secondUv) texture.uvSet = draw.below(2);
        if (!transforms) return;
        const double angle = draw.between(-3, 3), s = draw.between(0.5, 2), t = draw.between(0.5, 2);
        texture.row0 = {std::cos(angle) * s, std::sin(angle) * t, draw.between(-1, 1)};
        texture.row1 = {-std::sin(angle) * s, std::cos(angle) * t, draw.between(-1, 1)};
    };
    use(baseColorTexture || m.alpha == scene::Alpha::Mask, m.baseColorTexture, 0);
    if (m.unlit) return;
    use(metallicRoughnessTexture, m.metallicRoughnessTexture, 0);
    use(normalTexture, m.normalTexture, 1);
    if (m.normalTexture.image != scene::NONE) m.normalScale = float(draw.between(0.2, 1.2));
    use(transmissionTexture, m.transmissionTexture, 0);
    use(specularTexture, m.specularTexture, 0);
    use(specularTexture, m.specularColorTexture, 0);
}

// Image 0: noise; image 1: bumps.
void Palette::addImages(Scene& scene, Draw& draw) const
{
    if (!textured() && !has(Stuff::Mask)) return;
    for (int bumps = 0; bumps < 2; ++bumps) {
        scene::Image image{.name = bumps ? "bumps" : "noise", .width = draw.from(1, 9), .height = draw.from(1, 9)};
        if (draw.chance(0.1)) image.width = 1;
        for (uint32_t i = 0; i < 4 * image.width * image.height; ++i) {
            const uint32_t byte = draw.below(256);
            image.rgba.push_back(uint8_t(!bumps ? byte : i % 4 == 2 ? 200 : 64 + byte / 2));
        }
        if (!bumps) image.rgba[1] = 0; // so that roughness times it is a mirror's somewhere, in each scene
        if (!bumps) image.rgba[4 * image.width * image.height - 3] = 255;
        if (!bumps && image.width * image.height == 1) {
            image = {.name = "noise", .width = 2, .height = 1, .rgba = {90, 0, 200, 60, 250, 255, 30, 220}};
        }
        scene.images.push_back(image);
    }
}

void Palette::addAttributes(Scene& scene, Draw& draw) const
{
    const bool coordinates = textured() || has(Stuff::Mask);
    const float scale = float(draw.logBetween(0.3, 3));
    const vec2 shift(draw.between(-1, 1), draw.between(-1, 1));
    const float handedness = draw.of({-1.0f, 1.0f}); // one: the vertices of a triangle have to agree
    for (size_t i = 0; i < scene.positions.size(); ++i) {
        const vec3 p = scene.positions[i], n = scene.normals[i];
        const vec3 tangent = glm::normalize(std::abs(n.x) < 0.7f ? vec3(1, 0, 0) - n.x * n : vec3(0, 1, 0) - n.y * n);
        if (coordinates) {
            const vec2 on(dot(p, tangent), dot(p, cross(n, tangent)));
            scene.uv0.push_back(scale * on + shift);
            if (secondUv) scene.uv1.push_back(vec2(on.y - on.x, on.x) * 0.7f - shift);
            scene.tangents.push_back(vec4(tangent, handedness));
        }
        // Halves on the device: eighths are exact there.
        if (vertexColors)
            scene.colors.push_back(vec4(float(i % 7 + 1), float(i * 3 % 8 + 1), float(i * 5 % 6 + 2), 8) / 8.0f);
    }
}

void Palette::addTokens(Scene& scene, Draw& draw) const
{
    if (scene.positions.empty()) return;
    for (const Stuff one : stuff) {
        Material token = material(draw, one);
        if (secondUv)
            for (TextureUse* use : {&token.baseColorTexture, &token.metallicRoughnessTexture, &token.normalTexture,
                                    &token.transmissionTexture, &token.specularTexture, &token.specularColorTexture})
                use->uvSet = 1;
        scene.triangles.push_back({.vertices = {0, 0, 0}, .material = scene::addMaterial(scene, token)});
    }
}

void Palette::complete(Scene& scene, Draw& draw) const
{
    addImages(scene, draw);
    addTokens(scene, draw);
    addAttributes(scene, draw);
}

} // namespace hunt
