#pragma once
// What was done, for people and programs: the metadata of pictures and the JSON of --stats.

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "engine/gpu/gpu.h"
#include "engine/image/image.h"
#include "passes/renderer.h"
#include "passes/settings.h"

namespace ui
{

// The project's version, "0.1.0".
const char* version();

// A word of a command line for a POSIX shell.
std::string shellQuoted(const std::string& argument);

struct RunReport {
    std::string scene; // as on the command line
    passes::Settings settings;
    std::vector<std::pair<std::string, std::string>> extra; // what else decides the pixels, as motionText says it
    gpu::Adapter adapter;
    uint32_t processes = 1;       // that shared the work
    uint64_t frames = 0;          // done
    bool partial = false;         // stopped before the end
    double wallSeconds = 0;       // of rendering alone
    double firstPixelSeconds = 0; // from the command's start to the end of the first frame
    double loadSeconds = 0;       // of reading the scene and making its tables, without the BVH
    passes::RenderStats stats;
    glm::dvec3 meanRgb = {0, 0, 0};
};

// No times: equal runs give equal files.
image::Metadata metadataOf(const RunReport& report);

nlohmann::ordered_json toJson(const RunReport& report);

// The settings and, like more of them, what else decides the pixels.
nlohmann::ordered_json toJson(const passes::Settings& settings, const image::Metadata& extra);

// Every pixel counts the same.
glm::dvec3 meanOf(const image::Image& picture);

} // namespace ui
