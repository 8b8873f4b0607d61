#include "ui/cli/run_report.h"

#include <nlohmann/json.hpp>

namespace ui
{

const char* version()
{
    return TRICHROME_VERSION;
}

std::string shellQuoted(const std::string& argument)
{
    const std::string plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%";
    if (!argument.empty() && argument.find_first_not_of(plain) == std::string::npos) return argument;
    std::string result = "'";
    for (const char c : argument) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return result + "'";
}

image::Metadata metadataOf(const RunReport& report)
{
    image::Metadata metadata = passes::toText(report.settings);
    metadata.insert(metadata.end(), report.extra.begin(), report.extra.end());
    metadata.emplace_back("settings-hash", passes::hash(report.settings));
    metadata.emplace_back("scene", report.scene);
    metadata.emplace_back("frames-done", std::to_string(report.frames));
    metadata.emplace_back("partial", report.partial ? "yes" : "no");
    metadata.emplace_back("device", report.adapter.name);
    metadata.emplace_back("driver", report.adapter.driver);
    metadata.emplace_back("device-tuning", gpu::toText(report.adapter.tuning));
    metadata.emplace_back("version", version());
    return metadata;
}

nlohmann::ordered_json toJson(const passes::Settings& settings, const image::Metadata& extra)
{
    nlohmann::ordered_json json = passes::toJson(settings);
    for (const auto& [name, value] : extra) json[name] = value;
    return json;
}

nlohmann::ordered_json toJson(const RunReport& report)
{
    const nlohmann::ordered_json settings = toJson(report.settings, report.extra);
    const passes::RenderStats& stats = report.stats;
    return {{"scene", report.scene},
            {"method", settings["method"]},
            {"device", report.adapter.name},
            {"driver", report.adapter.driver},
            {"device_tuning", gpu::toText(report.adapter.tuning)},
            {"width", report.settings.width},
            {"height", report.settings.height},
            {"processes", report.processes},
            {"frames", report.frames},
            {"partial", report.partial},
            {"wall_seconds", report.wallSeconds},
            {"first_pixel_seconds", report.firstPixelSeconds},
            {"load_seconds", report.loadSeconds + stats.tablesSeconds},
            {"bvh_seconds", stats.bvhSeconds},
            {"compile_seconds", stats.compileSeconds},
            {"stage_ms", stats.stageMilliseconds},
            {"rays", stats.rays},
            {"rays_per_second", report.wallSeconds > 0 ? double(passes::sumOf(stats.rays)) / report.wallSeconds : 0},
            {"shifts", stats.shifts},
            {"trees_per_pixel", stats.treesPerPixel},
            {"mutations", stats.mutations},
            {"nonfinite", stats.nonFinite},
            {"mean_rgb", {report.meanRgb.r, report.meanRgb.g, report.meanRgb.b}},
            {"variant", stats.variant},
            {"bvh", {{"nodes", stats.bvh.nodes}, {"bytes", stats.bvh.bytes}, {"sah_cost", stats.bvh.sahCost}}},
            {"memory_bytes", stats.memoryBytes},
            {"bytes_per_pixel", stats.bytesPerPixel},
            {"settings", settings},
            {"settings_hash", passes::hash(report.settings)},
            {"version", version()}};
}

glm::dvec3 meanOf(const image::Image& picture)
{
    glm::dvec3 sum(0);
    for (const glm::vec3& pixel : picture.pixels) sum += glm::dvec3(pixel);
    return sum / double(std::max<size_t>(picture.pixels.size(), 1));
}

} // namespace ui
