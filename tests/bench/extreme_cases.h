#pragma once
// Scenes and settings at the edges of what floating-point numbers and estimators bear, each with its truth.

#include <functional>
#include <string>
#include <vector>

#include "engine/scene/scene.h"
#include "passes/settings.h"
#include "tests/support/tile_tests.h"

namespace bench
{

struct ExtremeCase {
    std::string name, stresses;
    scene::Scene scene;
    passes::Settings settings; // frames: of one run of ReSTIR
    // The picture of the scene's first camera; by default from the float64 reference tracer.
    std::function<support::PictureEstimates(const scene::Scene&, const passes::Settings&)> truth;
    double orbit = 2;   // degrees a frame; 0: the camera rests
    uint32_t runs = 0;  // of ReSTIR; independent frames of the path tracer are cheaper, and more
    bool quick = false; // also part of the short run
};
std::vector<ExtremeCase> extremeCases();

} // namespace bench
