#include "engine/scene/animation.h"

#include <algorithm>
#include <cmath>

#include "engine/base/check.h"

namespace scene
{

namespace
{

constexpr bool inOrder()
{
    for (size_t i = 0; i < PROPERTIES.size(); ++i)
        if (PROPERTIES[i].property != static_cast<Property>(i)) return false;
    return true;
}
static_assert(inOrder());

void normalize(std::span<double> value)
{
    double squared = 0;
    for (const double x : value) squared += x * x;
    const double length = std::sqrt(squared);
    if (length > 0) {
        for (double& x : value) x /= length;
    } else { // between opposite tangents: no direction is better than another
        std::ranges::fill(value, 0);
        value.back() = 1;
    }
}

// glTF 2.0, appendix C.4. The ends are made unit first: files round them.
void slerp(std::span<const float> from, std::span<const float> to, double t, std::span<double> value)
{
    std::array<double, 4> a = {}, b = {};
    std::ranges::copy(from, a.begin());
    std::ranges::copy(to, b.begin());
    normalize(a);
    normalize(b);
    double cosine = 0;
    for (size_t c = 0; c < 4; ++c) cosine += a[c] * b[c];
    const double sign = cosine < 0 ? -1 : 1; // the shorter way
    const double angle = std::acos(std::min(std::abs(cosine), 1.0));
    double weightA = 1 - t, weightB = t; // nearly parallel: the sines have no digits left
    if (angle > 1e-6) {
        weightA = std::sin(angle * (1 - t)) / std::sin(angle);
        weightB = std::sin(angle * t) / std::sin(angle);
    }
    for (size_t c = 0; c < 4; ++c) value[c] = weightA * a[c] + sign * weightB * b[c];
}

// glTF 2.0, appendix C.5: Hermite, with tangents per second; `span` is the time between the keys.
void cubicSpline(std::span<const float> keys, double span, double t, std::span<double> value)
{
    const size_t width = value.size();
    const double t2 = t * t, t3 = t2 * t;
    for (size_t c = 0; c < width; ++c) {
        const double from = keys[width + c], out = keys[2 * width + c], in = keys[3 * width + c],
                     to = keys[4 * width + c];
        value[c] = (2 * t3 - 3 * t2 + 1) * from + span * (t3 - 2 * t2 + t) * out + (3 * t2 - 2 * t3) * to +
                   span * (t3 - t2) * in;
    }
}

} // namespace

void interpolate(Interpolation interpolation, bool rotation, std::span<const float> times,
                 std::span<const float> values, double seconds, std::span<double> value)
{
    const size_t width = value.size();
    const bool cubic = interpolation == Interpolation::CubicSpline;
    CHECK(!times.empty());
    CHECK_EQ(values.size(), times.size() * width * (cubic ? 3 : 1));

    const auto next = std::upper_bound(times.begin(), times.end(), seconds); // the first key after now
    const auto after = static_cast<size_t>(next - times.begin());
    const size_t key = after == 0 ? 0 : after - 1;
    const bool held = after == 0 || after == times.size() || interpolation == Interpolation::Step;
    if (held) {
        std::ranges::copy(values.subspan((cubic ? 3 * key + 1 : key) * width, width), value.begin());
    } else {
        const double span = double(times[after]) - double(times[key]);
        const double t = (seconds - double(times[key])) / span;
        if (cubic) {
            cubicSpline(values.subspan(3 * key * width, 6 * width), span, t, value);
        } else if (rotation) {
            slerp(values.subspan(key * width, width), values.subspan(after * width, width), t, value);
        } else {
            for (size_t c = 0; c < width; ++c)
                value[c] = (1 - t) * double(values[key * width + c]) + t * double(values[after * width + c]);
        }
    }
    if (rotation) normalize(value);
}

} // namespace scene
