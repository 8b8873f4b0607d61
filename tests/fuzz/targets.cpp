#include "tests/fuzz/targets.h"

#include "engine/base/check.h"
#include "engine/base/json.h"
#include "engine/gpu/pipeline_cache.h"
#include "engine/image/codecs.h"
#include "engine/scene/gltf_loader.h"
#include "engine/scene/motion.h"
#include "engine/scene/scene_tables.h"
#include "passes/camera_path.h"
#include "passes/checkpoint.h"
#include "passes/experiments/correlation_store.h"
#include "passes/experiments/race_store.h"
#include "tests/support/program.h"
#include "ui/window/window_memory.h"

#include <algorithm>
#include <cmath>

namespace fuzz
{

namespace
{

bool finite(const glm::dvec3& v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void checkCamera(const scene::Camera& camera)
{
    CHECK(finite(camera.position) && finite(camera.right) && finite(camera.up) && finite(camera.forward));
    CHECK(std::abs(glm::length(camera.forward) - 1) < 1e-6);
}

void writeInput(const std::string& file, Bytes bytes)
{
    writeFile(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

// By way of a file, alone in its folder, as everywhere.
scene::Scene load(Bytes bytes)
{
    static const TemporaryDirectory folder;
    writeInput(folder / "scene.gltf", bytes);
    return scene::loadGltf(folder / "scene.gltf");
}

void checkScene(const scene::Scene& scene)
{
    for (const glm::vec3& position : scene.positions) CHECK(finite(position));
    CHECK(!scene.cameras.empty());
    for (const scene::Camera& camera : scene.cameras) checkCamera(camera);
    const scene::SceneTables tables = scene::makeSceneTables(scene, uint64_t{1} << 27);
    CHECK(std::isfinite(tables.lengthScale) && std::isfinite(tables.radianceScale));
}

// At rest, and moved by each animation that can be played.
void gltf(Bytes bytes)
{
    scene::Scene scene = load(bytes);
    checkScene(scene);
    const size_t animations = scene.motion ? scene.motion->animations.size() : 0;
    for (uint32_t i = 0; i < std::min<size_t>(animations, 4); ++i) {
        for (const double part : {0.0, 0.4, 1.0}) {
            scene::pose(scene, std::vector{i}, part * scene.motion->animations[i].seconds);
            checkScene(scene);
        }
    }
}

void png(Bytes bytes)
{
    image::Metadata metadata;
    const auto raster = image::decodePng<uint16_t>(bytes, "x", &metadata);
    CHECK_EQ(raster.rgba.size(), size_t{raster.width} * raster.height * 4);
    const auto narrow = image::decodePng<uint8_t>(bytes, "x");
    CHECK_EQ(narrow.rgba.size(), raster.rgba.size());
}

void jpeg(Bytes bytes)
{
    const auto raster = image::decodeJpeg(bytes, "x");
    CHECK_EQ(raster.rgba.size(), size_t{raster.width} * raster.height * 4);
}

void exr(Bytes bytes)
{
    image::Metadata metadata;
    const image::Image picture = image::decodeExr(bytes, "x", &metadata);
    CHECK_EQ(picture.pixels.size(), size_t{picture.width} * picture.height);
    try {
        image::decodeExr(bytes, "x", nullptr, nullptr, "layer");
    } catch (const Error&) { // there is none
    }
}

void hdr(Bytes bytes)
{
    const image::Image picture = image::decodeHdr(bytes, "x");
    CHECK_EQ(picture.pixels.size(), size_t{picture.width} * picture.height);
}

void preset(Bytes bytes)
{
    passes::Settings settings, again;
    passes::apply(settings, parseJson(bytes));
    for (const auto& [name, value] : passes::toText(settings)) passes::set(again, name, value);
    CHECK(settings == again);
    passes::apply(again, passes::toJson(settings));
    CHECK(settings == again);
}

void cameraPath(Bytes bytes)
{
    const scene::Camera base = {.forward = {0, 0, -1}};
    const passes::CameraAt at = passes::cameraPath(parseJson(bytes), base, {1, 2, 3});
    for (const uint64_t frame : {0u, 1u, 2u, 7u, 100u, 5000u, 1000000u}) checkCamera(at(frame));
}

void pipelineCache(Bytes bytes)
{
    if (!gpu::openCache({.vendor = 1, .device = 2, .driverVersion = 3}, bytes)) throw Error("not ours");
}

void checkpoint(Bytes bytes)
{
    const passes::Checkpoint read = passes::parseCheckpoint(bytes, "x");
    size_t total = 0;
    for (const auto& [name, buffer] : read.state.buffers) total += buffer.size();
    CHECK_LE(total, bytes.size());
    passes::requireSame(read, read.identity, "x");
}

void raceStore(Bytes bytes)
{
    static const TemporaryDirectory folder;
    std::filesystem::create_directories(folder / "repeats");
    writeInput(folder / "repeats/0000.json", bytes);
    for (const passes::Repeat& repeat : passes::RaceStore(folder / "", "key", {"a", "b"}).read(1))
        for (const passes::Sample& sample : repeat.samples) CHECK_LT(sample.method, 2u);
}

void correlationBatch(Bytes bytes)
{
    const passes::CorrelationBatch batch = passes::fromBytes({bytes.begin(), bytes.end()});
    CHECK(passes::toBytes(passes::fromBytes(passes::toBytes(batch))) == passes::toBytes(batch));
}

void windowMemory(Bytes bytes)
{
    static const TemporaryDirectory folder;
    writeInput(folder / "window.json", bytes);
    const ui::WindowMemory memory = ui::recall(folder / "window.json");
    if (memory == ui::WindowMemory()) throw Error("nothing to remember");
    for (const int side : memory.size) CHECK(side > 0 && side < 1 << 20);
}

template <auto work>
bool accepts(Bytes bytes)
{
    try {
        work(bytes);
        return true;
    } catch (const Error& error) {
        CHECK(*error.what() != 0);
        return false;
    }
}

constexpr Target TARGETS[] = {
    {"gltf", accepts<gltf>},
    {"png", accepts<png>},
    {"jpeg", accepts<jpeg>},
    {"exr", accepts<exr>},
    {"hdr", accepts<hdr>},
    {"preset", accepts<preset>},
    {"camera-path", accepts<cameraPath>},
    {"pipeline-cache", accepts<pipelineCache>},
    {"checkpoint", accepts<checkpoint>},
    {"race-store", accepts<raceStore>},
    {"correlation-batch", accepts<correlationBatch>},
    {"window-memory", accepts<windowMemory>},
};

} // namespace

std::span<const Target> targets()
{
    return TARGETS;
}

} // namespace fuzz
