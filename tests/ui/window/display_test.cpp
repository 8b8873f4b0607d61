// What the screen shows of a pixel, against the formulas in float64.

#include "ui/window/tone.h"

#include "tests/support/gpu_fixture.h"

#include <bit>
#include <cmath>
#include <limits>

namespace
{

class Display : public GpuTest
{
  protected:
    // RGBA of each pixel.
    std::vector<glm::u8vec4> shown(const std::vector<ui::ScreenPixel>& pixels, uint32_t width, const ui::Tone& tone)
    {
        std::vector<ui::ScreenPixel> rows(1);
        rows.insert(rows.end(), pixels.begin(), pixels.end());
        const uint32_t height = uint32_t(pixels.size()) / width;
        rows[0] = {{std::bit_cast<float>(width), std::bit_cast<float>(height), std::exp2(tone.stops)},
                   uint32_t(tone.curve)};
        const gpu::Buffer picture = upload("picture", rows, gpu::Usage::Table);
        const gpu::Buffer screen = create<uint32_t>("screen", pixels.size());
        run({.shader = "display", .buffers = {{"Picture", &picture}, {"Screen", &screen}}, .threads = {width, height}});
        return download<glm::u8vec4>(screen);
    }
};

double expected(double radiance, const ui::Tone& tone)
{
    const double c = std::max(radiance * std::exp2(double(tone.stops)), 0.0);
    double mapped = c;
    if (tone.curve == ui::ToneCurve::Reinhard) mapped = std::isinf(c) ? 1 : c / (c + 1);
    if (tone.curve == ui::ToneCurve::Aces)
        mapped = std::isinf(c) ? 1 : c * (2.51 * c + 0.03) / (c * (2.43 * c + 0.59) + 0.14);
    mapped = std::min(mapped, 1.0);
    return 255 * (mapped <= 0.0031308 ? 12.92 * mapped : 1.055 * std::pow(mapped, 1 / 2.4) - 0.055);
}

constexpr float INFINITE = std::numeric_limits<float>::infinity(), NONE = std::numeric_limits<float>::quiet_NaN();

} // namespace

TEST_F(Display, ShowsRadianceByTheFormulasWithinAStepHoweverLargeOrSmall)
{
    std::vector<float> values = {0,     1e-45f,  1e-38f, 65504,  1e10f,    1e19f,    1e30f,
                                 3e38f, -1e-45f, -1,     -3e38f, INFINITE, -INFINITE};
    for (int i = -80; i < 80; ++i) values.push_back(std::exp2(float(i) / 5));
    while (values.size() % 5 != 0) values.push_back(0.5f);
    std::vector<ui::ScreenPixel> pixels;
    for (const float value : values) pixels.push_back({{value, value / 2, -value}});
    for (const ui::ToneCurve curve : {ui::ToneCurve::Reinhard, ui::ToneCurve::Aces, ui::ToneCurve::None})
        for (const float stops : {0.0f, -10.0f, 10.0f, 1.3f}) {
            const ui::Tone tone{stops, curve};
            const std::vector<glm::u8vec4> screen = shown(pixels, 5, tone);
            for (size_t i = 0; i < pixels.size(); ++i) {
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(screen[i][c], expected(double(pixels[i].color[c]), tone), 1)
                        << pixels[i].color[c] << " on curve " << int(curve) << ", " << stops << " stops";
                EXPECT_EQ(screen[i].a, 255);
            }
        }
}

TEST_F(Display, ShowsWhatIsNoNumberInMagentaAndFalseColorsAsTheyAre)
{
    const std::vector<glm::u8vec4> screen =
        shown({{{NONE, 0.5f, 0.5f}}, {{0, -NONE, 0}, 1}, {{0, 0.5f, 1}, 1}, {{0.2f, 0.4f, 0.6f}, 1}}, 2, {.stops = 3});
    EXPECT_EQ(screen[0], glm::u8vec4(255, 0, 255, 255));
    EXPECT_EQ(screen[1], glm::u8vec4(255, 0, 255, 255));
    EXPECT_EQ(screen[2].r, 0);
    EXPECT_NEAR(screen[2].g, 127.5, 0.5);
    EXPECT_EQ(screen[2].b, 255);
    EXPECT_EQ(screen[3], glm::u8vec4(51, 102, 153, 255));
}
