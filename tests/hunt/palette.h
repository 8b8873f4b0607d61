#pragma once
// What the scenes of a session are made of. All of them need the same features, so that they share compiled stages.

#include <vector>

#include "engine/scene/scene.h"
#include "tests/hunt/draw.h"

namespace hunt
{

enum class Stuff : uint32_t {
    Diffuse,
    Glossy,
    RoughMetal,
    Mirror,
    ThinClear,
    ThinRough,
    SolidClear,
    SolidRough,
    Blend,
    Mask,
    Unlit
};

struct Palette {
    std::vector<Stuff> stuff = {Stuff::Diffuse};
    bool smooth = false; // also roughness just above a mirror's: where float32 normals do not decide about the picture
    bool baseColorTexture = false, metallicRoughnessTexture = false, normalTexture = false, emissiveTexture = false,
         transmissionTexture = false, specularTexture = false;
    bool vertexColors = false, secondUv = false, transforms = false;
    bool emitters = false, punctual = false, directional = false, sky = false;

    bool textured() const
    {
        return baseColorTexture || metallicRoughnessTexture || normalTexture || emissiveTexture ||
               transmissionTexture || specularTexture;
    }
    bool has(Stuff one) const;
    Stuff any(Draw& draw) const;        // of the palette's
    Stuff anyOpaque(Draw& draw) const;  // that stops every ray
    void addRandomTextures(Draw& draw); // some of the flags above, rarely many
    scene::Material material(Draw& draw, Stuff stuff) const;
    scene::Material lamp(Draw& draw, double radiance) const;

    // What a scene of this palette needs beyond its geometry, materials and lights: images, attributes of the vertices,
    // a light of each kind; and a triangle without area of each kind of material, so that features do not depend on
    // chance.
    void complete(scene::Scene& scene, Draw& draw) const;

  private:
    void addTextures(Draw& draw, scene::Material& material) const;
    void addImages(scene::Scene& scene, Draw& draw) const;
    void addAttributes(scene::Scene& scene, Draw& draw) const;
    void addTokens(scene::Scene& scene, Draw& draw) const;
};

} // namespace hunt
