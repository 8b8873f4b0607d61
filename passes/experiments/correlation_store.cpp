#include "passes/experiments/correlation_store.h"

#include "engine/base/error.h"
#include "engine/base/files.h"
#include "engine/base/json.h"
#include "engine/base/shown.h"

#include <cstring>

#include <nlohmann/json.hpp>

namespace passes
{

namespace
{

using Json = nlohmann::ordered_json;
constexpr const char* EXTENSION = ".cbor";

// Throws Error unless the bytes are CBOR as we write it: the parser recurses, so nesting is bounded, and what else
// makes it recurse (tags, strings in pieces) is refused.
void checkCbor(std::span<const std::byte> bytes)
{
    constexpr size_t MAX_DEPTH = 16;
    std::vector<uint64_t> open = {1}; // items to come, of each array or object that is not complete
    for (size_t at = 0; !open.empty();) {
        if (open.back() == 0) {
            open.pop_back();
            continue;
        }
        --open.back();
        const auto next = [&] { return at < bytes.size() ? uint32_t(bytes[at++]) : throw Error("It is cut short."); };
        const uint32_t first = next(), kind = first >> 5, size = first & 31;
        if (kind == 6 || size > 27) throw Error("It holds a byte {:#x}, which batches do not.", first);
        uint64_t count = size < 24 ? size : 0;
        for (int left = size < 24 ? 0 : 1 << (size - 24); left > 0; --left) count = count << 8 | next();
        if (kind == 2 || kind == 3) { // bytes, text
            if (count > bytes.size() - at) throw Error("It is cut short.");
            at += count;
        } else if (kind == 4 || kind == 5) { // an array, an object
            if (count > bytes.size() - at || open.size() >= MAX_DEPTH) throw Error("It is cut short or nested deeply.");
            open.push_back(kind == 4 ? count : 2 * count);
        }
    }
}

Json toJson(const statistics::BatchValue& value)
{
    return {{"value", value.value}, {"without", value.without}};
}

statistics::BatchValue valueOf(const Json& json)
{
    return {json.at("value").get<double>(), json.at("without").get<std::vector<double>>()};
}

Json toJson(const std::vector<glm::dvec3>& picture)
{
    std::vector<uint8_t> bytes(picture.size() * sizeof(glm::dvec3));
    if (!bytes.empty()) std::memcpy(bytes.data(), picture.data(), bytes.size());
    return Json::binary(std::move(bytes));
}

std::vector<glm::dvec3> pictureOf(const Json& json)
{
    const std::vector<uint8_t>& bytes = json.get_binary();
    std::vector<glm::dvec3> picture(bytes.size() / sizeof(glm::dvec3));
    if (!picture.empty()) std::memcpy(picture.data(), bytes.data(), picture.size() * sizeof(glm::dvec3));
    return picture;
}

} // namespace

std::vector<std::byte> toBytes(const CorrelationBatch& batch)
{
    Json json = {{"method", batch.method}, {"index", batch.index},    {"runs", batch.runs},
                 {"law", nullptr},         {"points", Json::array()}, {"nonfinite", batch.nonFinite}};
    if (batch.law)
        json["law"] = {{"variance", toJson(batch.law->variance)},
                       {"plateau", toJson(batch.law->plateau)},
                       {"floor", toJson(batch.law->floor)},
                       {"mean", toJson(batch.law->mean)}};
    for (const ChainPoint& point : batch.points) {
        Json lags = Json::array();
        for (const LagPoint& lag : point.lags)
            lags.push_back({{"lag", lag.lag}, {"autocovariance", toJson(lag.autocovariance)}});
        json["points"].push_back({{"frame", point.frame},
                                  {"pixels", point.pixels},
                                  {"autocovariance", toJson(point.autocovariance)},
                                  {"variance", toJson(point.variance)},
                                  {"film", point.film ? toJson(*point.film) : Json()},
                                  {"lags", std::move(lags)}});
    }
    const std::vector<uint8_t> cbor = Json::to_cbor(json);
    const auto bytes = std::as_bytes(std::span(cbor));
    return {bytes.begin(), bytes.end()};
}

CorrelationBatch fromBytes(std::span<const std::byte> bytes)
{
    checkCbor(bytes);
    try {
        const auto* data = reinterpret_cast<const uint8_t*>(bytes.data());
        const Json json = Json::from_cbor(data, data + bytes.size());
        CorrelationBatch batch{.method = json.at("method"),
                               .index = json.at("index"),
                               .runs = json.at("runs"),
                               .nonFinite = json.at("nonfinite")};
        if (const Json& law = json.at("law"); !law.is_null())
            batch.law = {.variance = valueOf(law.at("variance")),
                         .plateau = valueOf(law.at("plateau")),
                         .floor = pictureOf(law.at("floor")),
                         .mean = pictureOf(law.at("mean"))};
        for (const Json& point : json.at("points")) {
            ChainPoint& own =
                batch.points.emplace_back(ChainPoint{.frame = point.at("frame"),
                                                     .pixels = point.at("pixels"),
                                                     .autocovariance = valueOf(point.at("autocovariance")),
                                                     .variance = valueOf(point.at("variance")),
                                                     .film = {},
                                                     .lags = {}});
            if (const Json& film = point.at("film"); !film.is_null()) own.film = valueOf(film);
            for (const Json& lag : point.at("lags"))
                own.lags.push_back({.lag = lag.at("lag"), .autocovariance = valueOf(lag.at("autocovariance"))});
        }
        return batch;
    } catch (const nlohmann::json::exception& error) {
        throw Error("This is no batch of correlate: {}.", error.what());
    }
}

void CorrelationStore::open(const std::vector<std::pair<std::string, std::string>>& facts, bool resume) const
{
    Json wanted = Json::object();
    for (const auto& [name, value] : facts) wanted[name] = value;
    const std::filesystem::path file = path_ / "settings.json";
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) {
        files::createFolder(path_);
        const std::string text = jsonText(wanted, 2) + "\n";
        files::writeAtomically(file, std::as_bytes(std::span(text)));
        return;
    }
    const std::string directory = path_.parent_path().string();
    if (!resume)
        throw Error("\"{}\" holds a measurement already: --resume goes on with it, or name another directory.",
                    directory);
    const std::vector<std::byte> bytes = files::read(file);
    const Json found = parseJson(bytes);
    for (const auto& [name, value] : wanted.items())
        if (!found.is_object() || found.value(name, Json()) != value)
            throw Error("\"{}\" cannot be resumed: it was measured with {} = {}, not {}.", directory, name,
                        found.is_object() ? shown(jsonText(found.value(name, Json()))) : "?", jsonText(value));
}

void CorrelationStore::save(const CorrelationBatch& batch) const
{
    std::string name; // of a file: methods may hold what directories do not like
    for (const char c : batch.method) name += std::isalnum(static_cast<unsigned char>(c)) || c == '-' ? c : '_';
    files::writeAtomically(path_ / fmt::format("{:05}-{}-runs-{}{}", batch.index, batch.runs, name, EXTENSION),
                           toBytes(batch));
}

std::vector<CorrelationBatch> CorrelationStore::load(std::span<const uint32_t> runs) const
{
    std::vector<CorrelationBatch> batches;
    for (const auto& entry : std::filesystem::directory_iterator(path_)) {
        if (entry.path().extension() != EXTENSION) continue;
        whileDoing(fmt::format("reading \"{}\"", entry.path().string()),
                   [&] { batches.push_back(fromBytes(files::read(entry.path()))); });
        const CorrelationBatch& last = batches.back();
        if (last.index >= runs.size() || last.runs != runs[last.index]) batches.pop_back(); // of other --runs
    }
    return batches;
}

} // namespace passes
