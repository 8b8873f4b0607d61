#include "tests/fuzz/targets.h"

#include "engine/base/files.h"
#include "engine/gpu/pipeline_cache.h"
#include "engine/image/codecs.h"
#include "passes/checkpoint.h"
#include "passes/experiments/correlation_store.h"
#include "passes/experiments/race_store.h"
#include "tests/support/program.h"
#include "tests/support/tiny_gltf.h"
#include "ui/window/window_memory.h"

#include <nlohmann/json.hpp>

namespace fuzz
{

namespace
{

using File = std::vector<std::byte>;

File bytesOf(const std::string& text)
{
    const Bytes bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

// glTF 2.0, 4.4: header, one chunk of JSON.
File glb(std::string text)
{
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const uint32_t size = uint32_t(text.size()), words[] = {0x46546c67, 2, size + 20, size, 0x4e4f534a};
    return bytesOf(std::string(reinterpret_cast<const char*>(words), sizeof(words)) + text);
}

std::vector<File> gltf()
{
    TinyGltf file;
    file.attributes()["TEXCOORD_0"] = file.accessor<float>({0, 0, 1, 0, 0, 1}, "VEC2");
    file.attributes()["COLOR_0"] = file.accessor<uint8_t>({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}, "VEC4", true);
    file.primitive()["indices"] = file.accessor<uint16_t>({0, 1, 2}, "SCALAR");
    file.material()["pbrMetallicRoughness"]["baseColorTexture"]["index"] = file.texture({0xff0000, 0xff00, 0xff, 0});
    file.material()["emissiveFactor"] = {1, 1, 1};
    file.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
    file.json["nodes"].push_back({{"camera", 0}, {"rotation", {0, 0, 0, 1}}});
    file.json["scenes"][0]["nodes"].push_back(1);
    const std::string still = file.text();

    file.primitive()["targets"] = {{{"POSITION", file.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 0}, "VEC3")}}};
    file.attributes()["JOINTS_0"] = file.accessor<uint8_t>({0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, "VEC4");
    file.attributes()["WEIGHTS_0"] = file.accessor<uint8_t>({255, 0, 0, 0, 255, 0, 0, 0, 128, 127, 0, 0}, "VEC4", true);
    file.json["skins"] = {{{"joints", {1, 2}}}};
    file.json["nodes"][0]["skin"] = 0;
    file.json["nodes"].push_back({{"translation", {0, 0, 1}}});
    file.json["scenes"][0]["nodes"].push_back(2);
    file.animate({{"node", 0}, {"path", "weights"}}, {0, 1}, {0, 1}, "SCALAR");
    file.animate({{"node", 1}, {"path", "rotation"}}, {0, 1}, {0, 0, 0, 1, 0, 1, 0, 0}, "VEC4");
    file.animate({{"node", 2}, {"path", "scale"}}, {0, 2}, std::vector<float>(18, 1), "VEC3", "CUBICSPLINE");
    file.animatePointer("/materials/0/emissiveFactor", {0, 1}, {0, 0, 0, 1, 2, 3}, "VEC3", "STEP");
    file.animatePointer("/nodes/0/extensions/KHR_node_visibility/visible", {0, 0.5f}, {0, 1}, "SCALAR", "STEP");
    return {bytesOf(still), glb(still), bytesOf(file.text())};
}

image::Image picture()
{
    image::Image picture{.width = 3, .height = 2};
    for (int i = 0; i < 6; ++i) picture.pixels.emplace_back(float(i), 0.5f, -1e-3f);
    return picture;
}

std::vector<File> hdr()
{
    return {bytesOf(std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 2\n") + std::string(16, 'x'))};
}

std::vector<File> cameraPath()
{
    return {bytesOf(R"({"keyframes": [{"frame": 0, "position": [0, 0, 1], "target": [0, 0, 0]},
        {"frame": 9, "position": [1, 0, 1], "target": [0, 0, 0], "up": [0, 1, 0.1], "yfov": 40}]})")};
}

std::vector<File> checkpoint()
{
    const TemporaryDirectory folder;
    passes::write(folder / "x", {.identity = {{"version", "1"}},
                                 .seconds = 1.5,
                                 .state = {.frames = 3, .buffers = {{"Film", bytesOf("abcdefgh")}}}});
    return {files::read(folder / "x")};
}

std::vector<File> raceStore()
{
    const TemporaryDirectory folder;
    passes::Repeat repeat{.samples = {{.method = 1, .average = true, .frames = 3}}};
    passes::RaceStore(folder / "", "key", {"a", "b"}).write(1, repeat);
    return {files::read(folder / "repeats/0001.json")};
}

std::vector<File> correlationBatch()
{
    const statistics::BatchValue value = {.value = 0.1, .without = {0.25, 1e300, 3}};
    return {passes::toBytes({.method = "pt",
                             .index = 7,
                             .runs = 3,
                             .law = passes::FrameLaw{.variance = value, .plateau = value, .floor = {{1, 2, 3}}},
                             .points = {{.frame = 2,
                                         .pixels = 9,
                                         .autocovariance = value,
                                         .variance = value,
                                         .film = value,
                                         .lags = {{2, value}}}}})};
}

std::vector<File> windowMemory()
{
    const TemporaryDirectory folder;
    ui::WindowMemory memory{.size = {800, 600}, .layout = "[Window]", .recent = {"hall"}};
    memory.bookmarks["hall"][2] = ui::Pose{};
    ui::keep(memory, folder / "window.json");
    return {files::read(folder / "window.json")};
}

} // namespace

std::vector<File> seeds(const std::string& target)
{
    if (target == "gltf") return gltf();
    if (target == "png") return {image::encodePng(2, 1, std::vector<uint8_t>{1, 2, 3, 4, 5, 6}, {{"seed", "0"}})};
    if (target == "exr")
        return {image::encodeExr(picture(), {{"seed", "0"}}),
                image::encodeExr(picture(), {}, std::vector<image::Layer>{{"layer", "RGB", picture()}})};
    if (target == "hdr") return hdr();
    if (target == "preset") return {bytesOf(passes::toJson(passes::Settings{}).dump())};
    if (target == "camera-path") return cameraPath();
    if (target == "pipeline-cache")
        return {gpu::sealCache({.vendor = 1, .device = 2, .driverVersion = 3}, bytesOf("blob"))};
    if (target == "checkpoint") return checkpoint();
    if (target == "race-store") return raceStore();
    if (target == "correlation-batch") return correlationBatch();
    if (target == "window-memory") return windowMemory();
    return {}; // jpeg: there is no encoder here; tests/fuzz/corpus/jpeg has some
}

} // namespace fuzz
