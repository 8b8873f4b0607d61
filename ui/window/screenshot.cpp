#include "ui/window/screenshot.h"

#include "engine/base/json.h"
#include "ui/cli/output_file.h"
#include "ui/cli/run_report.h"

#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace ui
{

namespace
{

std::string freeName()
{
    for (int i = 1;; ++i) {
        std::string name = fmt::format("trichrome-{}", i);
        if (!std::filesystem::exists(name + ".json") && !std::filesystem::exists(name + ".png")) return name;
    }
}

} // namespace

std::string takeScreenshot(const Shot& shot)
{
    const std::string name = freeName();
    const SceneSource& scene = shot.order.scene;
    RunReport report{.scene = scene.name,
                     .settings = shot.order.settings,
                     .adapter = shot.adapter,
                     .frames = shot.frames,
                     .stats = shot.stats};
    report.settings.frames = uint32_t(shot.frames);
    report.settings.seconds = 0;
    report.settings.average = !shot.single;
    report.extra = poseText(shot);
    std::string camera;
    if (shot.order.pose) {
        camera = name + ".camera.json";
        writeText(camera, jsonText(toCameraPath(*shot.order.pose), 2) + "\n");
        report.extra.emplace_back("camera-path", camera);
    }
    writeText(name + ".json", jsonText(passes::toJson(report.settings), 2) + "\n");
    image::write(name + ".png", shot.picture, metadataOf(report));
    image::write(name + ".exr", shot.picture, metadataOf(report));

    std::string line = fmt::format("trichrome render {} -o {}-again.exr --preset {}.json --device {}",
                                   shellQuoted(scene.name), name, name, shellQuoted(shot.adapter.name));
    if (!scene.assetRoot.empty()) line += " --asset-root " + shellQuoted(scene.assetRoot);
    for (const auto& [option, value] : poseText(shot)) line += " --" + option + " " + shellQuoted(value);
    if (!camera.empty())
        line += fmt::format(" --camera-path {} --average {}", camera, report.settings.average ? "on" : "off");
    return line;
}

} // namespace ui
