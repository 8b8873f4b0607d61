#include "tests/support/shared_files.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include <nlohmann/json.hpp>

std::filesystem::path sharedPath(const std::string& entry)
{
    const char* chosen = std::getenv("TRICHROME_SHARED");
    const std::filesystem::path root = chosen ? chosen : TRICHROME_SOURCE_DIR "/../shared";
    return std::filesystem::exists(root / entry) ? root / entry : std::filesystem::path();
}

std::vector<MalformedFile> malformedFiles()
{
    const std::filesystem::path folder = sharedPath("malformed");
    std::ifstream stream(folder / "manifest.json");
    const auto manifest = nlohmann::json::parse(stream);
    std::vector<MalformedFile> files;
    for (const auto& entry : manifest.at("files")) {
        const std::string expect = entry.at("expect");
        files.push_back({.path = folder / entry.at("file").get<std::string>(),
                         .kind = entry.at("kind"),
                         .mayFail = expect == "clear error" || expect == "either",
                         .mayLoad = expect == "renders, finite" || expect == "either",
                         .why = entry.at("why")});
    }
    return files;
}

std::vector<std::filesystem::path> sharedModels(const std::string& folder)
{
    std::vector<std::filesystem::path> models;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(sharedPath(folder))) {
        if (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb") models.push_back(entry.path());
    }
    std::sort(models.begin(), models.end());
    return models;
}
