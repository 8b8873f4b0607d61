#pragma once
// Do two renderers make the same picture? Asked tile by tile (8x8 pixels, each channel), so that opposite errors in
// different places cannot cancel.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "engine/base/statistics.h"
#include "engine/image/image.h"

namespace support
{

using statistics::Estimate;
using statistics::Moments;

constexpr uint32_t TILE_SIZE = 8;        // pixels
constexpr double DEVICE_ROUNDING = 5e-5; // relative: vertex colors are in half precision there

// Two one-sided tests: true when |a - b| < margin is shown at the level (its negation is rejected).
bool showsEquivalence(const statistics::Difference& difference, double margin, double level);

// What is known of the mean of every tile, rows of tiles from the top.
struct TileEstimates {
    uint32_t columns = 0;
    uint32_t rows = 0;
    std::vector<std::array<Estimate, 3>> tiles;
};

// A picture whose pixels were sampled independently of each other.
struct PixelEstimates {
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<std::array<Estimate, 3>> pixels; // row 0 at the top
};
TileEstimates tilesOf(const PixelEstimates& picture, uint32_t tileSize = TILE_SIZE);

// From whole pictures of independent runs: makes no assumption on how pixels within a run depend on each other.
class TileRuns
{
  public:
    explicit TileRuns(uint32_t tileSize = TILE_SIZE) : tileSize_(tileSize) {}
    void add(const image::Image& run);
    TileEstimates estimates() const; // at least two runs
    const std::vector<std::array<Moments, 3>>& moments() const { return tiles_; }

  private:
    uint32_t tileSize_;
    uint32_t width_ = 0, height_ = 0;
    std::vector<std::array<Moments, 3>> tiles_;
};

// The verdict of a test over all tiles and channels.
struct TileVerdict {
    bool passes = false;
    std::string summary; // for the person: worst tile, its means, z or margin
};

// Rejects (passes = false) when some tile differs: Welch's t of each tile and channel, at the level that makes a false
// rejection anywhere have the probability `familyLevel` (Sidak). Rounding: see compare(); 1e-6 is that of float32.
TileVerdict tilesAgree(const TileEstimates& a, const TileEstimates& b, double familyLevel = 1e-3,
                       double relativeRounding = 1e-6);

// Passes when every tile and channel is shown to differ by less than `margin` times the larger of its own mean and the
// mean of the picture in that channel, by two one-sided tests at `level` each (an intersection-union test: the
// probability of passing with a difference beyond the margin anywhere is at most `level`). A noisy comparison fails.
TileVerdict tilesAreEquivalent(const TileEstimates& a, const TileEstimates& b, double margin = 0.01,
                               double level = 0.05);

// A picture by tiles, which show where it is wrong, and as a whole, which shows small errors of all of it.
struct PictureEstimates {
    TileEstimates tiles;
    TileEstimates whole; // one tile
};
PictureEstimates pictureOf(const PixelEstimates& picture);

class PictureRuns
{
  public:
    void add(const image::Image& run);
    PictureEstimates estimates() const { return {tiles_.estimates(), whole_.estimates()}; }

  private:
    TileRuns tiles_, whole_{UINT32_MAX};
};

// How often a test may be wrong: where two pictures are the same, and where they are not.
struct Levels {
    double differ = 1e-3;     // of tilesAgree()
    double equivalent = 0.05; // of tilesAreEquivalent()
};

// tilesAgree(), and the means of the whole pictures are equivalent within `margin`, so that an error of it would show.
TileVerdict picturesAgree(const PictureEstimates& a, const PictureEstimates& b, double margin = 0.01,
                          double relativeRounding = DEVICE_ROUNDING, const Levels& levels = {});

} // namespace support
