#pragma once
// The page of `correlate`, and the files beside it.

#include <filesystem>

#include "passes/experiments/correlation.h"
#include "ui/report/page.h"

namespace ui
{

// Writes into the directory: index.html, correlate.csv, autocovariance.svg (with gnuplot), and for each method with a
// plateau color-noise-floor-METHOD.exr and .png. Throws Error.
void writeCorrelation(const std::filesystem::path& directory, const passes::Correlation& correlation,
                      const Provenance& provenance);

// What the figures say, in sentences.
std::vector<std::string> verdictsOf(const passes::Correlation& correlation);

} // namespace ui
