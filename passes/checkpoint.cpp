#include "passes/checkpoint.h"

#include "engine/base/error.h"
#include "engine/base/files.h"
#include "engine/base/fingerprint.h"
#include "engine/base/json.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cmath>

namespace passes
{

namespace
{

using Json = nlohmann::ordered_json;
using Bytes = std::span<const std::byte>;

constexpr std::array<char, 8> MAGIC = {'T', 'R', 'I', 'C', 'K', 'P', 'T', '\n'};
constexpr uint32_t FORMAT_VERSION = 1;
constexpr uint32_t MAX_TEXT_BYTES = 1 << 20;

struct Header {
    std::array<char, 8> magic = MAGIC;
    uint32_t version = FORMAT_VERSION;
    uint32_t textBytes = 0;
    uint64_t dataBytes = 0;
    uint64_t fingerprint = 0; // of the text, which holds those of the buffers
};
static_assert(sizeof(Header) == 32, "no padding: every byte of the file is checked");

using CameraValues = std::array<float, sizeof(shared::CameraUniform) / sizeof(float)>;

template <class... Args>
Error refusal(const std::string& file, fmt::format_string<Args...> format, Args&&... args)
{
    return Error("Cannot resume from \"{}\": {}.", file, fmt::format(format, std::forward<Args>(args)...));
}

// Reads the description; complains in the name of the file.
class Reader
{
  public:
    Reader(const std::string& file, const Json& object) : file_(file), object_(object)
    {
        if (!object.is_object()) throw refusal(file, "its description holds {} for an object", object.type_name());
    }

    const Json& at(const char* name, Json::value_t type) const
    {
        const auto found = object_.find(name);
        if (found == object_.end() || found->type() != type)
            throw refusal(file_, "its description lacks a valid \"{}\"", name);
        return *found;
    }
    std::string text(const char* name) const { return at(name, Json::value_t::string).get<std::string>(); }
    uint64_t count(const char* name) const { return at(name, Json::value_t::number_unsigned).get<uint64_t>(); }
    double seconds(const char* name) const { return at(name, Json::value_t::number_float).get<double>(); }

    shared::CameraUniform camera(const char* name) const
    {
        const Json& numbers = at(name, Json::value_t::array);
        CameraValues values;
        if (numbers.size() != values.size()) throw refusal(file_, "its \"{}\" has {} numbers", name, numbers.size());
        for (size_t i = 0; i < values.size(); ++i) {
            if (!numbers[i].is_number()) throw refusal(file_, "its \"{}\" holds {}", name, numbers[i].type_name());
            values[i] = numbers[i].get<float>();
        }
        shared::CameraUniform camera;
        std::memcpy(&camera, values.data(), sizeof(camera));
        return camera;
    }

    Identity identity(const char* name) const
    {
        Identity identity;
        for (const auto& [key, value] : at(name, Json::value_t::object).items()) {
            if (!value.is_string()) throw refusal(file_, "its \"{}\" is no text", key);
            identity.emplace_back(key, value.get<std::string>());
        }
        return identity;
    }

