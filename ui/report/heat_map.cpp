#include "ui/report/heat_map.h"

#include "engine/image/codecs.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace ui
{

namespace
{

using Stops = std::vector<std::array<int, 3>>; // sRGB, evenly spaced, interpolated between

const Stops& stopsOf(ColorMap map)
{
    static const Stops MAGMA = {{0, 0, 4},      {28, 16, 68},   {79, 18, 123},   {129, 37, 129}, {181, 54, 122},
                                {229, 80, 100}, {251, 135, 97}, {254, 194, 135}, {252, 253, 191}};
    static const Stops BLUE_RED = {{16, 52, 166}, {120, 160, 230}, {247, 247, 247}, {232, 120, 96}, {160, 8, 24}};
    return map == ColorMap::Magma ? MAGMA : BLUE_RED;
}

} // namespace

std::vector<std::byte> heatMapPng(const image::Plane& plane, double low, double high, ColorMap map)
{
    const Stops& stops = stopsOf(map);
    std::vector<uint8_t> rgb;
    rgb.reserve(3 * plane.values.size());
    for (const double value : plane.values) {
        const double at = std::clamp((value - low) / (high - low), 0.0, 1.0) * double(stops.size() - 1);
        const size_t i = std::min(size_t(at), stops.size() - 2);
        for (size_t c = 0; c < 3; ++c)
            rgb.push_back(uint8_t(std::lround(std::lerp(stops[i][c], stops[i + 1][c], at - double(i)))));
    }
    return image::encodePng(uint32_t(plane.width), uint32_t(plane.height), rgb, {});
}

std::string gradientOf(ColorMap map)
{
    std::string colors;
    for (const auto& [r, g, b] : stopsOf(map))
        colors += fmt::format("{}rgb({},{},{})", colors.empty() ? "" : ",", r, g, b);
    return colors;
}

} // namespace ui
