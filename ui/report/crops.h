#pragma once
// Where two pictures differ most.

#include <vector>

#include "engine/image/plane.h"

namespace ui
{

struct Crop {
    int x = 0, y = 0, width = 0, height = 0; // pixels
    double meanError = 0;
};

// Up to `count` windows of this size (or of the picture's, where that is smaller), the largest mean error first; none
// overlap, and none is without error.
std::vector<Crop> worstCrops(const image::Plane& errors, glm::ivec2 size, int count);

image::Image cropped(const image::Image& picture, const Crop& crop);
image::Plane cropped(const image::Plane& plane, const Crop& crop);

} // namespace ui
