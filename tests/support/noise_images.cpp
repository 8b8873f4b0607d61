#include "tests/support/noise_images.h"

#include <random>
#include <vector>

namespace support
{

uint32_t addNoise(scene::Scene& scene, uint32_t width, uint32_t height, int low, uint32_t seed)
{
    std::mt19937 random(seed);
    scene::Image image{.name = "noise", .width = width, .height = height};
    for (uint32_t i = 0; i < 4 * width * height; ++i)
        image.rgba.push_back(static_cast<uint8_t>(low + static_cast<int>(random() % static_cast<uint32_t>(256 - low))));
    scene.images.push_back(image);
    return static_cast<uint32_t>(scene.images.size() - 1);
}

uint32_t addDeepNoise(scene::Scene& scene, uint32_t width, uint32_t height, int low, uint32_t seed)
{
    const uint32_t index = addNoise(scene, width, height, low, seed);
    std::mt19937 random(seed + 100);
    scene::Image& image = scene.images[index];
    for (const uint8_t high : image.rgba) image.deep.push_back(uint16_t(high << 8 | int(random() % 256)));
    image.rgba.clear();
    return index;
}

uint32_t addBumps(scene::Scene& scene)
{
    const uint32_t index = addNoise(scene, 5, 4, 0, 3);
    std::vector<uint8_t>& bytes = scene.images[index].rgba;
    for (size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<uint8_t>(i % 4 == 2 ? 200 : 64 + bytes[i] / 2);
    return index;
}

} // namespace support
