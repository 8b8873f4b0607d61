#pragma once
// The scenes that come with the program, generated in code: no assets, the same on every machine.

#include <vector>

#include <glm/glm.hpp>

#include "engine/scene/scene.h"

namespace scene
{

struct BuiltInScene {
    const char* name;        // as on the command line
    const char* description; // one line
    Scene (*make)();
};
std::vector<BuiltInScene> builtInScenes();

// The Cornell box (Goral et al. 1984; the dimensions of the Cornell data), one area light, all Lambert.
Scene makeCornell();

// Columns, arches and curtains lit by saturated spotlights: most of what one sees is coloured indirect light.
Scene makeHall();

// A terrace at night under some hundreds of small coloured lamps: strong coloured direct light.
Scene makeLamps();

// A room lit only through its doorway, from a white lamp around the corner: nearly all light is indirect.
Scene makeDim();

// A carousel in a hall, under lamps of nearly one color each. Rigid bodies, emitters and spotlights move; 8 s.
Scene makeCarousel();

// Flags and a pennant in front of a wall, strongly colored lamps on both sides of them. Deforming bodies move; 4 s.
Scene makeFlags();

// The inside of a closed Lambertian sphere (flat facets) that emits Le = 1 - rho everywhere: seen from inside, after at
// most D scattering events, L = Le (1 + rho + ... + rho^D) = 1 - rho^(D+1) per channel, whatever the direction.
Scene makeFurnace();
constexpr glm::vec3 FURNACE_ALBEDO = {0.8f, 0.5f, 0.2f};

} // namespace scene
