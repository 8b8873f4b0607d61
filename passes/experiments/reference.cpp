#include "passes/experiments/reference.h"

#include "engine/base/error.h"
#include "engine/base/files.h"
#include "engine/base/fingerprint.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace passes
{

namespace
{

// Of a reference's mean; from as many its precision is estimated.
constexpr uint64_t BATCHES = 16, LONGEST_BATCH = 64;
constexpr uint64_t FIRST_CHECK = 8; // batches before the precision is believed

struct Figure {
    const char* name;
    double image::OwnError::*field;
};
constexpr Figure FIGURES[] = {{"own-mse", &image::OwnError::mse},
                              {"own-relmse", &image::OwnError::relmse},
                              {"own-luma-mse", &image::OwnError::lumaMse},
                              {"own-chroma-mse", &image::OwnError::chromaMse}};

image::Metadata metadataOf(const Reference& reference, const std::string& key)
{
    image::Metadata metadata = {{"reference-key", key},
                                {"frames-done", std::to_string(reference.pathTraced)},
                                {"precise", reference.precise ? "yes" : "no"}};
    for (const Figure& figure : FIGURES)
        metadata.emplace_back(figure.name, fmt::format("{}", reference.error.*figure.field));
    return metadata;
}

bool isFinite(const image::Image& picture)
{
    return std::ranges::all_of(picture.pixels, [](const glm::vec3& p) {
        return std::isfinite(p.r) && std::isfinite(p.g) && std::isfinite(p.b);
    });
}

// Nothing when the file is missing, damaged, or somebody else's: then it is made again.
std::optional<Reference> readCached(const std::filesystem::path& file, const std::string& key, const Settings& settings)
{
    try {
        const image::Loaded loaded = image::read(file);
        const std::map<std::string, std::string> facts(loaded.metadata.begin(), loaded.metadata.end());
        const image::Image& picture = loaded.image;
        if (facts.at("reference-key") != key || picture.width != settings.width || picture.height != settings.height ||
            !isFinite(picture))
            return std::nullopt;
        Reference reference{.picture = picture, .pathTraced = std::stoull(facts.at("frames-done")), .fromCache = true};
        reference.precise = facts.at("precise") == "yes";
        for (const Figure& figure : FIGURES) {
            reference.error.*figure.field = std::stod(facts.at(figure.name));
            if (!(reference.error.*figure.field >= 0)) return std::nullopt;
        }
        return reference;
    } catch (const Error&) {
        return std::nullopt;
    } catch (const std::logic_error&) { // a fact is missing or no number
        return std::nullopt;
    }
}

} // namespace

Settings referenceSettings(const Settings& settings)
{
    Settings traced; // what does not change the picture stays at its default, so that more finds it in the cache
    traced.method = Method::Pt;
    copy(traced, settings, {Role::Scene, Role::View, Role::Picture});
    traced.seed = ~settings.seed; // counting down from here, while repeats count up from theirs
    return traced;
}

ReferenceTracer::ReferenceTracer(std::unique_ptr<Renderer> renderer)
    : renderer_(std::move(renderer)), settings_(renderer_->settings())
{
    begin();
}

void ReferenceTracer::restart()
{
    mean_ = {};
    begin();
}

bool ReferenceTracer::step(uint64_t length)
{
    renderer_->renderFrame();
    if (renderer_->frameCount() != length) return false;
    mean_.add(renderer_->read(MEAN));
    begin();
    return true;
}

void ReferenceTracer::begin()
{
    Settings settings = settings_;
    settings.seed -= 1 + mean_.count();
    renderer_->apply(settings);
    renderer_->reset();
}

References::References(const Renderer& sharing, const Settings& settings, Sequence sequence, Options options)
    : settings_(referenceSettings(settings)), sequence_(std::move(sequence)), options_(std::move(options)),
      tracer_(std::make_unique<Renderer>(sharing, settings_))
{
}

References::References(const std::filesystem::path& file, const Settings& settings) : settings_(settings)
{
    image::Loaded loaded = image::read(file);
    warnings_ = std::move(loaded.warnings);
    Reference reference{.picture = std::move(loaded.image)};
    const image::Image& picture = reference.picture;
    if (picture.width != settings.width || picture.height != settings.height)
        throw Error("Reference \"{}\" has {}x{} pixels, but --size is {}x{}.", file.string(), picture.width,
                    picture.height, settings.width, settings.height);
    if (!isFinite(picture)) throw Error("Reference \"{}\" has pixels that are not finite.", file.string());
    made_.emplace(0, std::move(reference));
}

const Reference* References::after(uint64_t frames)
{
    const uint64_t index = sequence_.moves() ? frames : 0;
    if (const auto found = made_.find(index); found != made_.end()) return &found->second;
    Renderer& renderer = tracer_->renderer();
    sequence_.bring(renderer, sequence_.moves() ? int64_t(frames) - 1 : 0);
    renderer.apply(settings_); // with the seed that no batch has
    renderer.reset();
    renderer.renderFrame();
    const std::vector<glm::vec3> pixels = renderer.read(MEAN).pixels;
    const std::string text =
        fmt::format("{} {} {}", hash(settings_), options_.precision.error, options_.precision.maxFrames);
    const std::string key =
        fmt::format("{:016x}", fingerprint(std::as_bytes(std::span(pixels)), fingerprint(std::string_view(text))));

    const std::filesystem::path file = options_.cache / (key + ".exr");
    std::optional<Reference> reference;
    if (!options_.cache.empty()) reference = readCached(file, key, settings_);
    if (!reference) {
        reference = trace();
        if (!reference) return nullptr;
        if (!options_.cache.empty()) {
            files::createFolder(options_.cache);
            image::write(file, reference->picture, metadataOf(*reference, key));
        }
    }
    return &made_.emplace(index, std::move(*reference)).first->second;
}

std::optional<Reference> References::trace()
{
    const uint64_t length = std::clamp<uint64_t>(options_.precision.maxFrames / BATCHES, 1, LONGEST_BATCH);
    const double wanted = options_.precision.error * options_.precision.error;
    tracer_->restart();
    const image::MeanPicture& mean = tracer_->mean();
    Reference reference;
    const auto reached = [&] { return mean.count() >= FIRST_CHECK && reference.error.relmse <= wanted; };
    while (!reached() && (mean.count() < FIRST_CHECK || reference.pathTraced < options_.precision.maxFrames)) {
        if (options_.stop()) return std::nullopt;
        while (!tracer_->step(length)) {
        }
        reference.pathTraced += length;
        if (mean.count() < 2) continue;
        reference.error = mean.ownError();
        const double cost = double(reference.pathTraced) / double(options_.precision.maxFrames);
        options_.progress(
            std::min(1.0, std::max(cost, reference.error.relmse > 0 ? wanted / reference.error.relmse : 1)));
    }
    reference.precise = reached();
    reference.picture = mean.mean();
    return reference;
}

} // namespace passes
