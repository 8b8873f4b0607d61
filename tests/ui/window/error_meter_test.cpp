// What the curves of error say, without a window.

#include "ui/window/error_meter.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace
{

image::Image gray(float value)
{
    return {.width = 16, .height = 16, .pixels = std::vector<glm::vec3>(256, glm::vec3(value))};
}

ui::ShotPointer shot(float value, double seconds)
{
    auto made = std::make_shared<ui::Shot>();
    made->picture = gray(value);
    made->run = 1;
    made->frames = 1;
    made->seconds = seconds;
    return made;
}

ui::ReferencePointer converging(float value)
{
    return std::make_shared<const ui::Reference>(
        ui::Reference{.picture = gray(value), .name = "reference", .error = {}, .converging = 7});
}

// The curve of side A as soon as its last point has this MSE; as it is after ten seconds, else.
ui::ErrorCurve curveWith(const ui::ErrorMeter& meter, double mse)
{
    for (int i = 0; i < 2000; ++i) {
        ui::ErrorCurve curve = meter.curve(ui::A);
        if (!curve.empty() && std::abs(curve.back().metrics.mse - mse) < 1e-6) return curve;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return meter.curve(ui::A);
}

} // namespace

// A side that stands still is judged by the reference of now, not by that of its last frame.
TEST(ErrorMeter, MeasuresTheLastPictureAgainWhenTheReferenceHasGotBetter)
{
    ui::ErrorMeter meter([] {});
    ui::Pictures pictures{.sides = {shot(0.5f, 1), nullptr}, .reference = converging(0.25f)};
    meter.offer(pictures);
    EXPECT_EQ(curveWith(meter, 0.0625).size(), 1u);

    pictures.reference = converging(0.375f);
    meter.offer(pictures);
    ui::ErrorCurve curve = curveWith(meter, 0.015625);
    ASSERT_EQ(curve.size(), 1u);
    EXPECT_NEAR(curve.back().metrics.mse, 0.015625, 1e-6);

    pictures.sides[ui::A] = shot(0.375f, 2); // a later picture is a point of its own
    meter.offer(pictures);
    curve = curveWith(meter, 0);
    ASSERT_EQ(curve.size(), 2u);
    EXPECT_EQ(curve[0].seconds, 1);
    EXPECT_EQ(curve[1].seconds, 2);
}

TEST(ErrorMeter, AnotherReferenceStartsAnotherCurve)
{
    ui::ErrorMeter meter([] {});
    ui::Pictures pictures{.sides = {shot(0.5f, 1), nullptr}, .reference = converging(0.25f)};
    meter.offer(pictures);
    EXPECT_EQ(curveWith(meter, 0.0625).size(), 1u);
    pictures.sides[ui::A] = shot(0.375f, 2);
    meter.offer(pictures);
    EXPECT_EQ(curveWith(meter, 0.015625).size(), 2u);
    pictures.reference =
        std::make_shared<const ui::Reference>(ui::Reference{.picture = gray(0.75f), .name = "file", .error = {}});
    meter.offer(pictures);
    EXPECT_EQ(curveWith(meter, 0.140625).size(), 1u);
}
