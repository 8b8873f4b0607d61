#include "tests/support/tile_tests.h"

#include "engine/base/check.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace support
{

namespace
{

uint32_t tileCount(uint32_t pixels, uint32_t tileSize)
{
    return (pixels - 1) / tileSize + 1;
}

// Calls visit(tile index, pixel index) for every pixel of a picture.
template <class Visit>
void forEachPixel(uint32_t width, uint32_t height, uint32_t tileSize, Visit&& visit)
{
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x)
            visit(size_t{y / tileSize} * tileCount(width, tileSize) + x / tileSize, size_t{y} * width + x);
}

std::string describe(const TileEstimates& picture, size_t tile, size_t channel, double a, double b)
{
    return fmt::format("tile ({}, {}) of {}x{}, channel {}: {:.6g} against {:.6g}", tile % picture.columns,
                       tile / picture.columns, picture.columns, picture.rows, channel, a, b);
}

void checkSameShape(const TileEstimates& a, const TileEstimates& b)
{
    CHECK_EQ(a.columns, b.columns);
    CHECK_EQ(a.rows, b.rows);
    CHECK_EQ(a.tiles.size(), b.tiles.size());
    CHECK(!a.tiles.empty());
}

} // namespace

bool showsEquivalence(const statistics::Difference& difference, double margin, double level)
{
    const double reach = statistics::studentQuantile(1 - level, difference.degreesOfFreedom) * difference.standardError;
    return std::abs(difference.difference) + reach < margin;
}

TileEstimates tilesOf(const PixelEstimates& picture, uint32_t tileSize)
{
    TileEstimates result{tileCount(picture.width, tileSize), tileCount(picture.height, tileSize), {}};
    const size_t count = size_t{result.columns} * result.rows;
    result.tiles.resize(count);
    std::vector<uint32_t> pixelCount(count, 0);
    std::vector<std::array<double, 3>> spread(count, {0, 0, 0}); // of Welch and Satterthwaite
    forEachPixel(picture.width, picture.height, tileSize, [&](size_t tile, size_t pixel) {
        ++pixelCount[tile];
        for (size_t c = 0; c < 3; ++c) {
            const Estimate& e = picture.pixels[pixel][c];
            result.tiles[tile][c].mean += e.mean;
            result.tiles[tile][c].varianceOfMean += e.varianceOfMean;
            spread[tile][c] += e.varianceOfMean * e.varianceOfMean / e.degreesOfFreedom;
        }
    });
    for (size_t tile = 0; tile < count; ++tile) {
        const double n = pixelCount[tile];
        for (size_t c = 0; c < 3; ++c) {
            Estimate& e = result.tiles[tile][c];
            const double v = e.varianceOfMean;
            e.degreesOfFreedom =
                spread[tile][c] > 0 ? v * v / spread[tile][c] : std::numeric_limits<double>::infinity();
            e.mean /= n;
            e.varianceOfMean /= n * n;
        }
    }
    return result;
}

void TileRuns::add(const image::Image& run)
{
    if (tiles_.empty()) {
        width_ = run.width;
        height_ = run.height;
        tiles_.resize(size_t{tileCount(width_, tileSize_)} * tileCount(height_, tileSize_));
    }
    CHECK_EQ(run.width, width_);
    CHECK_EQ(run.height, height_);
    std::vector<glm::dvec3> sum(tiles_.size(), glm::dvec3(0));
    std::vector<uint32_t> pixelCount(tiles_.size(), 0);
    forEachPixel(width_, height_, tileSize_, [&](size_t tile, size_t pixel) {
        sum[tile] += glm::dvec3(run.pixels[pixel]);
        ++pixelCount[tile];
    });
    for (size_t tile = 0; tile < tiles_.size(); ++tile)
        for (size_t c = 0; c < 3; ++c) tiles_[tile][c].add(sum[tile][static_cast<int>(c)] / pixelCount[tile]);
}

TileEstimates TileRuns::estimates() const
{
    TileEstimates result{tileCount(width_, tileSize_), tileCount(height_, tileSize_), {}};
    for (const auto& tile : tiles_)
        result.tiles.push_back({estimateOf(tile[0]), estimateOf(tile[1]), estimateOf(tile[2])});
    return result;
}

TileVerdict tilesAgree(const TileEstimates& a, const TileEstimates& b, double familyLevel, double relativeRounding)
{
    checkSameShape(a, b);
    const double level = statistics::sidakLevel(familyLevel, 3 * a.tiles.size());
    TileVerdict verdict{true, {}};
    double worst = 2;
    for (size_t tile = 0; tile < a.tiles.size(); ++tile) {
        for (size_t c = 0; c < 3; ++c) {
            const Estimate &left = a.tiles[tile][c], &right = b.tiles[tile][c];
            const statistics::Difference d = statistics::compare(left, right, relativeRounding);
            // Written so that a NaN on either side fails.
            if (!(d.p >= level)) verdict.passes = false;
            if (d.p >= worst) continue;
            worst = d.p;
            verdict.summary = fmt::format(
                "{}, standard error {:.3g}, {:.0f} degrees of freedom, p = {:.3g} (level {:.3g})",
                describe(a, tile, c, left.mean, right.mean), d.standardError, d.degreesOfFreedom, d.p, level);
        }
    }
    return verdict;
}

TileVerdict tilesAreEquivalent(const TileEstimates& a, const TileEstimates& b, double margin, double level)
{
    checkSameShape(a, b);
    std::array<double, 3> pictureMean = {0, 0, 0};
    for (const auto& tile : b.tiles)
        for (size_t c = 0; c < 3; ++c) pictureMean[c] += tile[c].mean / static_cast<double>(b.tiles.size());

    TileVerdict verdict{true, {}};
    double worst = -1;
    for (size_t tile = 0; tile < a.tiles.size(); ++tile) {
        for (size_t c = 0; c < 3; ++c) {
            const Estimate &left = a.tiles[tile][c], &right = b.tiles[tile][c];
            const statistics::Difference d = statistics::compare(left, right, 1e-6);
            const double scale = std::max(std::abs(right.mean), std::abs(pictureMean[c]));
            if (scale == 0 && d.difference == 0 && d.standardError == 0) continue; // both are exactly black
            if (!showsEquivalence(d, margin * scale, level)) verdict.passes = false;
            const double reach = (std::abs(d.difference) + 2 * d.standardError) / scale;
            if (reach < worst) continue;
            worst = reach;
            verdict.summary = fmt::format("{}, standard error {:.3g}, margin {:.3g}",
                                          describe(a, tile, c, left.mean, right.mean), d.standardError, margin * scale);
        }
    }
    return verdict;
}

PictureEstimates pictureOf(const PixelEstimates& picture)
{
    return {tilesOf(picture), tilesOf(picture, UINT32_MAX)};
}

void PictureRuns::add(const image::Image& run)
{
    tiles_.add(run);
    whole_.add(run);
}

TileVerdict picturesAgree(const PictureEstimates& a, const PictureEstimates& b, double margin, double relativeRounding,
                          const Levels& levels)
{
    const TileVerdict tiles = tilesAgree(a.tiles, b.tiles, levels.differ, relativeRounding);
    const TileVerdict whole = tilesAreEquivalent(a.whole, b.whole, margin, levels.equivalent);
    return {tiles.passes && whole.passes, "tiles: " + tiles.summary + "\nwhole picture: " + whole.summary};
}

} // namespace support
