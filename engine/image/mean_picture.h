#pragma once
// The mean of independent pictures, and how far that mean still is from the truth: references and their precision.

#include "engine/image/image.h"
#include "engine/image/metrics.h"

namespace image
{

// What a reference's own noise adds to the errors that are measured against it: E[(x - r)^2] = E[(x - truth)^2] + v,
// for x independent of r. Mean variances, each weighted as the figure in Metrics of the same name.
struct OwnError {
    double mse = 0, relmse = 0, lumaMse = 0, chromaMse = 0;
};

// The same figures without the reference's share; below 0 when the picture is as good as the reference: never cut off,
// so that means over repeats stay unbiased. PSNR, SSIM and MAPE are not linear in it and stay as measured.
Metrics without(const OwnError& error, const Metrics& measured);

// Streaming mean and variance per pixel and channel (Welford 1962), in float64.
class MeanPicture
{
  public:
    void add(const Image& picture); // all of equal size

    uint64_t count() const { return count_; }
    Image mean() const;
    OwnError ownError() const; // of mean(); needs two pictures

  private:
    uint32_t width_ = 0, height_ = 0;
    uint64_t count_ = 0;
    struct Pixel {
        glm::dvec3 mean = glm::dvec3(0), squares = glm::dvec3(0); // sum of squared deviations
        double luma = 0, orange = 0, green = 0;                   // the same of YCoCg
    };
    std::vector<Pixel> pixels_;
};

} // namespace image
