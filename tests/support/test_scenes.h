#pragma once
// Scenes of some dozens of triangles, each about one kind of material or light: small enough for the reference tracer.

#include <cstdint>
#include <ostream>
#include <vector>

#include "engine/scene/scene.h"
#include "passes/settings.h"

namespace support
{

struct TestScene {
    const char* name;
    scene::Scene (*make)();
    uint32_t maxBounces = 3;
    passes::PixelFilter filter = passes::PixelFilter::Center;

    passes::Settings settings() const; // a picture of 32x32
};
std::vector<TestScene> testScenes();
void PrintTo(const TestScene& scene, std::ostream* os);

// A ball (an icosahedron with smooth normals) of the material on a floor, under a lamp and a sky of several colours.
scene::Scene ballOf(const scene::Material& material);

// Diffuse, glossy, polished, mirroring, frosted and refracting things close together, under a lamp, a point light and a
// sky.
scene::Scene cabinet();

} // namespace support
