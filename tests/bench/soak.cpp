// Hours in minutes: one device renders scenes and settings in turn, over and over. Memory must stay flat, no handle may
// be left, no value be without a number, and every turn must make the same pixels to the bit. ./run soak MINUTES.

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include "engine/base/clock.h"
#include "engine/base/error.h"
#include "engine/base/fingerprint.h"
#include "engine/base/memory.h"
#include "engine/gpu/vulkan.h"
#include "passes/camera_path.h"
#include "passes/renderer.h"
#include "tests/bench/scenes.h"

namespace
{

struct Piece {
    const char* scene;
    double orbit; // degrees a frame
    std::vector<std::pair<const char*, const char*>> settings;
};

const Piece PIECES[] = {
    {"cornell", 0, {{"method", "pt"}, {"pixel-filter", "box"}}},
    {"hall", 0, {{"method", "rgb-restir"}, {"shift", "hybrid"}, {"max-confidence", "1048576"}, {"spatial", "0"}}},
    {"lamps", 1, {{"method", "restir-pt"}, {"shift", "reconnection"}, {"spatial", "2"}}},
    {"dim", 0, {{"method", "grouped-restir"}, {"shift", "replay"}, {"temporal", "off"}, {"spatial", "1"}}},
    {"furnace", 2, {{"method", "pt"}, {"max-bounces", "32"}}},
    {"hall", -1, {{"method", "rgb-restir"}, {"shift", "hybrid"}, {"spatial", "1"}, {"pixel-filter", "box"}}},
};

constexpr uint64_t FRAMES = 40; // of a piece

// What must not grow.
struct Usage {
    double residentBytes = 0; // after free memory went back to the system
    double heapBytes = 0;     // in use
    size_t files = 0;         // open
    size_t threads = 0;
    size_t commandBuffers = 0, queryPages = 0, layouts = 0, parked = 0;
    uint64_t deviceBytes = 0;
};

size_t entriesOf(const char* folder)
{
    size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) ++count;
    return count;
}

Usage usageOf(gpu::Device& device)
{
    // Mesa takes pipelines apart at the next submission (lavapipe's queue), 40 MB of them.
    device.queue().wait(device.queue().submit(device.createCommandEncoder("nothing")));
    memory::giveBackFreed();
    std::ifstream statm("/proc/self/statm");
    double size = 0, resident = 0;
    statm >> size >> resident;
    const gpu::DeviceState& state = device.state();
    return {.residentBytes = resident * double(sysconf(_SC_PAGESIZE)),
            .heapBytes = double(memory::heapBytes()),
            .files = entriesOf("/proc/self/fd"),
            .threads = entriesOf("/proc/self/task"),
            .commandBuffers = state.freeCommandBuffers.size(),
            .queryPages = state.freeQueryPages.size(),
            .layouts = state.setLayouts.size(),
            .parked = state.parked.size(),
            .deviceBytes = device.allocatedBytes()};
}

// Renders one piece, with a change of settings and a restart from a saved state on the way. Returns a fingerprint of
// the last frame and the mean. Adds to `unfinite`.
uint64_t render(gpu::Device& device, const Piece& piece, uint64_t& unfinite)
{
    passes::Settings settings;
    passes::set(settings, "size", "64x36");
    for (const auto& [name, value] : piece.settings) passes::set(settings, name, value);
    const scene::Scene scene = loadScene(piece.scene);
    const passes::CameraAt cameraAt = passes::cameraOrbit(scene.cameras.at(0), piece.orbit);
    passes::Renderer renderer(device, scene, settings);
    const auto renderUntil = [&](uint64_t frames) {
        while (renderer.frameCount() < frames) {
            renderer.setCamera(cameraAt(renderer.frameCount()));
            renderer.renderFrame();
        }
    };
    renderUntil(FRAMES / 4);
    const passes::RendererState state = renderer.save();
    renderUntil(FRAMES / 2);
    renderer.restore(state);
    settings.maxConfidence = 7;
    renderer.apply(settings);
    renderUntil(FRAMES);
    for (const auto& [stage, count] : renderer.stats().nonFinite) unfinite += count;
    const image::Image last = renderer.read(passes::LAST_FRAME), mean = renderer.read(passes::MEAN);
    return fingerprint(std::as_bytes(std::span(mean.pixels)), fingerprint(std::as_bytes(std::span(last.pixels))));
}

