#include "ui/window/screenshot.h"

#include "engine/base/files.h"
#include "engine/base/json.h"
#include "ui/cli/output_file.h"
#include "ui/cli/run_report.h"

#include <algorithm>
#include <filesystem>
#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace ui
{

namespace
{

std::string freeName(const std::string& stem, std::initializer_list<const char*> endings)
{
    for (int i = 1;; ++i) {
        std::string name = fmt::format("{}-{}", stem, i);
        if (std::ranges::none_of(endings, [&](const char* ending) { return std::filesystem::exists(name + ending); }))
            return name;
    }
}

void writeJson(const std::string& file, const nlohmann::ordered_json& json)
{
    writeText(file, jsonText(json, 2) + "\n");
}

// The same scene on the same device; `pose`: more options.
std::string renderLine(const Shot& shot, const std::vector<std::pair<std::string, std::string>>& pose)
{
    const SceneSource& scene = shot.order.scene;
    std::string line =
        fmt::format("trichrome render {} --device {}", shellQuoted(scene.name), shellQuoted(shot.adapter.name));
    if (!scene.assetRoot.empty()) line += " --asset-root " + shellQuoted(scene.assetRoot);
    for (const auto& [option, value] : pose) line += " --" + option + " " + shellQuoted(value);
    return line;
}

} // namespace

std::string takeScreenshot(const Shot& shot)
{
    const std::string name = freeName("trichrome", {".json", ".png"});
    RunReport report{.scene = shot.order.scene.name,
                     .settings = shot.order.settings,
                     .adapter = shot.adapter,
                     .frames = shot.frames,
                     .stats = shot.stats};
    report.settings.frames = uint32_t(shot.frames);
    report.settings.seconds = 0;
    report.settings.average = !shot.single;
    report.extra = poseText(shot);
    std::string line = renderLine(shot, report.extra) + fmt::format(" -o {0}-again.exr --preset {0}.json", name);
    if (shot.order.pose || followsPath(shot.order)) {
        const std::string camera = name + ".camera.json";
        writeJson(camera,
                  shot.order.pose ? toCameraPath(*shot.order.pose) : pathFrom(shot.order.path, shot.firstFrame));
        report.extra.emplace_back("camera-path", camera);
        line += fmt::format(" --camera-path {} --average {}", camera, report.settings.average ? "on" : "off");
    }
    writeJson(name + ".json", passes::toJson(report.settings));
    image::write(name + ".png", shot.picture, metadataOf(report));
    image::write(name + ".exr", shot.picture, metadataOf(report));
    return line;
}

std::string prepareFilm(const Shot& shot, const Order& order, uint64_t frames, std::optional<double> start)
{
    const std::string folder = freeName("trichrome-film", {""});
    files::createFolder(folder);
    passes::Settings settings = shot.order.settings;
    passes::copy(settings, order.settings, {passes::Role::View}); // in full size
    settings.frames = uint32_t(frames);
    settings.seconds = 0;
    settings.average = false;
    writeJson(folder + "/settings.json", passes::toJson(settings));

    SceneSource scene = order.scene;
    scene.time = start;
    std::vector<std::pair<std::string, std::string>> pose = scene.toText();
    if (start) std::ranges::move(order.play.toText(), std::back_inserter(pose));
    std::string line = renderLine(shot, pose);
    if (order.path || order.pose) {
        writeJson(folder + "/camera.json", order.path ? pathFrom(order.path, 0) : toCameraPath(*order.pose));
        line += fmt::format(" --camera-path {}/camera.json", folder);
    }
    return line + fmt::format(" --sequence 0:{0} -o {1}/%04d.png --preset {1}/settings.json", frames, folder);
}

std::string savePath(const CameraKeys& keys)
{
    const std::string name = freeName("trichrome-path", {".json"}) + ".json";
    writeJson(name, pathFrom(keys, 0));
    return name;
}

} // namespace ui
