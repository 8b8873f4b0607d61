// Values between keys against closed forms, computed here in float64 from the words of glTF 2.0, appendix C.

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "engine/scene/animation.h"

namespace scene
{
namespace
{

using std::numbers::pi;
using Numbers = std::vector<double>;

Numbers at(Interpolation interpolation, const std::vector<float>& times, const std::vector<float>& values, size_t width,
           double seconds, bool rotation = false)
{
    Numbers value(width);
    interpolate(interpolation, rotation, times, values, seconds, value);
    return value;
}

void expectNear(const Numbers& value, const Numbers& expected, double tolerance = 1e-7)
{
    ASSERT_EQ(value.size(), expected.size());
    for (size_t i = 0; i < value.size(); ++i) EXPECT_NEAR(value[i], expected[i], tolerance) << "number " << i;
}

// Degrees about the vertical, as x, y, z, w.
std::vector<float> turn(double degrees)
{
    const double half = degrees / 360 * pi;
    return {0, float(std::sin(half)), 0, float(std::cos(half))};
}

std::vector<float> joined(std::initializer_list<std::vector<float>> parts)
{
    std::vector<float> all;
    for (const std::vector<float>& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

double degreesOf(const Numbers& rotation)
{
    return std::atan2(rotation[1], rotation[3]) * 360 / pi;
}

} // namespace

TEST(Animation, StepHoldsUntilTheNextKeyAndLinearMixes)
{
    const std::vector<float> times = {1, 2, 4}, values = {10, -1, 20, -2, 40, -8};
    expectNear(at(Interpolation::Step, times, values, 2, 1.999), {10, -1});
    expectNear(at(Interpolation::Step, times, values, 2, 2), {20, -2}); // at a key: that key's
    expectNear(at(Interpolation::Step, times, values, 2, 3.999), {20, -2});
    expectNear(at(Interpolation::Linear, times, values, 2, 2), {20, -2});
    expectNear(at(Interpolation::Linear, times, values, 2, 2.5), {25, -3.5});
    expectNear(at(Interpolation::Linear, times, values, 2, 3.5), {35, -6.5});
}

TEST(Animation, EndsAreHeld)
{
    const std::vector<float> times = {1, 2}, values = {10, 20}, spline = {5, 10, 7, 9, 20, 3};
    for (const Interpolation interpolation : {Interpolation::Step, Interpolation::Linear}) {
        for (const double before : {-1e30, 0.0, 1.0}) expectNear(at(interpolation, times, values, 1, before), {10});
        for (const double after : {2.0, 3.0, 1e30}) expectNear(at(interpolation, times, values, 1, after), {20});
    }
    for (const double before : {-1e30, 0.0, 1.0})
        expectNear(at(Interpolation::CubicSpline, times, spline, 1, before), {10});
    for (const double after : {2.0, 3.0, 1e30})
        expectNear(at(Interpolation::CubicSpline, times, spline, 1, after), {20});
}

TEST(Animation, OneKeyIsEverywhere)
{
    for (const double seconds : {-1.0, 0.5, 9.0}) {
        expectNear(at(Interpolation::Step, {0.5f}, {3}, 1, seconds), {3});
        expectNear(at(Interpolation::Linear, {0.5f}, {3}, 1, seconds), {3});
        expectNear(at(Interpolation::CubicSpline, {0.5f}, {7, 3, 7}, 1, seconds), {3});
    }
}

// A cubic with the slopes that the file gives: any polynomial of degree 3 comes back exactly.
TEST(Animation, CubicSplinesReproduceCubics)
{
    const auto value = [](double x) { return 2 - x + 0.5 * x * x - 0.25 * x * x * x; };
    const auto slope = [](double x) { return -1 + x - 0.75 * x * x; };
    const std::vector<float> times = {0, 0.5f, 2, 2.25f};
    std::vector<float> keys;
    for (const double t : {0.0, 0.5, 2.0, 2.25})
        for (const double number : {slope(t), value(t), slope(t)}) keys.push_back(float(number));
    for (double t = 0; t <= 2.25; t += 0.05)
        EXPECT_NEAR(at(Interpolation::CubicSpline, times, keys, 1, t)[0], value(t), 1e-6) << t;
}

// The in-tangent of a key belongs to the span before it, the out-tangent to the one after.
TEST(Animation, CubicSplinesUseEachTangentOnItsSide)
{
    const std::vector<float> keys = {100, 0, 0, 8, 0, 0, 0, 0, 100};
    const std::vector<float> times = {0, 2, 3};
    expectNear(at(Interpolation::CubicSpline, times, keys, 1, 1), {2 * (0.125 - 0.25) * 8}); // t^3 - t^2 at 1/2
    expectNear(at(Interpolation::CubicSpline, times, keys, 1, 2.5), {0});
}

TEST(Animation, RotationsTurnEvenlyAndTheShorterWay)
{
    const std::vector<float> times = {0, 1};
    for (const double from : {0.0, 30.0, 170.0}) {
        for (const double by : {90.0, -90.0, 179.0, 1e-3, 1e-6}) {
            std::vector<float> end = turn(from + by);
            for (const float sign : {1.0f, -1.0f}) { // -q is the same rotation
                std::vector<float> signedEnd = end;
                for (float& x : signedEnd) x *= sign;
                for (const double t : {0.25, 0.5, 0.9}) {
                    const Numbers q = at(Interpolation::Linear, times, joined({turn(from), signedEnd}), 4, t, true);
                    EXPECT_NEAR(std::hypot(q[0], q[1], std::hypot(q[2], q[3])), 1, 1e-12);
                    EXPECT_NEAR(std::remainder(degreesOf(q) - from - t * by, 360), 0, 2e-5) << from << ' ' << by;
                }
            }
        }
    }
    // 270 degrees are 90 the other way.
    EXPECT_NEAR(degreesOf(at(Interpolation::Linear, times, joined({turn(0), turn(270)}), 4, 0.5, true)), -45, 2e-5);
}

TEST(Animation, RotationsNeedNotBeUnitAndComeBackUnit)
{
    std::vector<float> longer = turn(80);
    for (float& x : longer) x *= 3;
    EXPECT_NEAR(degreesOf(at(Interpolation::Linear, {0, 1}, joined({turn(0), longer}), 4, 0.5, true)), 40, 1e-4);
    expectNear(at(Interpolation::Step, {0, 1}, joined({{0, 0, 0, 2}, longer}), 4, 0.5, true), {0, 0, 0, 1});
    const std::vector<float> flat = {0, 0, 0, 0};
    const std::vector<float> spline = joined({flat, turn(0), flat, flat, turn(90), flat});
    const Numbers middle = at(Interpolation::CubicSpline, {0, 1}, spline, 4, 0.5, true);
    EXPECT_NEAR(degreesOf(middle), 45, 1e-4);
    EXPECT_NEAR(std::hypot(middle[1], middle[3]), 1, 1e-12);
    // Half way between opposite quaternions a spline passes through zero: any rotation, but a rotation.
    const std::vector<float> through = joined({flat, {0, 0, 0, 1}, flat, flat, {0, 0, 0, -1}, flat});
    expectNear(at(Interpolation::CubicSpline, {0, 1}, through, 4, 0.5, true), {0, 0, 0, 1});
}

TEST(Animation, AmongManyKeysTheTwoAroundATimeAreFound)
{
    std::vector<float> times, values;
    for (int i = 0; i < 100000; ++i) {
        times.push_back(float(i) / 64);
        values.push_back(float(i % 7));
    }
    std::mt19937 random(1);
    for (int i = 0; i < 10000; ++i) {
        const double t = double(random()) / 0x1p32 * 1562;
        const auto key = size_t(t * 64);
        const double part = t * 64 - double(key);
        const double expected = (1 - part) * double(values[key]) + part * double(values[key + 1]);
        ASSERT_NEAR(at(Interpolation::Linear, times, values, 1, t)[0], expected, 1e-9);
    }
}

} // namespace scene
