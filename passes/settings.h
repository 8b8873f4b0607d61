#pragma once
// Every knob of the renderer, once. Command line, JSON presets, the panel, image metadata and the settings hash all visit them.

#include <cstdint>
#include <string>

namespace passes {

enum class Method : uint32_t { Pt, RestirPt, RgbRestir };
enum class Shift : uint32_t { Replay, Reconnection, Hybrid };
enum class PixelFilter : uint32_t { Center, Box };

struct Settings {
    Method method = Method::Pt;
    Shift shift = Shift::Hybrid;
    uint32_t maxConfidence = 20; // M_c
    bool temporal = true;
    uint32_t spatial = 3; // K
    float spatialRadius = 20; // pixels
    uint32_t maxBounces = 5;  // scattering events
    PixelFilter pixelFilter = PixelFilter::Center;
    uint32_t width = 640;
    uint32_t height = 360;
    uint64_t seed = 0;
    bool average = true;
};

} // namespace passes
