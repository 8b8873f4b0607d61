#include "ui/report/crops.h"

#include <algorithm>
#include <cstdlib>

namespace ui
{

std::vector<Crop> worstCrops(const image::Plane& errors, glm::ivec2 size, int count)
{
    const int width = std::min(size.x, errors.width), height = std::min(size.y, errors.height);
    const size_t pitch = size_t(errors.width) + 1; // of the sums over all pixels above and to the left
    std::vector<double> sums(pitch * (size_t(errors.height) + 1));
    const auto sumAt = [&](int x, int y) -> double& { return sums[size_t(y) * pitch + size_t(x)]; };
    for (int y = 0; y < errors.height; ++y)
        for (int x = 0; x < errors.width; ++x)
            sumAt(x + 1, y + 1) = errors.values[size_t(y) * size_t(errors.width) + size_t(x)] + sumAt(x, y + 1) +
                                  sumAt(x + 1, y) - sumAt(x, y);

    std::vector<Crop> crops;
    while (int(crops.size()) < count) {
        Crop worst{.width = width, .height = height};
        for (int y = 0; y + height <= errors.height; ++y)
            for (int x = 0; x + width <= errors.width; ++x) {
                if (std::ranges::any_of(crops, [&](const Crop& other) {
                        return std::abs(other.x - x) < width && std::abs(other.y - y) < height;
                    }))
                    continue;
                const double mean =
                    (sumAt(x + width, y + height) - sumAt(x, y + height) - sumAt(x + width, y) + sumAt(x, y)) /
                    (double(width) * height);
                if (mean > worst.meanError) worst = {x, y, width, height, mean};
            }
        if (worst.meanError < 1e-9) break; // what rounding leaves in the sums is no error
        crops.push_back(worst);
    }
    return crops;
}

image::Image cropped(const image::Image& picture, const Crop& crop)
{
    image::Image result{uint32_t(crop.width), uint32_t(crop.height), {}};
    for (int y = 0; y < crop.height; ++y)
        for (int x = 0; x < crop.width; ++x)
            result.pixels.push_back(picture.at(uint32_t(crop.x + x), uint32_t(crop.y + y)));
    return result;
}

image::Plane cropped(const image::Plane& plane, const Crop& crop)
{
    image::Plane result{crop.width, crop.height, {}};
    for (int y = 0; y < crop.height; ++y)
        for (int x = 0; x < crop.width; ++x)
            result.values.push_back(plane.values[size_t(crop.y + y) * size_t(plane.width) + size_t(crop.x + x)]);
    return result;
}

} // namespace ui
