#include "engine/image/mean_picture.h"

#include "engine/base/check.h"

namespace image
{

Metrics without(const OwnError& error, const Metrics& measured)
{
    Metrics result = measured;
    result.mse -= error.mse;
    result.relmse -= error.relmse;
    result.lumaMse -= error.lumaMse;
    result.chromaMse -= error.chromaMse;
    return result;
}

void MeanPicture::add(const Image& picture)
{
    if (count_ == 0) {
        width_ = picture.width;
        height_ = picture.height;
        pixels_.resize(picture.pixels.size());
    }
    CHECK_EQ(picture.width, width_);
    CHECK_EQ(picture.height, height_);
    ++count_;
    const double n = double(count_);
    for (size_t i = 0; i < pixels_.size(); ++i) {
        Pixel& p = pixels_[i];
        const glm::dvec3 d = glm::dvec3(picture.pixels[i]) - p.mean;
        p.mean += d / n;
        p.squares += d * d * ((n - 1) / n);
        const glm::dvec3 ycc = yCoCg(d);
        const glm::dvec3 s = ycc * ycc * ((n - 1) / n);
        p.luma += s.x;
        p.orange += s.y;
        p.green += s.z;
    }
}

Image MeanPicture::mean() const
{
    Image picture{.width = width_, .height = height_};
    for (const Pixel& p : pixels_) picture.pixels.emplace_back(p.mean);
    return picture;
}

OwnError MeanPicture::ownError() const
{
    CHECK_LE(uint64_t{2}, count_);
    OwnError error;
    const double scale = 1 / (double(count_) * double(count_ - 1) * double(pixels_.size())); // squares -> mean variance
    for (const Pixel& p : pixels_) {
        for (int c = 0; c < 3; ++c) {
            error.mse += scale * p.squares[c] / 3;
            error.relmse += scale * p.squares[c] / 3 / (p.mean[c] * p.mean[c] + RELATIVE_EPSILON);
        }
        error.lumaMse += scale * p.luma;
        error.chromaMse += scale * (p.orange + p.green);
    }
    return error;
}

} // namespace image
