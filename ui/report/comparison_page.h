#pragma once
// The page of `compare`: figures, maps of the errors, the worst places, and a viewer.

#include <string>
#include <vector>

#include "engine/image/image.h"
#include "engine/image/metrics.h"

namespace ui
{

struct ComparedPicture {
    std::string file; // as on the command line
    image::Loaded loaded;
    image::Metrics metrics; // against the reference
};

// Header and rows for people: one row a picture.
std::vector<std::string> figureNames();
std::vector<std::string> figuresOf(const ComparedPicture& picture);

// Where the metadata differ: name, then the value of the reference and of each picture ("" where it has none).
std::vector<std::vector<std::string>> metadataDifferences(const std::vector<const image::Metadata*>& metadata);

// HTML. `failures`: sentences about limits that were exceeded.
std::string comparisonPage(const ComparedPicture& reference, const std::vector<ComparedPicture>& pictures,
                           const std::vector<std::string>& failures, const std::string& command);

} // namespace ui
