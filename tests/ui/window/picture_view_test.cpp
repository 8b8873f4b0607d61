// What is composed of two pictures, by their pixels.

#include "ui/window/picture_view.h"

#include "ui/window/false_color.h"

#include <gtest/gtest.h>

namespace
{

ui::ShotPointer shotOf(uint32_t width, uint32_t height, float gray)
{
    auto shot = std::make_shared<ui::Shot>();
    shot->picture = {
        .width = width, .height = height, .pixels = std::vector<glm::vec3>(size_t{width} * height, glm::vec3(gray))};
    return shot;
}

// With no tone curve, 0.25 shows as 137 and 1 as 255 (sRGB).
int redAt(const ui::ScreenPicture& screen, uint32_t x, uint32_t y)
{
    return screen.rgba[size_t{4} * (y * screen.width + x)];
}

const ui::Tone PLAIN{.stops = 0, .curve = ui::ToneCurve::None};

} // namespace

TEST(PictureView, SplitsFlipsAndSubtracts)
{
    ui::Pictures pictures{.sides = {shotOf(8, 4, 0.25f), shotOf(4, 2, 1.0f)}}; // B is of a moving camera
    ui::View view{.layout = ui::Layout::Split, .wipe = 0.25f};
    ui::ScreenPicture screen = compose(pictures, view, PLAIN);
    ASSERT_EQ(screen.width, 8u);
    EXPECT_EQ(redAt(screen, 1, 3), 137);
    EXPECT_EQ(redAt(screen, 2, 3), 255);
    view.flipped = true;
    EXPECT_EQ(redAt(compose(pictures, view, PLAIN), 0, 0), 255);
    view = {.layout = ui::Layout::Difference};
    EXPECT_NEAR(redAt(compose(pictures, view, PLAIN), 7, 3), 225, 1); // 0.75
    view = {.layout = ui::Layout::One};
    EXPECT_EQ(redAt(compose(pictures, view, PLAIN), 7, 3), 137);
    view = {.second = ui::Source::Reference, .layout = ui::Layout::Split, .wipe = 0};
    EXPECT_EQ(redAt(compose(pictures, view, PLAIN), 7, 3), 137); // there is no reference
    EXPECT_EQ(compose({}, view, PLAIN).width, 0u);
}

TEST(PictureView, AgreementAndFailedShiftsHaveTheirColors)
{
    auto shot = std::make_shared<ui::Shot>();
    shot->picture = {.width = 2, .height = 1, .pixels = std::vector<glm::vec3>(2)};
    shot->reservoirs.resize(6); // reservoir c of pixel p is element 2 c + p
    for (shared::Inspection& seen : shot->reservoirs) {
        seen.weightSum = 1;
        seen.lengthAndShifts = 2 | 4u << 16; // four shifts, none failed
    }
    shot->reservoirs[5].seedPixel = 9; // in the second pixel blue holds another tree
    shot->reservoirs[1].lengthAndShifts |= 4u << 24;
    const ui::Pictures pictures{.sides = {shot, nullptr}};
    ui::View view{.falseColor = ui::FalseColor::Agreement};
    const auto color = [](const ui::ScreenPicture& screen, size_t pixel) {
        return std::vector<int>{screen.rgba[4 * pixel], screen.rgba[4 * pixel + 1], screen.rgba[4 * pixel + 2]};
    };
    EXPECT_EQ(color(compose(pictures, view, PLAIN), 0), (std::vector<int>{255, 255, 255}));
    EXPECT_EQ(color(compose(pictures, view, PLAIN), 1), (std::vector<int>{255, 255, 0}));
    view = {.falseColor = ui::FalseColor::FailedShifts};
    EXPECT_LT(redAt(compose(pictures, view, PLAIN), 0, 0), 20);
    EXPECT_GT(redAt(compose(pictures, view, PLAIN), 1, 0), 240);
}

TEST(PictureView, ShiftsByOutcomeAndTheFloorHaveTheirColors)
{
    auto shot = std::make_shared<ui::Shot>();
    shot->picture = {.width = 2, .height = 1, .pixels = std::vector<glm::vec3>(2)};
    shot->order.settings.method = passes::Method::RgbRestir;
    shot->shifts = {passes::ShiftCounts{4, 0, 0, 0, 0, 0}, passes::ShiftCounts{0, 0, 0, 0, 4, 0}}; // done; hidden
    ui::Pictures pictures{.sides = {shot, nullptr}};
    ui::View view{.falseColor = ui::FalseColor::ShiftOutcomes};
    const ui::ScreenPicture screen = compose(pictures, view, PLAIN);
    const auto words = legendOf(*shot, nullptr, view.falseColor, 0);
    ASSERT_EQ(words.size(), 7u);
    EXPECT_EQ(words[1].text, "done 50.0%");
    EXPECT_EQ(words[5].text, "hidden 50.0%");
    for (const size_t pixel : {size_t{0}, size_t{1}})
        for (int i = 0; i < 3; ++i)
            EXPECT_NEAR(screen.rgba[4 * pixel + size_t(i)], 255 * words[pixel == 0 ? 1 : 5].color[i], 1);

    view.falseColor = ui::FalseColor::Floor;
    EXPECT_EQ(compose(pictures, view, PLAIN).width, 2u); // nothing known yet
    ui::Floor floor{.deviation = {.width = 2, .height = 1, .pixels = {glm::vec3(0), glm::vec3(0.25f, 1, 0)}},
                    .frames = 8};
    pictures.floors[ui::A] = std::make_shared<const ui::Floor>(floor);
    EXPECT_EQ(redAt(compose(pictures, view, PLAIN), 0, 0), 0);
    EXPECT_EQ(redAt(compose(pictures, view, PLAIN), 1, 0), 137);
}
