#include "ui/window/window_memory.h"

#include "engine/base/error.h"
#include "engine/base/files.h"
#include "engine/base/json.h"
#include "ui/cli/output_file.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include <nlohmann/json.hpp>

namespace ui
{

namespace
{

constexpr uint64_t MAX_BYTES = 1 << 20;
constexpr size_t MOST_RECENT = 8;
constexpr int SMALLEST = 320, LARGEST = 16384; // sides of a window that is worth coming back to

using Json = nlohmann::ordered_json;

glm::dvec3 vectorOf(const Json& json)
{
    return {json.at(0), json.at(1), json.at(2)};
}

std::optional<Pose> poseOf(const Json& json)
{
    if (json.is_null()) return std::nullopt;
    return Pose{vectorOf(json.at("position")), vectorOf(json.at("target")), vectorOf(json.at("up")), json.at("yfov")};
}

} // namespace

void WindowMemory::opened(const std::string& scene)
{
    std::erase(recent, scene);
    recent.insert(recent.begin(), scene);
    if (recent.size() > MOST_RECENT) recent.resize(MOST_RECENT);
}

std::string memoryFile()
{
    const char* config = std::getenv("XDG_CONFIG_HOME");
    if (config && *config == '/') return std::string(config) + "/trichrome/window.json";
    const char* home = std::getenv("HOME");
    return home && *home ? std::string(home) + "/.config/trichrome/window.json" : "";
}

WindowMemory recall(const std::string& file)
{
    try {
        const std::vector<std::byte> bytes = files::read(file, MAX_BYTES);
        const Json json = parseJson(bytes);
        WindowMemory memory;
        for (size_t i = 0; i < 2; ++i) memory.size[i] = std::clamp(json.at("size").at(i).get<int>(), SMALLEST, LARGEST);
        memory.layout = json.at("layout");
        memory.recent = json.at("recent").get<std::vector<std::string>>();
        for (const auto& [scene, poses] : json.at("bookmarks").items())
            for (size_t i = 0; i < BOOKMARKS; ++i) memory.bookmarks[scene][i] = poseOf(poses.at(i));
        return memory;
    } catch (const Error&) {
        return {};
    } catch (const nlohmann::json::exception&) {
        return {};
    }
}

void keep(const WindowMemory& memory, const std::string& file)
{
    Json bookmarks = Json::object();
    for (const auto& [scene, poses] : memory.bookmarks)
        for (const std::optional<Pose>& pose : poses) bookmarks[scene].push_back(pose ? toJson(*pose) : Json());
    const Json json = {
        {"size", memory.size}, {"layout", memory.layout}, {"recent", memory.recent}, {"bookmarks", bookmarks}};
    files::createFolder(std::filesystem::path(file).parent_path());
    writeText(file, jsonText(json, 2) + "\n");
}

} // namespace ui
