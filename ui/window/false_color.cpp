#include "ui/window/false_color.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace ui
{

namespace
{

using Color = glm::vec3; // sRGB-encoded, 0 to 1

// Black, violet, orange, pale yellow: brightness rises all the way, so that it can be read without color, too.
Color ramp(float x)
{
    constexpr Color STOPS[] = {{0.02f, 0.02f, 0.08f},
                               {0.32f, 0.10f, 0.45f},
                               {0.72f, 0.22f, 0.38f},
                               {0.96f, 0.52f, 0.20f},
                               {0.99f, 0.96f, 0.72f}};
    constexpr int LAST = int(std::size(STOPS)) - 1;
    const float at = std::clamp(x, 0.0f, 1.0f) * LAST;
    const int stop = std::min(int(at), LAST - 1);
    return glm::mix(STOPS[stop], STOPS[stop + 1], at - float(stop));
}

constexpr Color NONE = {0.25f, 0.25f, 0.27f}; // nothing to show there
constexpr Color ALARM = {1, 0, 1};

// Of shifts, by shared::SHIFT_*.
struct OutcomeColor {
    const char* name;
    Color color;
};
constexpr OutcomeColor OUTCOMES[] = {{"done", {0.30f, 0.34f, 0.46f}},           {"ended", {0.92f, 0.30f, 0.22f}},
                                     {"joined earlier", {0.97f, 0.80f, 0.25f}}, {"not joinable", {0.70f, 0.42f, 1.00f}},
                                     {"hidden", {0.25f, 0.75f, 0.95f}},         {"dark", {0.40f, 0.82f, 0.35f}}};
static_assert(std::size(OUTCOMES) == shared::SHIFT_OUTCOMES);

// The colors of all shifts of a pixel, mixed.
Color mixOf(const passes::ShiftCounts& counts)
{
    Color sum(0);
    float tried = 0;
    for (size_t i = 0; i < counts.size(); ++i) {
        sum += float(counts[i]) * OUTCOMES[i].color;
        tried += float(counts[i]);
    }
    return tried > 0 ? sum / tried : NONE;
}

struct Cell { // the reservoirs of one pixel
    const Shot& shot;
    size_t pixel;
    const shared::Inspection& operator[](int c) const
    {
        return shot.reservoirs[size_t(c) * shot.picture.pixels.size() + pixel];
    }
};

// The number that a view shows of a pixel; empty: there is none.
std::optional<float> valueOf(const Cell& cell, FalseColor view, int c)
{
    const shared::Inspection& seen = cell[c];
    const bool holds = seen.weightSum > 0;
    switch (view) {
    case FalseColor::Confidence: return seen.confidence > 0 ? std::optional(float(seen.confidence)) : std::nullopt;
    case FalseColor::Weight: return holds ? std::optional(std::log2(seen.weight)) : std::nullopt;
    case FalseColor::Length: return holds ? std::optional(float(seen.lengthAndShifts & 0xffff)) : std::nullopt;
    case FalseColor::FailedShifts: {
        const uint32_t tried = seen.lengthAndShifts >> 16 & 0xff, failed = seen.lengthAndShifts >> 24;
        return tried > 0 ? std::optional(float(failed) / float(tried)) : std::nullopt;
    }
    default: return std::nullopt;
    }
}

bool sameTree(const shared::Inspection& a, const shared::Inspection& b)
{
    return a.seedFrame == b.seedFrame && a.seedPixel == b.seedPixel;
}

// Additive colors of the reservoirs that hold paths of one tree: all white, R and G yellow, ...; black: each its own.
Color agreement(const Cell& cell, int count)
{
    Color color(0);
    for (int c = 0; c < count; ++c) {
        if (!(cell[c].weightSum > 0)) return NONE;
        for (int d = 0; d < count; ++d)
            if (d != c && sameTree(cell[c], cell[d])) color[std::min(c, 2)] = 1;
    }
    if (count == 2) color.z = color.y; // grouped: white or black
    return color;
}

bool finite(const Cell& cell, int count)
{
    const glm::vec3& color = cell.shot.picture.pixels[cell.pixel];
    bool good = std::isfinite(color.x) && std::isfinite(color.y) && std::isfinite(color.z);
    for (int c = 0; c < count; ++c)
        good =
            good && std::isfinite(cell[c].weightSum) && std::isfinite(cell[c].target) && std::isfinite(cell[c].weight);
    return good;
}

struct Range {
    float low = 0, high = 1;
};
// Of weights: what 98 of 100 pixels lie in. Of the others: all there can be.
Range rangeOf(const Shot& shot, FalseColor view, int c)
{
    if (view == FalseColor::FailedShifts) return {0, 1};
    std::vector<float> values;
    for (size_t pixel = 0; pixel < shot.picture.pixels.size(); ++pixel)
        if (const std::optional<float> value = valueOf({shot, pixel}, view, c); value && std::isfinite(*value))
            values.push_back(*value);
    if (values.empty()) return {};
    std::ranges::sort(values);
    Range range{values.front(), values.back()};
    if (view == FalseColor::Weight)
        range = {values[values.size() / 100], values[values.size() - 1 - values.size() / 100]};
    if (view == FalseColor::Length) range.low = 0;
    if (range.high <= range.low) range.high = range.low + 1;
    return range;
}

} // namespace

int reservoirCount(const Shot& shot)
{
    return shot.picture.pixels.empty() ? 0 : int(shot.reservoirs.size() / shot.picture.pixels.size());
}

ScreenPicture falseColors(const Shot& shot, FalseColor view, int reservoir)
{
    ScreenPicture screen{.width = shot.picture.width, .height = shot.picture.height};
    screen.pixels.reserve(shot.picture.pixels.size());
    const int count = reservoirCount(shot), c = std::clamp(reservoir, 0, std::max(count - 1, 0));
    const bool numbers = view != FalseColor::Agreement && view != FalseColor::NotFinite &&
                         view != FalseColor::ShiftOutcomes && view != FalseColor::Floor;
    const Range range = numbers && count > 0 ? rangeOf(shot, view, c) : Range{};
    for (size_t pixel = 0; pixel < shot.picture.pixels.size(); ++pixel) {
        const Cell cell{shot, pixel};
        Color color = NONE;
        if (view == FalseColor::NotFinite) {
            color = finite(cell, count) ? Color(0.1f) : ALARM;
        } else if (view == FalseColor::ShiftOutcomes) {
            if (!shot.shifts.empty()) color = mixOf(shot.shifts[pixel]);
        } else if (count > 0 && view == FalseColor::Agreement) {
            color = count > 1 ? agreement(cell, count) : NONE;
        } else if (count > 0) {
            if (const std::optional<float> value = valueOf(cell, view, c))
                color = std::isfinite(*value) ? ramp((*value - range.low) / (range.high - range.low)) : ALARM;
        }
        screen.pixels.push_back({color, 1});
    }
    return screen;
}

std::vector<LegendWord> legendOf(const Shot& shot, const Floor* floor, FalseColor view, int reservoir)
{
    const auto say = [](const std::string& text) { return std::vector<LegendWord>{{text}}; };
    const int count = reservoirCount(shot), c = std::clamp(reservoir, 0, std::max(count - 1, 0));
    if (view == FalseColor::NotFinite) {
        size_t wrong = 0;
        for (size_t pixel = 0; pixel < shot.picture.pixels.size(); ++pixel) wrong += !finite({shot, pixel}, count);
        return say(fmt::format("magenta: not finite, {} pixels", wrong));
    }
    if (view == FalseColor::Floor) {
        if (!floor) return say("the color noise that stays: no estimate yet");
        if (floor->frames == 0)
            return say("black: every channel has samples of its own, so all its noise averages out");
        return say(
            fmt::format("color noise that no history removes: its deviation, shown as the picture is; from {} frames",
                        floor->frames));
    }
    if (shot.order.settings.method == passes::Method::Pt) return say("no reservoirs: choose a ReSTIR method");
    if (view == FalseColor::ShiftOutcomes) {
        if (shot.order.settings.spatial == 0) return say("no spatial shifts: spatial is 0");
        if (shot.shifts.empty()) return say("spatial shifts: not read yet");
        passes::ShiftCounts all{};
        uint64_t tried = 0;
        for (const passes::ShiftCounts& counts : shot.shifts)
            for (size_t i = 0; i < all.size(); ++i) all[i] += counts[i], tried += counts[i];
        std::vector<LegendWord> words = say("spatial shifts:");
        for (size_t i = 0; i < all.size(); ++i)
            words.push_back(
                {fmt::format("{} {:.1f}%", OUTCOMES[i].name, 100.0 * all[i] / double(std::max<uint64_t>(tried, 1))),
                 OUTCOMES[i].color});
        return words;
    }
    if (count == 0) return say("reservoirs: not read yet");
    if (view == FalseColor::Agreement) {
        if (count == 1) return say("one reservoir: nothing to agree with");
        if (count == 2) return say("white: both hold one path tree; black: each its own; gray: none");
        return {{"white: all hold one path tree; two of them:"},
                {"R G", {1, 1, 0}},
                {"R B", {1, 0, 1}},
                {"G B", {0, 1, 1}},
                {"black: each its own; gray: none"}};
    }
    const Range range = rangeOf(shot, view, c);
    switch (view) {
    case FalseColor::Confidence: return say(fmt::format("dark {:.0f}, bright {:.0f} frames", range.low, range.high));
    case FalseColor::Weight:
        return say(fmt::format("W of reservoir {}: dark {:.3g}, bright {:.3g}", c, std::exp2(range.low),
                               std::exp2(range.high)));
    case FalseColor::Length:
        return say(fmt::format("path of reservoir {}: dark 0, bright {:.0f} scattering events", c, range.high));
    default: return say(fmt::format("spatial shifts of reservoir {}: dark all done, bright all failed", c));
    }
}

} // namespace ui
