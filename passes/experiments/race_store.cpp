#include "passes/experiments/race_store.h"

#include "engine/base/csv.h"
#include "engine/base/error.h"
#include "engine/base/files.h"
#include "engine/base/json.h"

#include <nlohmann/json.hpp>

namespace passes
{

namespace
{

using Json = nlohmann::ordered_json;

constexpr uint64_t MAX_FILE_BYTES = uint64_t{256} << 20;

// The figures of a sample, in the order in which they are stored.
template <class AnySample, class Visitor>
void visitFigures(AnySample& s, Visitor&& visit)
{
    for (auto* figure : {&s.deviceSeconds, &s.wallSeconds, &s.error.mse, &s.error.relmse, &s.error.mape, &s.error.psnr,
                         &s.error.ssim, &s.error.lumaMse, &s.error.chromaMse, &s.error.meanRatio.r,
                         &s.error.meanRatio.g, &s.error.meanRatio.b, &s.error.flip})
        visit(*figure);
}

Json jsonOf(const Sample& sample)
{
    Json row = {sample.method, sample.average, sample.frames};
    visitFigures(sample, [&](double value) { row.push_back(csvNumber(value)); }); // JSON has no nan
    return row;
}

Sample sampleOf(const Json& row, size_t methods)
{
    Sample sample{
        .method = row.at(0).get<uint32_t>(), .average = row.at(1).get<bool>(), .frames = row.at(2).get<uint64_t>()};
    if (sample.method >= methods) throw Error("It names a method {} of {}.", sample.method, methods);
    size_t column = 3;
    visitFigures(sample, [&](double& value) { value = std::stod(row.at(column++).get<std::string>()); });
    return sample;
}

} // namespace

RaceStore::RaceStore(std::filesystem::path directory, std::string key, std::vector<std::string> names)
    : directory_(std::move(directory)), key_(std::move(key)), names_(std::move(names))
{
}

std::filesystem::path RaceStore::file(size_t index) const
{
    return directory_ / "repeats" / fmt::format("{:04}.json", index);
}

std::filesystem::path RaceStore::picture(size_t method) const
{
    std::string name = names_[method];
    for (char& c : name)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-' && c != '.') c = '_';
    return directory_ / "pictures" / fmt::format("{:02}-{}.exr", method, name);
}

void RaceStore::requireNew() const
{
    std::error_code ignored;
    if (std::filesystem::exists(directory_ / "repeats", ignored))
        throw Error("\"{}\" holds a measurement already: --resume goes on with it, or name another directory.",
                    directory_.string());
}

void RaceStore::write(size_t index, const Repeat& repeat) const
{
    if (index == 0) {
        files::createFolder(directory_ / "pictures");
        for (size_t method = 0; method < repeat.finals.size(); ++method)
            image::write(picture(method), repeat.finals[method], {{"method", names_[method]}, {"settings-key", key_}});
    }
    files::createFolder(directory_ / "repeats");
    Json json = {{"key", key_}, {"repeat", index}, {"nonfinite", repeat.nonFinite}, {"samples", Json::array()}};
    for (const Sample& sample : repeat.samples) json["samples"].push_back(jsonOf(sample));
    const std::string text = jsonText(json) + "\n";
    files::writeAtomically(file(index), std::as_bytes(std::span(text)));
}

std::vector<Repeat> RaceStore::read(size_t limit) const
{
    std::vector<Repeat> repeats;
    for (size_t index = 0; index < limit && std::filesystem::exists(file(index)); ++index) {
        const std::string name = file(index).string();
        const std::vector<std::byte> bytes = files::read(file(index), MAX_FILE_BYTES);
        try {
            const Json json = parseJson(bytes);
            if (json.at("key").get<std::string>() != key_)
                throw Error("Cannot resume: \"{}\" holds a run of other settings, another scene, device or version.",
                            directory_.string());
            Repeat repeat{.nonFinite = json.at("nonfinite").get<uint64_t>(), .complete = true};
            for (const Json& row : json.at("samples")) repeat.samples.push_back(sampleOf(row, names_.size()));
            repeats.push_back(std::move(repeat));
        } catch (const nlohmann::json::exception& error) {
            throw Error("Cannot resume: \"{}\" is damaged: {}.", name, error.what());
        } catch (const std::logic_error& error) { // no number
            throw Error("Cannot resume: \"{}\" is damaged: {}.", name, error.what());
        }
    }
    return repeats;
}

} // namespace passes