int soak(double minutes, const std::string& deviceName)
{
    gpu::Device device = gpu::Device::create({.adapter = deviceName});
    fmt::print("On {}, for {} minutes\n", device.adapter().name, minutes);
    fmt::print("turn minutes   frames  resident-MiB  heap-MiB  files threads buffers pages layouts parked unfinite "
               "device-MiB\n");
    const auto start = Clock::now();
    const auto minutesPast = [&] { return secondsSince(start) / 60; };
    constexpr size_t WARM = 3; // turns until caches are full
    std::vector<Usage> turns;
    std::vector<uint64_t> pictures;
    uint64_t unfinite = 0, different = 0;
    while (turns.size() < WARM + 2 || minutesPast() < minutes) {
        std::vector<uint64_t> now;
        for (const Piece& piece : PIECES) now.push_back(render(device, piece, unfinite));
        if (pictures.empty()) pictures = now;
        for (size_t i = 0; i < now.size(); ++i) different += now[i] != pictures[i];
        const Usage u = turns.emplace_back(usageOf(device));
        fmt::print("{:4} {:7.2f} {:8} {:13.2f} {:9.2f} {:6} {:7} {:7} {:5} {:7} {:6} {:8} {:9.3f}\n", turns.size(),
                   minutesPast(), turns.size() * std::size(PIECES) * FRAMES, u.residentBytes / (1 << 20),
                   u.heapBytes / (1 << 20), u.files, u.threads, u.commandBuffers, u.queryPages, u.layouts, u.parked,
                   unfinite, double(u.deviceBytes) / (1 << 20));
        std::fflush(stdout);
    }

    const Usage &early = turns[WARM - 1], &late = turns.back();
    const double growth = 100 * (late.residentBytes / early.residentBytes - 1);
    const double heapGrowth = 100 * (late.heapBytes / early.heapBytes - 1);
    const bool handles = early.files == late.files && early.threads == late.threads &&
                         early.commandBuffers == late.commandBuffers && early.queryPages == late.queryPages &&
                         early.layouts == late.layouts && late.parked == 0 &&
                         late.deviceBytes == gpu::StagingRing::BYTES; // of the queue, for good
    fmt::print(
        "resident memory grew by {:.2f}%, the heap by {:.2f}%, handles {}, {} pictures differ, {} values are not "
        "finite\n",
        growth, heapGrowth, handles ? "stay" : "GROW", different, unfinite);
    return growth <= 1 && heapGrowth <= 1 && handles && different == 0 && unfinite == 0 ? 0 : 1;
}

} // namespace

int main(int argc, char** argv)
{
    // glibc keeps freed memory by thread, in pages that hold little, and more of them with time. What is counted here
    // is what is in use. GLIBC_TUNABLES= measures as usual.
    constexpr const char* TUNABLES = "GLIBC_TUNABLES";
    if (!std::getenv(TUNABLES)) {
        setenv(TUNABLES, "glibc.malloc.tcache_count=0:glibc.malloc.arena_max=1", 1);
        execv("/proc/self/exe", argv);
    }
    CLI::App app("Renders in turns and watches memory, handles and pixels; exit code 1 when one of them moves.");
    double minutes = 15;
    std::string device;
    app.add_option("--minutes", minutes, "At least five turns, however long they take.");
    app.add_option("--device", device, "Name or index.");
    CLI11_PARSE(app, argc, argv);
    try {
        return soak(minutes, device);
    } catch (const Error& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
}
