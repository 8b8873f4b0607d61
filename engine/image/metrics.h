#pragma once
// How far a picture is from a reference, in float64.

#include "engine/image/image.h"

namespace image
{

struct Metrics {
    double mse = 0;                    // of linear RGB, mean over pixels and channels, as all that follow
    double relmse = 0;                 // (x - r)^2 / (r^2 + RELATIVE_EPSILON)
    double mape = 0;                   // |x - r| / (|r| + RELATIVE_EPSILON)
    double psnr = 0;                   // dB, peak 1, of c/(c+1); infinite for equal pictures
    double ssim = 0;                   // of c/(c+1): Wang et al. 2004, 11x11 Gaussian, sigma 1.5, K 0.01 and 0.03, L 1
    double flip = 0;                   // of c/(c+1): engine/image/flip.h
    double lumaMse = 0, chromaMse = 0; // of YCoCg: (Y)^2; (Co)^2 + (Cg)^2
    glm::dvec3 meanRatio = glm::dvec3(1); // sum of the picture over sum of the reference
};

constexpr double RELATIVE_EPSILON = 1e-2;

// (Y, Co, Cg), without offsets: differences of pixels can be split as pixels can.
inline glm::dvec3 yCoCg(const glm::dvec3& rgb)
{
    return {rgb.r / 4 + rgb.g / 2 + rgb.b / 4, (rgb.r - rgb.b) / 2, rgb.g / 2 - (rgb.r + rgb.b) / 4};
}

// Throws Error: other sizes, a value that is not finite. Values below 0 count: c/(c+1) goes on as c/(1+|c|) for PSNR;
// SSIM and FLIP compare what is below as a picture of its own, and the worse of a pixel's two counts.
Metrics measure(const Image& reference, const Image& picture);

} // namespace image
