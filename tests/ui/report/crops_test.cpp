#include "ui/report/crops.h"

#include <gtest/gtest.h>

namespace
{

image::Plane plane(int width, int height)
{
    return {width, height, std::vector<double>(size_t(width) * size_t(height))};
}

} // namespace

TEST(Crops, LieOnTheLargestErrorsAndApart)
{
    image::Plane errors = plane(100, 60);
    const auto at = [&](int x, int y) -> double& { return errors.values[size_t(y) * 100 + size_t(x)]; };
    at(90, 50) = 1;
    at(91, 50) = 1;
    at(10, 5) = 0.5;
    const std::vector<ui::Crop> crops = ui::worstCrops(errors, {16, 8}, 3);
    ASSERT_EQ(crops.size(), 2u); // nowhere else is an error
    const auto holds = [](const ui::Crop& crop, int x, int y) {
        return crop.x <= x && x < crop.x + crop.width && crop.y <= y && y < crop.y + crop.height;
    };
    EXPECT_TRUE(holds(crops[0], 90, 50) && holds(crops[0], 91, 50));
    EXPECT_NEAR(crops[0].meanError, 2.0 / 128, 1e-12);
    EXPECT_TRUE(holds(crops[1], 10, 5));
}

TEST(Crops, FitIntoPicturesSmallerThanThey)
{
    image::Plane errors = plane(3, 40);
    EXPECT_TRUE(ui::worstCrops(errors, {16, 16}, 3).empty());
    errors.values[100] = 1;
    const std::vector<ui::Crop> crops = ui::worstCrops(errors, {16, 16}, 3);
    ASSERT_EQ(crops.size(), 1u);
    EXPECT_EQ(crops[0].width, 3);
    EXPECT_EQ(crops[0].height, 16);
    const image::Plane part = ui::cropped(errors, crops[0]);
    EXPECT_EQ(part.values.size(), 48u);
    EXPECT_EQ(std::count(part.values.begin(), part.values.end(), 1.0), 1);
}
