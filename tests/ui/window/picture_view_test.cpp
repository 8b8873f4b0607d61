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

float redAt(const ui::ScreenPicture& screen, uint32_t x, uint32_t y)
{
    return screen.pixels[y * screen.width + x].color.r;
}

} // namespace

TEST(PictureView, SplitsFlipsAndSubtracts)
{
    ui::Pictures pictures{.sides = {shotOf(8, 4, 0.25f), shotOf(4, 2, 1.0f)}}; // B is of a moving camera
    ui::View view{.layout = ui::Layout::Split, .wipe = 0.25f};
    ui::ScreenPicture screen = compose(pictures, view);
    ASSERT_EQ(screen.width, 8u);
    EXPECT_EQ(redAt(screen, 1, 3), 0.25f);
    EXPECT_EQ(redAt(screen, 2, 3), 1);
    view.flipped = true;
    EXPECT_EQ(redAt(compose(pictures, view), 0, 0), 1);
    view = {.layout = ui::Layout::Difference};
    EXPECT_EQ(redAt(compose(pictures, view), 7, 3), 0.75f);
    view = {.layout = ui::Layout::One};
    EXPECT_EQ(redAt(compose(pictures, view), 7, 3), 0.25f);
    view = {.second = ui::Source::Reference, .layout = ui::Layout::Split, .wipe = 0};
    EXPECT_EQ(redAt(compose(pictures, view), 7, 3), 0.25f); // there is no reference
    EXPECT_EQ(compose({}, view).width, 0u);
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
    const ui::ScreenPicture screen = compose(pictures, view);
    EXPECT_EQ(screen.pixels[0].color, glm::vec3(1));
    EXPECT_EQ(screen.pixels[1].color, glm::vec3(1, 1, 0));
    EXPECT_EQ(screen.pixels[0].asIs, 1u);
    view = {.falseColor = ui::FalseColor::FailedShifts};
    EXPECT_LT(redAt(compose(pictures, view), 0, 0), 0.1f);
    EXPECT_GT(redAt(compose(pictures, view), 1, 0), 0.9f);
}

TEST(PictureView, ShiftsByOutcomeAndTheFloorHaveTheirColors)
{
    auto shot = std::make_shared<ui::Shot>();
    shot->picture = {.width = 2, .height = 1, .pixels = std::vector<glm::vec3>(2)};
    shot->order.settings.method = passes::Method::RgbRestir;
    shot->shifts = {passes::ShiftCounts{4, 0, 0, 0, 0, 0}, passes::ShiftCounts{0, 0, 0, 0, 4, 0}}; // done; hidden
    ui::Pictures pictures{.sides = {shot, nullptr}};
    ui::View view{.falseColor = ui::FalseColor::ShiftOutcomes};
    const ui::ScreenPicture screen = compose(pictures, view);
    const auto words = legendOf(*shot, nullptr, view.falseColor, 0);
    ASSERT_EQ(words.size(), 7u);
    EXPECT_EQ(words[1].text, "done 50.0%");
    EXPECT_EQ(words[5].text, "hidden 50.0%");
    for (const size_t pixel : {size_t{0}, size_t{1}})
        EXPECT_EQ(screen.pixels[pixel].color, words[pixel == 0 ? 1 : 5].color);

    view.falseColor = ui::FalseColor::Floor;
    EXPECT_EQ(compose(pictures, view).width, 2u); // nothing known yet
    ui::Floor floor{.deviation = {.width = 2, .height = 1, .pixels = {glm::vec3(0), glm::vec3(0.25f, 1, 0)}},
                    .frames = 8};
    pictures.floors[ui::A] = std::make_shared<const ui::Floor>(floor);
    EXPECT_EQ(redAt(compose(pictures, view), 0, 0), 0);
    EXPECT_EQ(redAt(compose(pictures, view), 1, 0), 0.25f);
    EXPECT_EQ(compose(pictures, view).pixels[1].asIs, 0u); // toned like the picture
}
