#include "ui/window/tone.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ui
{

namespace
{

// sRGB of [0, 1] in 4096 steps: the largest error, near black, is below one of 255 levels.
uint8_t srgb(float linear)
{
    constexpr int STEPS = 4096;
    static const std::array<uint8_t, STEPS + 1> TABLE = [] {
        std::array<uint8_t, STEPS + 1> table{};
        for (int i = 0; i <= STEPS; ++i) {
            const double x = double(i) / STEPS;
            table[size_t(i)] =
                uint8_t(std::lround(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055)));
        }
        return table;
    }();
    const float step = std::clamp(linear, 0.0f, 1.0f) * STEPS;
    return TABLE[size_t(step + 0.5f)]; // NOLINT(bugprone-incorrect-roundings): never negative
}

float curveOf(ToneCurve curve, float c)
{
    switch (curve) {
    case ToneCurve::Reinhard: return c / (c + 1);
    case ToneCurve::Aces: return c * (2.51f * c + 0.03f) / (c * (2.43f * c + 0.59f) + 0.14f); // Narkowicz 2015
    case ToneCurve::None: break;
    }
    return c;
}

} // namespace

ScreenPicture toScreen(const image::Image& picture, const Tone& tone)
{
    ScreenPicture screen{.width = picture.width, .height = picture.height};
    screen.rgba.resize(picture.pixels.size() * 4);
    const float exposure = std::exp2(tone.stops);
    uint8_t* out = screen.rgba.data();
    for (const glm::vec3& pixel : picture.pixels) {
        for (int c = 0; c < 3; ++c) *out++ = srgb(curveOf(tone.curve, std::max(pixel[c] * exposure, 0.0f)));
        *out++ = 255;
    }
    return screen;
}

} // namespace ui
