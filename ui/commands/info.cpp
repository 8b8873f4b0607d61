// info [SCENE]: devices; the built-in scenes; or what a scene holds and what is compiled for it.

#include "engine/base/clock.h"
#include "engine/base/json.h"
#include "engine/scene/motion.h"
#include "engine/scene/procedural.h"
#include "engine/scene/scene_tables.h"
#include "passes/experiments/advice.h"
#include "passes/renderer.h"
#include "passes/variant.h"
#include "ui/cli/device_options.h"
#include "ui/cli/interrupt.h"
#include "ui/cli/output_file.h"
#include "ui/cli/progress.h"
#include "ui/cli/run_report.h"
#include "ui/cli/scene_source.h"
#include "ui/cli/settings_options.h"
#include "ui/cli/usage_error.h"
#include "ui/commands/commands.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>

namespace ui
{

namespace
{

using Json = nlohmann::ordered_json;

std::string megabytes(uint64_t bytes)
{
    return fmt::format("{:.1f} MiB", double(bytes) / 1048576);
}

struct InfoCommand {
    SceneSource scene;
    std::string json;
    bool scenes = false, advises = false, quiet = false;
    DeviceOptions device;
    SettingsOptions settings;

    int run() const;
};

Json tuningJson(const gpu::Tuning& tuning)
{
    Json choices = Json::object();
    for (const gpu::TuningText& text : gpu::describe(tuning)) choices[text.name] = text.value;
    return choices;
}

Json devicesJson(const std::string& tuning)
{
    Json list = Json::array();
    for (const gpu::Adapter& adapter : gpu::enumerateAdapters(tuning)) {
        const gpu::Limits& limits = adapter.limits;
        list.push_back({{"index", adapter.index},
                        {"name", adapter.name},
                        {"kind", adapter.kind},
                        {"driver", adapter.driver},
                        {"api_version", adapter.apiVersion},
                        {"limits",
                         {{"storage_binding_bytes", limits.storageBindingBytes},
                          {"table_bytes", limits.tableBytes},
                          {"uniform_binding_bytes", limits.uniformBindingBytes},
                          {"storage_buffers_per_stage", limits.storageBuffersPerStage},
                          {"workgroup_invocations", limits.workgroupInvocations},
                          {"workgroup_bytes", limits.workgroupBytes},
                          {"memory_bytes", limits.memoryBytes},
                          {"timestamps", limits.timestamps}}},
                        {"tuning", tuningJson(adapter.tuning)}});
    }
    return list;
}

void printDevices(const Json& devices)
{
    if (devices.empty()) std::puts("No Vulkan device: the loader found no driver (Debian: mesa-vulkan-drivers).");
    for (const Json& device : devices) {
        fmt::print("Device {}: {} ({}; {}; Vulkan {})\n", device["index"].get<uint32_t>(),
                   device["name"].get<std::string>(), device["kind"].get<std::string>(),
                   device["driver"].get<std::string>(), device["api_version"].get<std::string>());
        for (const auto& [name, value] : device["limits"].items()) fmt::print("    {:<28}{}\n", name, jsonText(value));
        std::puts("    Chosen by the device's class, or by --device-tuning:");
        for (const auto& [name, value] : device["tuning"].items())
            fmt::print("    {:<28}{}\n", name, value.get<std::string>());
    }
}

Json scenesJson()
{
    Json list = Json::array();
    for (const scene::BuiltInScene& builtIn : scene::builtInScenes())
        list.push_back({{"name", builtIn.name}, {"description", builtIn.description}});
    return list;
}

// Name, what it is for, and whether it is in: scene features and settings alike.
Json variantJson(const std::map<std::string, std::string>& variant)
{
    Json list = Json::object();
    const std::map<std::string, std::string> meanings = passes::variantMeanings();
    for (const auto& [name, value] : variant) list[name] = {{"value", value}, {"meaning", meanings.at(name)}};
    return list;
}

// What an animation moves: how many objects by property.
Json animationJson(const scene::Motion& motion, const scene::Animation& animation)
{
    std::map<scene::Property, uint64_t> counts;
    uint64_t keys = 0;
    for (const scene::Channel& channel : animation.channels) {
        ++counts[channel.property];
        keys += motion.numbers[channel.times].size();
    }
    Json moves = Json::object();
    for (const auto& [property, count] : counts) moves[scene::factsOf(property).words] = count;
    Json json = {{"name", animation.name}, {"seconds", animation.seconds}, {"keys", keys}, {"moves", moves}};
    if (!animation.fault.empty()) json["fault"] = animation.fault;
    return json;
}

// Meshes that keep their shape, those that a skin or morph targets deform, and what that takes on the host.
Json motionJson(const scene::Motion& motion)
{
    Json animations = Json::array();
    for (const scene::Animation& animation : motion.animations) animations.push_back(animationJson(motion, animation));
    uint64_t rigid = 0, triangles = 0, joints = 0, targets = 0;
    for (const scene::Motion::Part& part : motion.parts) {
        const scene::Mesh& mesh = motion.meshes[part.mesh];
        triangles += mesh.triangles.size();
        rigid += part.skin == scene::NONE && mesh.vertices.targets.empty();
    }
    for (const scene::Motion::Skin& skin : motion.skins) joints += skin.joints.size();
    for (const scene::Mesh& mesh : motion.meshes) targets += mesh.vertices.targets.size();
    return {{"animations", animations},
            {"rigid_parts", rigid},
            {"instances", motion.instances.size()},
            {"deforming_parts", motion.parts.size() - rigid},
            {"triangles", triangles},
            {"nodes", motion.nodes.size()},
            {"skins", motion.skins.size()},
            {"joints", joints},
            {"morph_targets", targets},
            {"lights", motion.lights.size()},
            {"cameras", motion.cameras.size()},
            {"materials", motion.paints.size()},
            {"host_bytes", motion.bytes()}};
}

// What a frame takes on the host while the scene plays (--fps), in the middle of its longest animation: to pose it, and
// to make tables of it, which then go to the device. Null: nothing can play.
Json playingJson(scene::Scene world, uint64_t maxTableBytes)
{
    std::vector<uint32_t> playable;
    double length = 0;
    for (uint32_t i = 0; world.motion && i < world.motion->animations.size(); ++i) {
        const scene::Animation& animation = world.motion->animations[i];
        if (!animation.fault.empty()) continue;
        playable.push_back(i);
        length = std::max(length, animation.seconds);
    }
    if (playable.empty()) return nullptr;
    scene::MovingTables poses(world, maxTableBytes);
    const auto start = Clock::now();
    scene::pose(world, playable, length / 2);
    const double posed = secondsSince(start);
    const scene::SceneTables& tables = poses.at(world);
    const double all = secondsSince(start);
    const auto bytes = [](uint64_t rows) { return rows * sizeof(glm::uvec4); };
    const scene::TableSizes& most = poses.most();
    const scene::TableChanges& changes = poses.changes();
    const auto rows = [](const std::vector<scene::RowRange>& ranges) {
        uint64_t sum = 0;
        for (const scene::RowRange& range : ranges) sum += range.end - range.first;
        return sum;
    };
    return {
        {"pose_seconds", posed},
        {"tables_seconds", all - posed},
        {"upload_bytes", bytes(rows(changes.tree.nodes) + rows(changes.tree.triangles) + rows(changes.attributes) +
                               tables.sceneData.size() + tables.places.nodes.size() + tables.places.records.size())},
        {"worlds_bytes", 2 * bytes(uint64_t{most.nodes} + most.placeNodes + most.triangles + most.placeRecords +
                                   most.attributes + most.sceneData)}};
}

// Meshes that are stored once, and what copies of them would be. Null: there are none.
Json instancesJson(const scene::Scene& world)
{
    if (world.instances.empty()) return nullptr;
    uint64_t stored = 0, placed = 0;
    for (const scene::Geometry& mesh : world.meshes) stored += mesh.triangles.size();
    for (const scene::Instance& instance : world.instances) placed += world.meshes[instance.mesh].triangles.size();
    return {{"count", world.instances.size()},
            {"meshes", world.meshes.size()},
            {"triangles_stored", stored},
            {"triangles_placed", placed}};
}

Json sceneJson(const SceneSource& source, const scene::Scene& world, const passes::RenderStats& stats,
               uint64_t maxTableBytes)
{
    Json pose = Json::object();
    for (const auto& [name, value] : source.toText()) pose[name] = value;
    Json cameras = Json::array();
    for (const scene::Camera& camera : world.cameras) cameras.push_back(camera.name);
    const Json instances = instancesJson(world);
    const uint64_t stored =
        world.triangles.size() + (instances.is_null() ? 0 : instances["triangles_stored"].get<uint64_t>());
    const double triangles = double(std::max<uint64_t>(stored, 1));
    return {{"scene", source.name},
            {"pose", pose},
            {"triangles", world.triangles.size()},
            {"vertices", world.positions.size()},
            {"instances", instances},
            {"materials", world.materials.size()},
            {"images", world.images.size()},
            {"cameras", cameras},
            {"lights",
             {{"emissive_triangles", stats.lights.emissiveTriangles},
              {"points", stats.lights.points},
              {"spots", stats.lights.spots},
              {"directionals", stats.lights.directionals},
              {"environments", stats.lights.environments}}},
            {"bvh",
             {{"nodes", stats.bvh.nodes},
              {"bytes", stats.bvh.bytes},
              {"bytes_per_triangle", double(stats.bvh.bytes) / triangles},
              {"sah_cost", stats.bvh.sahCost},
              {"seconds", stats.bvhSeconds},
              {"triangle_records", stats.bvh.triangleRecords},
              {"skipped_triangles", stats.bvh.skippedTriangles}}},
            {"scene_bytes", stats.sceneBytes},
            {"bytes_per_pixel", stats.bytesPerPixel},
            {"reservoir_bytes_per_pixel", stats.reservoirBytes},
            {"memory_bytes", stats.memoryBytes},
            {"variant", variantJson(stats.variant)},
            {"motion", world.motion ? motionJson(*world.motion) : Json(nullptr)},
            {"playing", playingJson(world, maxTableBytes)},
            {"warnings", world.warnings}};
}

Json adviceJson(const passes::Advice& advice)
{
    Json rows = Json::array();
    for (const passes::Advice::Row& row : advice.rows)
        rows.push_back({{"method", row.method},
                        {"milliseconds", row.milliseconds},
                        {"relmse", row.error},
                        {"gain", row.gain.value},
                        {"gain_low", row.gain.interval.low},
                        {"gain_high", row.gain.interval.high}});
    return {{"best", advice.rows.at(advice.best()).method},
            {"methods", rows},
            {"sigma2", advice.variance},
            {"plateau", advice.plateau},
            {"crossover", advice.crossover()},
            {"trees_per_pixel", advice.treesPerPixel}};
}

void printMotion(const Json& motion)
{
    size_t index = 0;
    for (const Json& animation : motion["animations"]) {
        std::string moves;
        for (const auto& [words, count] : animation["moves"].items())
            moves += fmt::format("{}{} of {}", moves.empty() ? "" : ", ", words, count.get<uint64_t>());
        fmt::print("Animation {} \"{}\": {:.3f} s, {} keys; {}\n", index++, animation["name"].get<std::string>(),
                   animation["seconds"].get<double>(), animation["keys"].get<uint64_t>(),
                   animation.contains("fault") ? "cannot be played: " + animation["fault"].get<std::string>()
                   : moves.empty()             ? "moves nothing"
                                               : "moves " + moves);
    }
    std::string text;
    for (const char* what : {"rigid_parts", "instances", "deforming_parts", "triangles", "nodes", "skins", "joints",
                             "morph_targets", "lights", "cameras", "materials"}) {
        std::string words = what;
        std::ranges::replace(words, '_', ' ');
        if (motion[what] != 0)
            text += fmt::format("{}{} {}", text.empty() ? "" : ", ", motion[what].get<uint64_t>(), words);
    }
    fmt::print("Can move: {}; {} on the host\n", text.empty() ? "nothing" : text, megabytes(motion["host_bytes"]));
}

void printScene(const Json& scene, const passes::Settings& settings)
{
    const Json& bvh = scene["bvh"];
    fmt::print("Scene \"{}\": {} triangles, {} vertices, {} materials, {} images\n", scene["scene"].get<std::string>(),
               scene["triangles"].get<uint64_t>(), scene["vertices"].get<uint64_t>(),
               scene["materials"].get<uint64_t>(), scene["images"].get<uint64_t>());
    if (const Json& instances = scene["instances"]; !instances.is_null())
        fmt::print("Stored once: {} meshes of {} triangles, in {} places; copies would be {} triangles\n",
                   instances["meshes"].get<uint64_t>(), instances["triangles_stored"].get<uint64_t>(),
                   instances["count"].get<uint64_t>(), instances["triangles_placed"].get<uint64_t>());
    std::string pose;
    for (const auto& [name, value] : scene["pose"].items())
        pose += fmt::format("{}{} {}", pose.empty() ? "" : ", ", name, value.get<std::string>());
    if (!pose.empty()) fmt::print("Pose: {}\n", pose);
    std::string lights;
    for (const auto& [kind, count] : scene["lights"].items())
        if (count != 0) lights += fmt::format("{}{} {}", lights.empty() ? "" : ", ", count.get<uint64_t>(), kind);
    fmt::print("Lights: {}\nCameras: {}\n", lights, jsonText(scene["cameras"]));
    if (!scene["motion"].is_null()) printMotion(scene["motion"]);
    if (const Json& playing = scene["playing"]; !playing.is_null())
        fmt::print(
            "While it plays: {:.1f} ms a frame to pose it, {:.1f} ms for its tables, {} of them to the device, {} for "
            "two worlds there\n",
            1000 * playing["pose_seconds"].get<double>(), 1000 * playing["tables_seconds"].get<double>(),
            megabytes(playing["upload_bytes"]), megabytes(playing["worlds_bytes"]));
    fmt::print("BVH: {} nodes, {}, {:.1f} bytes per triangle, SAH cost {:.2f}, built in {:.2f} s\n",
               bvh["nodes"].get<uint64_t>(), megabytes(bvh["bytes"]), bvh["bytes_per_triangle"].get<double>(),
               bvh["sah_cost"].get<double>(), bvh["seconds"].get<double>());
    fmt::print("Memory: {} for the scene, {:.0f} bytes per pixel, {} in all at {}x{}\n",
               megabytes(scene["scene_bytes"]), scene["bytes_per_pixel"].get<double>(),
               megabytes(scene["memory_bytes"]), settings.width, settings.height);
    if (settings.method != passes::Method::Pt)
        fmt::print("Reservoirs: {:.0f} bytes per pixel and reservoir, for this frame's and the previous one's\n",
                   scene["reservoir_bytes_per_pixel"].get<double>());
    for (const bool in : {true, false}) {
        std::puts(in ? "Compiled in:" : "Left out, because neither scene, settings nor device need it:");
        for (const auto& [name, fact] : scene["variant"].items())
            if ((fact["value"] != "off") == in)
                fmt::print("    {:<34}{}{}\n", name, fact["meaning"].get<std::string>(),
                           fact["value"] == "on" || !in ? "" : ": " + fact["value"].get<std::string>());
    }
}

int InfoCommand::run() const
{
    const passes::Settings chosen = settings.read();
    NamedFiles files;
    files.writes("--json", json);
    settings.name(files, chosen);
    files.reads("SCENE", scene.name);
    if (!json.empty()) requireWritable(json);
    if (advises && (scenes || scene.name.empty())) throw UsageError("--advise measures a scene: name one.");
    Json facts = {{"version", version()}};
    if (scenes) {
        facts["scenes"] = scenesJson();
        for (const scene::BuiltInScene& builtIn : scene::builtInScenes())
            fmt::print("{:<10}{}\n", builtIn.name, builtIn.description);
    } else if (scene.name.empty()) {
        facts["devices"] = devicesJson(device.tuning());
        printDevices(facts["devices"]);
    } else {
        Progress progress(quiet);
        gpu::Device gpu = device.open();
        const scene::Scene world = openScene(scene, chosen, progress);
        passes::Renderer renderer(gpu, world, chosen, {.bvhProgress = [&](double fraction) {
                                      progress.show("Building the BVH", fraction, 1);
                                  }});
        progress.clear();
        facts["device"] = gpu.adapter().name;
        facts["tuning"] = tuningJson(gpu.adapter().tuning);
        facts["scene"] = sceneJson(scene, world, renderer.stats(), gpu.limits().tableBytes);
        printScene(facts["scene"], chosen);
        fmt::print("Device: {}, tuned {}\n", gpu.adapter().name, gpu::toText(gpu.adapter().tuning));
        if (advises) {
            const Interrupt interrupt;
            const passes::Advice advice = passes::advise(
                gpu, world, chosen, [&](double done) { progress.show("Measuring", done, 1); },
                [&] { return interrupt.requested(); });
            progress.clear();
            facts["advice"] = adviceJson(advice);
            for (const std::string& sentence : sentencesOf(advice, chosen)) fmt::print("{}\n", sentence);
        }
    }
    if (!json.empty()) writeText(json, jsonText(facts, 2) + "\n");
    return 0;
}

} // namespace

Action setUpInfo(CLI::App& app)
{
    const auto command = std::make_shared<InfoCommand>();
    addSceneOptions(app, command->scene, "A .gltf or .glb file, or a built-in scene; none: the Vulkan devices.");
    app.add_flag("--scenes", command->scenes, "Lists the built-in scenes.");
    app.add_flag("--advise", command->advises,
                 "Measures for a while, and says which way of estimating pays in SCENE with these settings: one "
                 "reservoir, one with variate color, or one a channel.");
    app.add_option("--json", command->json, "Writes the same facts for programs.")->option_text("FILE.json");
    app.add_flag("--quiet", command->quiet, "No progress on the terminal.");
    command->device.addTo(app);
    command->settings.addTo(app);
    return [command] { return command->run(); };
}

} // namespace ui