  private:
    const std::string& file_;
    const Json& object_;
};

Json toJson(const shared::CameraUniform& camera)
{
    CameraValues values;
    std::memcpy(values.data(), &camera, sizeof(camera));
    return values;
}

} // namespace

void write(const std::filesystem::path& file, const Checkpoint& checkpoint)
{
    const RendererState& state = checkpoint.state;
    Json identity = Json::object(), buffers = Json::array();
    for (const auto& [name, value] : checkpoint.identity) identity[name] = value;
    for (const auto& [name, bytes] : state.buffers)
        buffers.push_back({{"name", name}, {"bytes", bytes.size()}, {"fingerprint", fingerprint(bytes)}});
    const std::string text = jsonText({{"identity", identity},
                                       {"seconds", checkpoint.seconds},
                                       {"frames", state.frames},
                                       {"history-frames", state.historyFrames},
                                       {"camera", toJson(state.camera)},
                                       {"previous-camera", toJson(state.previousCamera)},
                                       {"buffers", buffers}});
    Header header{.textBytes = uint32_t(text.size()), .fingerprint = fingerprint(std::as_bytes(std::span(text)))};
    std::vector<Bytes> pieces = {std::as_bytes(std::span(&header, 1)), std::as_bytes(std::span(text))};
    for (const auto& [name, bytes] : state.buffers) {
        header.dataBytes += bytes.size();
        pieces.emplace_back(bytes);
    }
    files::writeAtomically(file, pieces);
}

Checkpoint parseCheckpoint(std::span<const std::byte> bytes, const std::string& file)
{
    Header header;
    if (bytes.size() < sizeof(header)) throw refusal(file, "it is no checkpoint ({} bytes)", bytes.size());
    std::memcpy(&header, bytes.data(), sizeof(header));
    if (header.magic != MAGIC) throw refusal(file, "it is no checkpoint");
    if (header.version != FORMAT_VERSION)
        throw refusal(file, "its format has version {}, not {}", header.version, FORMAT_VERSION);
    bytes = bytes.subspan(sizeof(header));
    const uint64_t textBytes = header.textBytes;
    if (textBytes > MAX_TEXT_BYTES || textBytes > bytes.size() || header.dataBytes != bytes.size() - textBytes)
        throw refusal(file, "it is cut short or damaged ({} bytes after its header, which says {} and {})",
                      bytes.size(), textBytes, header.dataBytes);
    const Bytes text = bytes.first(textBytes);
    if (header.fingerprint != fingerprint(text)) throw refusal(file, "its description is damaged");
    const Json json = whileDoing(fmt::format("reading \"{}\"", file), [&] { return parseJson(text); });

    const Reader reader(file, json);
    Checkpoint checkpoint{.identity = reader.identity("identity"),
                          .seconds = reader.seconds("seconds"),
                          .state = {.frames = reader.count("frames"),
                                    .historyFrames = reader.count("history-frames"),
                                    .camera = reader.camera("camera"),
                                    .previousCamera = reader.camera("previous-camera")}};
    Bytes data = bytes.subspan(textBytes);
    for (const Json& buffer : reader.at("buffers", Json::value_t::array)) {
        const Reader entry(file, buffer);
        const std::string name = entry.text("name");
        const uint64_t size = entry.count("bytes");
        if (size > data.size()) throw refusal(file, "buffer \"{}\" lacks {} bytes", name, size - data.size());
        const Bytes own = data.first(size);
        if (entry.count("fingerprint") != fingerprint(own)) throw refusal(file, "buffer \"{}\" is damaged", name);
        checkpoint.state.buffers.emplace_back(name, std::vector(own.begin(), own.end()));
        data = data.subspan(size);
    }
    if (!data.empty()) throw refusal(file, "{} bytes belong to nothing", data.size());
    return checkpoint;
}

Checkpoint readCheckpoint(const std::filesystem::path& file)
{
    return parseCheckpoint(files::read(file, UINT64_MAX), file.string());
}

void requireSame(const Checkpoint& checkpoint, const Identity& now, const std::string& file)
{
    const Identity& then = checkpoint.identity;
    for (const auto& [name, value] : now) {
        const auto found = std::ranges::find(then, name, &Identity::value_type::first);
        if (found == then.end()) throw refusal(file, "it was rendered without {} {}", name, jsonText(value));
        if (jsonText(found->second) != jsonText(value))
            throw refusal(file, "its {} is {}, not {}", name, jsonText(found->second), jsonText(value));
    }
    for (const auto& [name, value] : then)
        if (std::ranges::find(now, name, &Identity::value_type::first) == now.end())
            throw refusal(file, "it was rendered with {} {}", name, jsonText(value));
}

} // namespace passes
