#pragma once
// What the screen shows, as shaders/display.comp takes it.

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "shaders/shared/display.h"

namespace ui
{

enum class ToneCurve : uint32_t {
    Reinhard = shared::CURVE_REINHARD,
    Aces = shared::CURVE_ACES,
    None = shared::CURVE_NONE
};

struct Tone {
    float stops = 0; // exposure: times 2^stops
    ToneCurve curve = ToneCurve::Reinhard;
    bool operator==(const Tone&) const = default;
};

struct ScreenPixel {
    glm::vec3 color = glm::vec3(0); // linear radiance
    uint32_t asIs = 0;              // 1: sRGB-encoded, 0 to 1, and not toned
};

struct ScreenPicture {
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<ScreenPixel> pixels;
};

} // namespace ui
