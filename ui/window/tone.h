#pragma once
// From linear radiance to what a screen shows.

#include <cstdint>
#include <vector>

#include "engine/image/image.h"

namespace ui
{

enum class ToneCurve : int { Reinhard, Aces, None }; // c/(c+1), as PNG files; a fit of the ACES film curve; cut at 1

struct Tone {
    float stops = 0; // exposure: times 2^stops
    ToneCurve curve = ToneCurve::Reinhard;
    bool operator==(const Tone&) const = default;
};

// 8-bit sRGB.
struct ScreenPicture {
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<uint8_t> rgba;
};

ScreenPicture toScreen(const image::Image& picture, const Tone& tone);

} // namespace ui
