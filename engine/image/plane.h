#pragma once
// One channel of a picture in float64, for figures that look at neighborhoods.

#include <span>
#include <vector>

#include "engine/image/image.h"

namespace image
{

struct Plane {
    int width = 0, height = 0;
    std::vector<double> values; // row 0 at the top
};

// c/(1+|c|) of one channel: c/(c+1), and odd, so that what is below 0 is as far from it as what is above.
Plane tonemapped(const Image& picture, int channel);

// No screen shows values below 0, and what is made for screens knows none: what is below is then a picture of its own.
enum class Part { Above, Below };
Plane partOf(const Plane& plane, Part part); // the values above 0, or minus those below; 0 elsewhere

// The sum over the window of kernel times pixel: columns of it `alongX`, rows `alongY`, both of odd size and about the
// pixel. Outside the picture its edge goes on.
Plane filtered(const Plane& plane, std::span<const double> alongX, std::span<const double> alongY);

// exp(-x^2 / (2 sigma^2)) at x = -radius .. radius.
std::vector<double> gaussian(double sigma, int radius);

// Of the values of a picture, three a pixel.
size_t countBelowZero(const Image& picture);

// Throws Error: other sizes, no pixels, a value that is not finite.
void requireComparable(const Image& reference, const Image& picture);

} // namespace image
