#include "ui/report/heat_map.h"

#include "engine/image/codecs.h"

#include <gtest/gtest.h>

TEST(HeatMap, RunsFromTheFirstColorToTheLastAndStopsThere)
{
    const image::Plane plane{5, 1, {-7, 0, 1, 2, 1e30}};
    const auto raster = image::decodePng<uint8_t>(ui::heatMapPng(plane, 0, 2, ui::ColorMap::Magma), "map");
    ASSERT_EQ(raster.width, 5u);
    ASSERT_EQ(raster.height, 1u);
    const auto color = [&](size_t i) { return std::vector<int>(&raster.rgba[4 * i], &raster.rgba[4 * i] + 3); };
    EXPECT_EQ(color(0), (std::vector<int>{0, 0, 4}));
    EXPECT_EQ(color(1), (std::vector<int>{0, 0, 4}));
    EXPECT_EQ(color(2), (std::vector<int>{181, 54, 122})); // magma's middle
    EXPECT_EQ(color(3), (std::vector<int>{252, 253, 191}));
    EXPECT_EQ(color(4), color(3));
}

TEST(HeatMap, IsWhiteInTheMiddleWhenSigned)
{
    const image::Plane plane{3, 1, {-1, 0, 1}};
    const auto raster = image::decodePng<uint8_t>(ui::heatMapPng(plane, -1, 1, ui::ColorMap::BlueRed), "map");
    EXPECT_GT(raster.rgba[2], raster.rgba[0]); // blue: darker
    EXPECT_EQ(raster.rgba[4], 247);
    EXPECT_EQ(raster.rgba[6], 247);
    EXPECT_GT(raster.rgba[8], raster.rgba[10]); // red: brighter
}
