#include "ui/window/picture_view.h"

#include "ui/window/false_color.h"

#include <algorithm>
#include <cmath>

namespace ui
{

namespace
{

// Index of the pixel of `from` that lies where (x, y) lies in a picture of `width` x `height`.
template <class From>
size_t pixelAt(const From& from, uint32_t x, uint32_t y, uint32_t width, uint32_t height)
{
    const uint64_t column = (2 * uint64_t{x} + 1) * from.width / (2 * width);
    const uint64_t row = (2 * uint64_t{y} + 1) * from.height / (2 * height);
    return size_t(row * from.width + column);
}

ScreenPicture screenOf(const image::Image& picture)
{
    ScreenPicture screen{.width = picture.width, .height = picture.height};
    screen.pixels.reserve(picture.pixels.size());
    for (const glm::vec3& pixel : picture.pixels) screen.pixels.push_back({pixel});
    return screen;
}

ScreenPicture screenOf(const Pictures& pictures, Source source, const View& view)
{
    const ShotPointer shot = pictures.shotOf(source);
    if (shot && view.falseColor == FalseColor::Floor)
        if (const Floor* floor = pictures.floorOf(source)) return screenOf(floor->deviation);
    if (shot && view.falseColor != FalseColor::Off) return falseColors(*shot, view.falseColor, view.reservoir);
    return screenOf(*pictures.of(source));
}

void split(ScreenPicture& left, const ScreenPicture& right, float wipe)
{
    const auto first = uint32_t(std::lround(wipe * float(left.width)));
    for (uint32_t y = 0; y < left.height; ++y)
        for (uint32_t x = first; x < left.width; ++x)
            left.pixels[size_t{y} * left.width + x] = right.pixels[pixelAt(right, x, y, left.width, left.height)];
}

image::Image difference(const image::Image& left, const image::Image& right)
{
    image::Image result = left;
    for (uint32_t y = 0; y < left.height; ++y)
        for (uint32_t x = 0; x < left.width; ++x)
            result.at(x, y) = glm::abs(left.at(x, y) - right.pixels[pixelAt(right, x, y, left.width, left.height)]);
    return result;
}

} // namespace

const image::Image* Pictures::of(Source source) const
{
    if (source == Source::Reference) return reference ? &reference->picture : nullptr;
    const ShotPointer& shot = sides[source == Source::A ? A : B];
    return shot ? &shot->picture : nullptr;
}

ShotPointer Pictures::shotOf(Source source) const
{
    return source == Source::Reference ? nullptr : sides[source == Source::A ? A : B];
}

const Floor* Pictures::floorOf(Source source) const
{
    return source == Source::Reference ? nullptr : floors[source == Source::A ? A : B].get();
}

ScreenPicture compose(const Pictures& pictures, const View& view)
{
    const image::Image *left = pictures.of(view.left()), *right = pictures.of(view.right());
    if (!left && !right) return {};
    if (!left) return screenOf(pictures, view.right(), view);
    if (!right || view.layout == Layout::One) return screenOf(pictures, view.left(), view);
    if (view.layout == Layout::Difference) return screenOf(difference(*left, *right));
    ScreenPicture screen = screenOf(pictures, view.left(), view);
    split(screen, screenOf(pictures, view.right(), view), view.wipe);
    return screen;
}

} // namespace ui
