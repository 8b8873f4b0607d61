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

// The inside of a glowing sphere: L = Le (1 + rho + ... + rho^D).
ClosedForm furnace(uint32_t size, uint32_t maxBounces);

// A floor of white metal under a white sky, seen by parallel rays at `cosine`: what one bounce of GGX with G2 keeps.
ClosedForm ggxUnderWhiteSky(uint32_t size, float roughness, double cosine);

// The directional albedo of GGX with height-correlated Smith masking and F = 1, by quadrature.
double ggxAlbedo(double width, double cosine);

} // namespace support
