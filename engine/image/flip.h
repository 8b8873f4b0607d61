#pragma once
// FLIP: how well a person who flips between two pictures sees the difference.

#include "engine/image/plane.h"

namespace image
{

// Errors per pixel, 0 to 1, of c/(c+1) as shown on an sRGB screen, unquantized, at 67 pixels per degree of view.
// Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images" (LDR-FLIP).
// What is below 0 is compared as a picture of its own (plane.h), and each pixel's error is the larger of the two.
// Throws Error as requireComparable does.
Plane flipErrors(const Image& reference, const Image& picture);

double meanOf(const Plane& plane);

} // namespace image
