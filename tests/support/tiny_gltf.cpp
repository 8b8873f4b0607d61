#include "tests/support/tiny_gltf.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "engine/base/error.h"
#include "engine/base/files.h"
#include "engine/image/codecs.h"
#include "tests/support/base64.h"

TinyGltf::TinyGltf()
{
    std::string pattern = (std::filesystem::temp_directory_path() / "trichrome_gltf_XXXXXX").string();
    folder = ::mkdtemp(pattern.data());
    json = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}, {"nodes", {{{"mesh", 0}}}}};
    json["meshes"] = {{{"primitives", nlohmann::json::array({nlohmann::json::object()})}}};
    attributes()["POSITION"] = accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    attributes()["NORMAL"] = accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
}

TinyGltf::~TinyGltf()
{
    std::filesystem::remove_all(folder);
}

size_t TinyGltf::componentsOf(const std::string& type)
{
    if (type == "SCALAR") return 1;
    if (type == "MAT4") return 16;
    return size_t(type.back() - '0');
}

int TinyGltf::viewOfBytes(std::span<const std::byte> bytes)
{
    data_.resize((data_.size() + 3) / 4 * 4);
    json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", data_.size()}, {"byteLength", bytes.size()}});
    data_.insert(data_.end(), bytes.begin(), bytes.end());
    return int(json["bufferViews"].size()) - 1;
}

int TinyGltf::texture(const std::vector<uint32_t>& pixels)
{
    std::vector<uint8_t> rgb;
    for (const uint32_t pixel : pixels)
        rgb.insert(rgb.end(), {uint8_t(pixel >> 16), uint8_t(pixel >> 8), uint8_t(pixel)});
    json["images"].push_back({{"bufferView", view(image::encodePng(2, 2, rgb, {}))}, {"mimeType", "image/png"}});
    json["textures"].push_back({{"source", json["images"].size() - 1}});
    return int(json["textures"].size()) - 1;
}

void TinyGltf::animate(const nlohmann::json& target, const std::vector<float>& times, const std::vector<float>& values,
                       const std::string& type, const std::string& interpolation)
{
    nlohmann::json& animation = json["animations"][0];
    animation["samplers"].push_back(
        {{"input", accessor(times, "SCALAR")}, {"output", accessor(values, type)}, {"interpolation", interpolation}});
    animation["channels"].push_back({{"sampler", animation["samplers"].size() - 1}, {"target", target}});
}

void TinyGltf::animatePointer(const std::string& pointer, const std::vector<float>& times,
                              const std::vector<float>& values, const std::string& type,
                              const std::string& interpolation)
{
    animate({{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}}, times, values,
            type, interpolation);
}

nlohmann::json& TinyGltf::material()
{
    primitive()["material"] = 0;
    return json["materials"][0];
}

scene::Scene TinyGltf::load(const scene::LoadOptions& options) const
{
    nlohmann::json document = json;
    document["buffers"] = {{{"byteLength", data_.size()}, {"uri", "data.bin"}}};
    const std::string text = document.dump();
    files::writeAtomically(folder / "data.bin", data_);
    files::writeAtomically(folder / "tiny.gltf", std::as_bytes(std::span(text)));
    return scene::loadGltf(folder / "tiny.gltf", options);
}

std::string TinyGltf::text() const
{
    nlohmann::json document = json;
    document["buffers"] = {
        {{"byteLength", data_.size()}, {"uri", "data:application/octet-stream;base64," + support::base64(data_)}}};
    return document.dump();
}

std::string TinyGltf::error() const
{
    try {
        load();
    } catch (const Error& error) {
        const std::string prefix = "Cannot load \"" + (folder / "tiny.gltf").string() + "\": ";
        const std::string message = error.what();
        return message.starts_with(prefix) ? message.substr(prefix.size()) : "without the file's name: " + message;
    }
    return "";
}

bool TinyGltf::warns(const std::string& sentence) const
{
    const std::vector<std::string> warnings = load().warnings;
    return std::find(warnings.begin(), warnings.end(), sentence) != warnings.end();
}
