#include "engine/scene/gltf_document.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <map>
#include <optional>

#include "engine/base/error.h"
#include "engine/base/files.h"
#include "engine/base/json.h"
#include "engine/scene/gltf_json_checks.h"
#include "engine/scene/gltf_materials.h"

namespace scene::gltf
{

namespace
{

constexpr uint64_t MAX_FILE_BYTES = uint64_t{1} << 31;

struct Container {
    std::span<const std::byte> json;
    std::optional<std::span<const std::byte>> binary;
};

uint32_t readUint32(std::span<const std::byte> bytes, size_t offset)
{
    uint32_t value = 0;
    std::memcpy(&value, &bytes[offset], sizeof value);
    return value;
}

// glTF 2.0, 4.4: a header of 12 bytes, then chunks of {length, type, bytes}.
Container openBinary(std::span<const std::byte> bytes)
{
    constexpr uint32_t JSON_CHUNK = 0x4e4f534a, BINARY_CHUNK = 0x004e4942;
    if (bytes.size() < 12) throw Error("The GLB header is cut short after {} bytes.", bytes.size());
    const uint32_t version = readUint32(bytes, 4), length = readUint32(bytes, 8);
    if (version != 2) throw Error("The GLB container has version {}, but only 2 is supported.", version);
    if (length > bytes.size())
        throw Error("The GLB header claims {} bytes, but the file has {}.", length, bytes.size());
    if (length < 20) throw Error("The GLB header claims {} bytes, too few for any content.", length);
    bytes = bytes.first(length);

    Container container;
    for (size_t offset = 12, chunk = 0; offset < bytes.size(); ++chunk) {
        if (bytes.size() - offset < 8) throw Error("GLB chunk {} is cut short.", chunk);
        const uint32_t chunkLength = readUint32(bytes, offset), type = readUint32(bytes, offset + 4);
        offset += 8;
        if (chunkLength > bytes.size() - offset)
            throw Error("GLB chunk {} claims {} bytes, but {} are left.", chunk, chunkLength, bytes.size() - offset);
        const auto content = bytes.subspan(offset, chunkLength);
        if (chunk == 0 && type != JSON_CHUNK) throw Error("The first GLB chunk is not JSON.");
        if (chunk == 0) container.json = content;
        if (chunk == 1 && type == BINARY_CHUNK) container.binary = content;
        offset += std::min<size_t>((chunkLength + size_t{3}) / 4 * 4, bytes.size() - offset);
    }
    // Padding, by the book of spaces; some write zero bytes.
    while (!container.json.empty() &&
           (container.json.back() == std::byte{0} || container.json.back() == std::byte{' '}))
        container.json = container.json.first(container.json.size() - 1);
    return container;
}

void readBuffers(const Object& root, std::optional<std::span<const std::byte>> binary, Document& document)
{
    uint64_t budget = MAX_FILE_BYTES; // for all together: buffers may name the same file again and again
    root.eachObject("buffers", [&](const Object& buffer, size_t i) {
        const uint64_t length = buffer.integer("byteLength", 1, ~uint64_t{0}).value();
        const std::string* uri = buffer.string("uri");
        if (!uri && (i != 0 || !binary))
            throw Error("{} has no \"uri\" and there is no GLB chunk for it.", buffer.path());
        std::vector<std::byte> bytes =
            uri ? readUri(*uri, document.folders) : std::vector(binary->begin(), binary->end());
        if (bytes.size() < length)
            throw Error("{} is {}, but its data has {} bytes.", buffer.path("byteLength"), length, bytes.size());
        if (bytes.size() > budget) throw Error("The buffers hold more than {} bytes together.", MAX_FILE_BYTES);
        budget -= bytes.size();
        bytes.resize(length);
        document.buffers.push_back(std::move(bytes));
        if (const auto file = uri ? fileOf(*uri, document.folders) : std::nullopt) document.files.push_back(*file);
    });
}

std::vector<ImageSource> listImages(const Object& document)
{
    std::vector<ImageSource> images;
    document.eachObject("images", [&](const Object& image, size_t) {
        ImageSource source;
        if (const auto* uri = image.string("uri")) source.uri = *uri;
        if (const auto view = image.index("bufferView", "bufferViews")) source.bufferView = static_cast<int>(*view);
        if ((source.bufferView >= 0) == image.has("uri"))
            throw Error("{} needs either \"uri\" or \"bufferView\".", image.path());
        const auto* name = image.string("name");
        if (name && !name->empty())
            source.name = shown(*name);
        else
            source.name = source.uri.empty() || source.uri.starts_with("data:") ? image.path() : shown(source.uri);
        images.push_back(std::move(source));
    });
    return images;
}

// What optional features of the file we leave out.
void warnOfIgnored(const Object& document, Warnings& warnings)
{
    std::map<std::string, size_t> users; // materials by extension
    document.eachObject("materials", [&](const Object& material, size_t) {
        material.object("extensions", [&](const Object& extensions) {
            for (const auto& [name, unused] : extensions.json().items()) ++users[name];
        });
    });
    for (size_t i = 0; i < document.arraySize("extensionsUsed"); ++i)
        users.try_emplace(document.json()["extensionsUsed"][i].get<std::string>(), 0);
    for (const auto& [name, count] : users) {
        if (isSupportedExtension(name)) continue;
        warnings.add(count == 0 ? fmt::format("Ignored the extension \"{}\".", shown(name))
                                : fmt::format("Ignored the extension \"{}\" on {} material{}.", shown(name), count,
                                              count == 1 ? "" : "s"));
    }
}

// tinygltf reads structure only. It recurses into extras, and cuts integers of extensions to 32 bits.
void simplify(Json& value)
{
    if (value.is_object()) value.erase("extras");
    if (value.is_structured()) {
        for (Json& child : value) simplify(child);
    } else if (value.is_number_integer() && value.get<double>() > std::numeric_limits<int>::max()) {
        value = value.get<double>();
    }
}

tinygltf::Model parseModel(Json json)
{
    for (const char* key : {"buffers", "images", "textures", "samplers", "materials", "animations"}) json.erase(key);
    simplify(json);
    const std::string text = json.dump();
    tinygltf::TinyGLTF parser;
    tinygltf::Model model;
    std::string problems, remarks;
    if (!parser.LoadASCIIFromString(&model, &problems, &remarks, text.data(), static_cast<unsigned>(text.size()), ""))
        throw Error("The glTF structure is malformed: {}.", shown(problems.substr(0, problems.find_first_of(".\n"))));
    return model;
}

} // namespace

std::span<const std::byte> Document::view(int bufferView) const
{
    const tinygltf::BufferView& view = model.bufferViews[static_cast<size_t>(bufferView)];
    return std::span(buffers[static_cast<size_t>(view.buffer)]).subspan(view.byteOffset, view.byteLength);
}

Document openDocument(const std::filesystem::path& file, const std::filesystem::path& assetRoot, bool animations,
                      Warnings& warnings)
{
    const std::vector<std::byte> bytes = files::read(file, MAX_FILE_BYTES);
    const bool isBinary = bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0;
    const Container container = isBinary ? openBinary(bytes) : Container{bytes, std::nullopt};

    Json json = parseJson<Json>(container.json);
    checkJson(json);
    const Object root(json);
    Document document{.folders = {file.parent_path(), assetRoot}, .images = listImages(root)};
    readBuffers(root, container.binary, document);
    document.materials = readMaterials(root, warnings);
    if (animations) document.animations = listAnimations(root, warnings);
    warnOfIgnored(root, warnings);
    document.model = parseModel(std::move(json));
    return document;
}

} // namespace scene::gltf
