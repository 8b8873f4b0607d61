#include "passes/renderer.h"

#include "engine/base/check.h"
#include "engine/base/fingerprint.h"
#include "passes/camera_choice.h"
#include "passes/estimator.h"

#include <array>
#include <bit>
#include <cmath>

namespace passes
{

namespace
{

double secondsSince(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// SplitMix64's finalizer: every bit of the user's seed reaches every bit of the keys.
uint64_t mix(uint64_t z)
{
    z += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

shared::CameraUniform makeCameraUniform(const scene::Camera& camera, double lengthScale, double aspect)
{
    const double height = camera.orthographic ? camera.ymag * lengthScale : std::tan(camera.yfov / 2);
    const auto vector = [](const glm::dvec3& v) { return glm::vec4(glm::vec3(v), 0.0f); };
    return {.position = vector(camera.position * lengthScale),
            .right = vector(camera.right * height * aspect),
            .up = vector(camera.up * height),
            .forward = vector(camera.forward)};
}

constexpr const char* RAY_NAMES[] = {"primary", "bounce", "shadow", "replay", "reconnection"};
constexpr const char* SHIFT_NAMES[] = {"done", "ended", "joined-earlier", "not-joinable", "hidden", "dark"};
constexpr const char* STAGE_NAMES[] = {"primary",       "path_trace",     "canonical", "temporal",
                                       "spatial_trace", "spatial_gather", "accumulate"};
static_assert(std::size(RAY_NAMES) == shared::RAY_KINDS && std::size(SHIFT_NAMES) == shared::SHIFT_OUTCOMES &&
              std::size(STAGE_NAMES) == shared::STAGE_COUNT);

// Bytes of one reservoir in one of the two sets (shaders/restir/reservoir_store.glsl).
constexpr uint64_t RESERVOIR_WORD_BYTES = 2 * sizeof(glm::uvec4);
constexpr uint64_t RESERVOIR_PATH_BYTES = 3 * sizeof(glm::uvec4);

// Of one pixel, in each buffer.
struct PixelBytes {
    uint64_t surfaces = 2 * sizeof(glm::uvec4), color = sizeof(glm::vec4), film = 2 * sizeof(glm::vec4);
    uint64_t words = 0, paths = 0; // of each of the two sets of reservoirs
    uint64_t neighbors = 0, shifted = 0, mergedColor = 0;
};

PixelBytes pixelBytes(const Settings& settings)
{
    PixelBytes bytes;
    if (settings.method == Method::Pt) return bytes;
    const uint64_t count = estimatorOf(settings.method).target.size();
    bytes.words = count * RESERVOIR_WORD_BYTES + sizeof(uint32_t);
    bytes.paths = settings.shift == Shift::Replay ? 0 : count * RESERVOIR_PATH_BYTES;
    bytes.neighbors = settings.spatial * sizeof(uint32_t);
    bytes.shifted = count * settings.spatial * sizeof(glm::vec4);
    bytes.mergedColor = colorReading(settings) == Color::Chosen ? 0 : sizeof(glm::vec4);
    return bytes;
}

// Neighbors see alike light as far as the picture's detail allows, so by default the radius follows its height: an
// 18th, measured with 72 lines (tests/bench/LOG.md).
float neighborRadius(const Settings& settings)
{
    return settings.spatialRadius > 0 ? settings.spatialRadius : std::max(2.0f, float(settings.height) / 18);
}

} // namespace

Renderer::Renderer(gpu::Device& device, const scene::Scene& scene, const Settings& settings,
                   const std::function<void(double)>& bvhProgress, scene::FeatureSet featureSet, uint32_t runs,
                   std::shared_ptr<PipelinePool> pipelines)
    : device_(device), settings_(settings), featureSet_(featureSet), runs_(runs),
      pipelines_(pipelines ? std::move(pipelines) : std::make_shared<PipelinePool>(device))
{
    const scene::Camera& camera = scene.cameras[chooseCamera(scene, settings.camera)];
    orthographic_ = camera.orthographic;
    createBuffers(); // first: a picture too large for the device is said so before a long build

    const auto start = std::chrono::steady_clock::now();
    const scene::SceneTables tables =
        scene::makeSceneTables(scene, device.limits().tableBytes, bvhProgress, featureSet);
    scene_ = std::make_shared<scene::GpuScene>(device, tables);
    stats_.bvhSeconds = tables.bvh.stats.buildSeconds;
    stats_.tablesSeconds = secondsSince(start) - stats_.bvhSeconds;
    stats_.bvh = tables.bvh.stats;
    stats_.lights = tables.lights;
    stats_.sceneBytes = scene_->bytes();
    lengthScale_ = tables.lengthScale;
    radianceScale_ = tables.radianceScale;
    sceneFeatures_ = tables.features;

    setCamera(camera);
    frame_.previousCamera = frame_.camera;
    const double scales[] = {lengthScale_, radianceScale_};
    sceneFingerprint_ = fingerprint(std::as_bytes(std::span(scales)), scene_->contents());
    sceneFingerprint_ = fingerprint(std::as_bytes(std::span(&frame_.camera, 1)), sceneFingerprint_);
    createStages();
}

Renderer::Renderer(const Renderer& sibling, const Settings& settings, uint32_t runs)
    : device_(sibling.device_), settings_(settings), featureSet_(sibling.featureSet_), runs_(runs),
      sceneFeatures_(sibling.sceneFeatures_), orthographic_(sibling.orthographic_), lengthScale_(sibling.lengthScale_),
      radianceScale_(sibling.radianceScale_), sceneFingerprint_(sibling.sceneFingerprint_), stats_(sibling.stats_),
      pipelines_(sibling.pipelines_), scene_(sibling.scene_)
{
    CHECK(settings.environment == sibling.settings_.environment);
    CHECK(settings.environmentScale == sibling.settings_.environmentScale);
    createBuffers();
    frame_.camera = frame_.previousCamera = sibling.frame_.camera;
    createStages();
}

uint32_t Renderer::maxRuns(const gpu::Limits& limits, const Settings& settings)
{
    const PixelBytes b = pixelBytes(settings);
    const uint64_t largest = std::max({b.surfaces, b.film, b.words, b.paths, b.shifted});
    const uint64_t pixels = uint64_t{settings.width} * settings.height;
    return uint32_t(std::min<uint64_t>(std::min(limits.storageBindingBytes, limits.tableBytes) / largest / pixels,
                                       UINT32_MAX / pixels));
}

void Renderer::createBuffers()
{
    const uint64_t pixels = uint64_t{settings_.width} * pictureHeight();
    stats_.bytesPerPixel = 0;
    const auto perPixel = [&](const char* label, uint64_t each, const char* setting = "--size") {
        stats_.bytesPerPixel += double(each);
        // Whole rows of 16 bytes; one, too, where this method does not use what its stages declare. Stages that only
        // read take them as tables.
        return device_.createBuffer({.label = label,
                                     .size = std::max<uint64_t>((pixels * each + 15) / 16, 1) * 16,
                                     .usage = gpu::Usage::Storage | gpu::Usage::Table,
                                     .setting = setting});
    };
    frameUniform_ =
        device_.createBuffer({.label = "Frame", .size = sizeof(shared::FrameUniform), .usage = gpu::Usage::Uniform});
    counters_ =
        device_.createBuffer({.label = "Counters", .size = uint64_t{shared::COUNTER_COUNT} * 2 * sizeof(uint32_t)});
    const PixelBytes bytes = pixelBytes(settings_);
    surfaces_ = perPixel("Surfaces", bytes.surfaces);
    color_ = perPixel("Color", bytes.color);
    film_ = perPixel("Film", bytes.film);

    const bool resamples = settings_.method != Method::Pt;
    const uint64_t count = resamples ? estimatorOf(settings_.method).target.size() : 0;
    stats_.reservoirBytes = resamples ? 2 * double(bytes.words + bytes.paths) / double(count) : 0;
    reservoirs_ = perPixel("Reservoirs", bytes.words);
    history_ = perPixel("History", bytes.words);
    reservoirPaths_ = perPixel("ReservoirPaths", bytes.paths, "--size or --shift");
    historyPaths_ = perPixel("HistoryPaths", bytes.paths, "--size or --shift");
    neighbors_ = perPixel("Neighbors", bytes.neighbors, "--size or --spatial");
    shifted_ = perPixel("Shifted", bytes.shifted, "--size or --spatial");
    mergedColor_ = perPixel("MergedColor", bytes.mergedColor, "--size or --color");

    frame_.width = settings_.width;
    frame_.height = pictureHeight();
    frame_.runHeight = settings_.height;
    if (resamples) {
        const Estimator& estimator = estimatorOf(settings_.method);
        for (size_t c = 0; c < count; ++c) {
            frame_.target[c] = glm::vec4(estimator.target[c], 0);
            frame_.resolve[c] = glm::vec4(estimator.resolve[c], 0);
        }
    }
    tune();
}

void Renderer::tune()
{
    const uint64_t key = mix(settings_.seed);
    frame_.key0 = uint32_t(key);
    frame_.key1 = uint32_t(key >> 32);
    frame_.maxConfidence = settings_.maxConfidence;
    frame_.neighborCount = settings_.spatial;
    frame_.neighborRadius = neighborRadius(settings_);
}

void Renderer::createStages()
{
    variant_ = makeVariant(sceneFeatures_, settings_, orthographic_, scene_->stack());
    hitsFrom_.reset();
    stats_.variant = describe(variant_);
    stats_.compileSeconds = 0;
    const auto stage = [&](const char* name) { return makeStage(name, variant_); };
    primary_ = stage("primary");
    accumulate_ = stage("accumulate");
    for (std::unique_ptr<Stage>* other :
         {&pathTrace_, &canonical_, &temporalResting_, &temporalMoving_, &spatialTrace_, &spatialGather_, &reproject_})
        other->reset();
    if (settings_.method == Method::Pt) {
        pathTrace_ = stage("path_trace");
    } else {
        canonical_ = stage("canonical");
        if (settings_.spatial > 0) spatialTrace_ = stage("spatial_trace");
        spatialGather_ = stage("spatial_gather");
    }
}

void Renderer::recompile()
{
    wait();
    createStages();
    reset();
}

std::vector<std::pair<std::string, Variant>> Renderer::stagesFor(const Settings& settings, bool cameraMoves) const
{
    const Variant variant = makeVariant(sceneFeatures_, settings, orthographic_, scene_->stack());
    std::vector<std::pair<std::string, Variant>> list = {{"primary", variant}, {"accumulate", variant}};
    if (settings.method == Method::Pt) {
        list.emplace_back("path_trace", variant);
        return list;
    }
    list.emplace_back("canonical", variant);
    if (settings.temporal) {
        list.emplace_back("temporal", variant);
        list.back().second.SAME_VIEW = !cameraMoves && viewRepeats(settings);
    }
    if (settings.spatial > 0) list.emplace_back("spatial_trace", variant);
    list.emplace_back("spatial_gather", variant);
    return list;
}

std::unique_ptr<Stage> Renderer::makeStage(const std::string& name, const Variant& variant, const NamedBuffers& more)
{
    const auto start = std::chrono::steady_clock::now();
    const StageContext context{.device = device_,
                               .pipelines = *pipelines_,
                               .scene = *scene_,
                               .variant = variant,
                               .frame = {{"Frame", &frameUniform_}, {"Counters", &counters_}}};
    NamedBuffers all = {{"Surfaces", &surfaces_},
                        {"Color", &color_},
                        {"Film", &film_},
                        {"Reservoirs", &reservoirs_},
                        {"History", &history_},
                        {"ReservoirPaths", &reservoirPaths_},
                        {"Neighbors", &neighbors_},
                        {"HistoryPaths", &historyPaths_},
                        {"Shifted", &shifted_},
                        {"MergedColor", &mergedColor_},
                        {"PreviousPixels", &previousPixels_}};
    all.insert(all.end(), more.begin(), more.end());
    auto stage = std::make_unique<Stage>(context, name, all);
    stats_.compileSeconds += secondsSince(start);
    return stage;
}

// Does every pixel see the same point in each frame while the camera rests? This alone lets frames take over what an
// earlier one saw: not where rays go anywhere through the pixel, nor where surfaces exist by chance.
bool Renderer::viewRepeats(const Settings& settings) const
{
    return featureSet_ == scene::FeatureSet::Needed && settings.pixelFilter == PixelFilter::Center &&
           !sceneFeatures_.blend;
}

// Does every pixel of this frame see the same point as from there?
bool Renderer::seesTheSame(const std::optional<shared::CameraUniform>& from) const
{
    using Bits = std::array<uint32_t, sizeof(shared::CameraUniform) / sizeof(uint32_t)>;
    return viewRepeats(settings_) && from && std::bit_cast<Bits>(frame_.camera) == std::bit_cast<Bits>(*from);
}

// Compiled when first needed. Where each pixel sees the same point again, shifts between the two frames are identities,
// and left out.
const Stage& Renderer::temporal()
{
    const bool resting = seesTheSame(frame_.previousCamera);
    std::unique_ptr<Stage>& stage = resting ? temporalResting_ : temporalMoving_;
    if (!stage) {
        Variant variant = variant_;
        variant.SAME_VIEW = resting;
        stage = makeStage("temporal", variant);
    }
    return *stage;
}

void Renderer::apply(const Settings& settings)
{
    Settings rest = settings;
    const auto keep = [&](auto... field) { ((rest.*field = settings_.*field), ...); };
    keep(&Settings::maxConfidence, &Settings::spatialRadius, &Settings::temporal, &Settings::frames, &Settings::seconds,
         &Settings::average, &Settings::seed);
    const bool compiled = rest == settings_; // all that differs is not compiled in
    const bool reseeded = settings.seed != settings_.seed;
    wait();
    settings_ = settings;
    if (compiled) {
        tune();
        if (reseeded) reset();
        return;
    }
    createBuffers();
    createStages();
    reset();
}

// The paper's four stages, between what a pixel sees and what the film keeps.
void Renderer::encodeFrame(gpu::CommandEncoder& encoder)
{
    const gpu::Threads pixels = {settings_.width, pictureHeight()};
    if (!hitsKnown_) primary_->encode(encoder, pixels);
    if (pathTrace_) pathTrace_->encode(encoder, pixels);
    if (canonical_) canonical_->encode(encoder, pixels);
    if (settings_.temporal && canonical_ && historyFrames_ > 0) temporal().encode(encoder, pixels);
    if (spatialTrace_) spatialTrace_->encode(encoder, {pixels.x * settings_.spatial, pixels.y});
    if (spatialGather_) spatialGather_->encode(encoder, pixels);
    accumulate_->encode(encoder, pixels);
}

void Renderer::renderFrame()
{
    frame_.frame = uint32_t(frameCount_);
    frame_.previousSlice = frame_.slice;
    hitsKnown_ = seesTheSame(hitsFrom_);
    if (!hitsKnown_) frame_.slice = 1 - frame_.slice;
    hitsFrom_ = frame_.camera;
    device_.queue().writeValue(frameUniform_, frame_);
    gpu::CommandEncoder encoder = device_.createCommandEncoder("frame");
    if (frameCount_ == 0) {
        encoder.clear(film_);
        encoder.clear(counters_);
    }
    encodeFrame(encoder);
    inFlight_.push_back(device_.queue().submit(std::move(encoder)));
    frame_.previousCamera = frame_.camera;
    ++frameCount_;
    ++historyFrames_;
    if (inFlight_.size() > 2) {
        device_.queue().wait(inFlight_.front());
        inFlight_.pop_front();
        collectTimings();
    }
}

void Renderer::reset()
{
    wait();
    frameCount_ = 0;
    historyFrames_ = 0;
    frame_.previousCamera = frame_.camera;
    milliseconds_.clear();
    timedFrames_ = 0;
}

void Renderer::setCamera(const scene::Camera& camera)
{
    frame_.camera = makeCameraUniform(camera, lengthScale_, double(settings_.width) / double(settings_.height));
}

void Renderer::wait()
{
    if (!inFlight_.empty()) device_.queue().wait(inFlight_.back());
    inFlight_.clear();
    collectTimings();
}

void Renderer::collectTimings()
{
    for (const gpu::Timing& timing : device_.queue().takeTimings()) {
        milliseconds_[timing.label] += timing.milliseconds;
        timedFrames_ += timing.label == "accumulate"; // the last stage of every frame
    }
}

image::Image Renderer::readColor()
{
    return settings_.average ? readMean() : readFrame();
}

image::Image Renderer::readFrame()
{
    image::Image picture{.width = settings_.width, .height = pictureHeight()};
    for (const glm::vec4& value : device_.queue().readAs<glm::vec4>(color_))
        picture.pixels.emplace_back(glm::dvec3(value) / radianceScale_);
    return picture;
}

image::Image Renderer::readMean()
{
    image::Image picture{.width = settings_.width, .height = pictureHeight()};
    const std::vector<glm::vec4> film = device_.queue().readAs<glm::vec4>(film_);
    const double scale = 1 / (radianceScale_ * double(std::max<uint64_t>(frameCount_, 1)));
    for (size_t i = 0; i < film.size(); i += 2) // the carry is what the sum has too much
        picture.pixels.emplace_back((glm::dvec3(film[i]) - glm::dvec3(film[i + 1])) * scale);
    return picture;
}

std::vector<uint32_t> Renderer::readPreviousPixels()
{
    CHECK_LE(uint64_t{2}, frameCount_);
    wait();
    if (!reproject_) {
        const uint64_t pixels = uint64_t{settings_.width} * settings_.height;
        previousPixels_ = device_.createBuffer(
            {.label = "PreviousPixels", .size = std::max<uint64_t>(pixels, 4) * sizeof(uint32_t), .setting = "--size"});
        reproject_ = makeStage("reproject", variant_);
    }
    gpu::CommandEncoder encoder = device_.createCommandEncoder("reproject");
    reproject_->encode(encoder, {settings_.width, settings_.height});
    inFlight_.push_back(device_.queue().submit(std::move(encoder)));
    wait();
    std::vector<uint32_t> list = device_.queue().readAs<uint32_t>(previousPixels_);
    list.resize(size_t{settings_.width} * settings_.height); // the buffer may be larger
    return list;
}

RenderStats Renderer::stats()
{
    wait();
    RenderStats stats = stats_;
    for (const auto& [stage, sum] : milliseconds_)
        stats.stageMilliseconds[stage] = timedFrames_ > 0 ? sum / double(timedFrames_) : 0;
    const std::vector<uint32_t> words = device_.queue().readAs<uint32_t>(counters_);
    const auto counter = [&](size_t i) { return uint64_t{words[2 * i]} | uint64_t{words[2 * i + 1]} << 32; };
    for (size_t i = 0; i < std::size(RAY_NAMES); ++i) stats.rays[RAY_NAMES[i]] = counter(i);
    for (size_t i = 0; i < std::size(SHIFT_NAMES); ++i)
        stats.shifts[SHIFT_NAMES[i]] = counter(shared::COUNTER_SHIFT + i);
    for (size_t i = 0; i < std::size(STAGE_NAMES); ++i)
        stats.nonFinite[STAGE_NAMES[i]] = counter(shared::COUNTER_NONFINITE + i);
    const uint64_t held = counter(shared::COUNTER_HELD);
    stats.treesPerPixel = held > 0 ? double(counter(shared::COUNTER_TREES)) / double(held) : 0;
    stats.memoryBytes = device_.allocatedBytes();
    return stats;
}

} // namespace passes
