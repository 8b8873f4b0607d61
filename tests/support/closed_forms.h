#pragma once
// Scenes whose pictures are known: what a formula says, independent of any renderer.

#include <functional>
#include <vector>

#include <glm/glm.hpp>

#include "engine/scene/scene.h"
#include "passes/settings.h"
#include "tests/support/tile_tests.h"

namespace support
{

struct ClosedForm {
    const char* name;
    scene::Scene scene;
    passes::Settings settings;                              // a square picture, rays through pixel centres
    std::function<glm::dvec3(double x, double y)> radiance; // at a point of the picture, in [-1, 1], y down

    PictureEstimates exactly() const;
};
std::vector<ClosedForm> closedForms(uint32_t size);
void PrintTo(const ClosedForm& form, std::ostream* os);

// The floor y = 0, of FLOOR_ALBEDO, seen straight from above: the picture's point (x, y) is the floor's point (x, 0,
// y).
scene::Scene floorFromAbove();
extern const glm::vec3 FLOOR_ALBEDO;

// That floor under a rectangle at height 1.25 that shines down, made of columns x rows equal parts.
ClosedForm rectangleLight(uint32_t size, uint32_t columns = 1, uint32_t rows = 1);

// That floor under a black sky with one bright texel in `row`; seen from below where that row is in the lower half.
ClosedForm texelOfASky(uint32_t size, uint32_t columns, uint32_t rows, uint32_t row);

// That floor under a pale sky of 2048 x 1024 texels with a sun of half a degree, 40 degrees above the horizon.
ClosedForm sunInASky(uint32_t size);

// The inside of a glowing sphere: L = Le (1 + rho + ... + rho^D).
ClosedForm furnace(uint32_t size, uint32_t maxBounces);

// A floor of white metal under a white sky, seen by parallel rays at `cosine`: what one bounce of GGX with G2 keeps.
ClosedForm ggxUnderWhiteSky(uint32_t size, float roughness, double cosine);

// The directional albedo of GGX with height-correlated Smith masking and F = 1, by quadrature.
double ggxAlbedo(double width, double cosine);

} // namespace support
