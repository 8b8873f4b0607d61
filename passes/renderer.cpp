#include "passes/renderer.h"

#include "passes/camera_choice.h"

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
constexpr const char* STAGE_NAMES[] = {"primary",       "path_trace",     "canonical", "temporal",
                                       "spatial_trace", "spatial_gather", "accumulate"};
static_assert(std::size(RAY_NAMES) == shared::COUNTER_NONFINITE && std::size(STAGE_NAMES) == shared::STAGE_COUNT);

} // namespace

Renderer::Renderer(gpu::Device& device, const scene::Scene& scene, const Settings& settings,
                   const std::function<void(double)>& bvhProgress, Features features)
    : device_(device), settings_(settings)
{
    requireImplemented(settings);
    const scene::Camera& camera = scene.cameras[chooseCamera(scene, settings.camera)];

    const auto start = std::chrono::steady_clock::now();
    const scene::SceneTables tables = scene::makeSceneTables(scene, device.limits().tableBytes, bvhProgress);
    scene_ = std::make_unique<scene::GpuScene>(device, tables);
    stats_.bvhSeconds = tables.bvh.stats.buildSeconds;
    stats_.tablesSeconds = secondsSince(start) - stats_.bvhSeconds;
    stats_.bvh = tables.bvh.stats;
    stats_.lights = tables.lights;
    stats_.sceneBytes = scene_->bytes();
    lengthScale_ = tables.lengthScale;
    radianceScale_ = tables.radianceScale;
    variant_ = features == Features::Needed ? makeVariant(tables.features, settings, camera.orthographic)
                                            : fullVariant(settings, camera.orthographic);
    stats_.variant = describe(variant_);

    const uint64_t pixels = uint64_t{settings.width} * settings.height;
    const auto perPixel = [&](const char* label, uint64_t bytes) {
        stats_.bytesPerPixel += double(bytes);
        return device.createBuffer({.label = label, .size = pixels * bytes, .setting = "--size"});
    };
    frameUniform_ =
        device.createBuffer({.label = "Frame", .size = sizeof(shared::FrameUniform), .usage = gpu::Usage::Uniform});
    counters_ = device.createBuffer({.label = "Counters", .size = shared::COUNTER_COUNT * 2 * sizeof(uint32_t)});
    surfaces_ = perPixel("Surfaces", 16);
    color_ = perPixel("Color", 16);
    film_ = perPixel("Film", 32);

    frame_.width = settings.width;
    frame_.height = settings.height;
    const uint64_t key = mix(settings.seed);
    frame_.key0 = uint32_t(key);
    frame_.key1 = uint32_t(key >> 32);
    setCamera(camera);
    frame_.previousCamera = frame_.camera;
    createStages();
}

void Renderer::createStages()
{
    const auto start = std::chrono::steady_clock::now();
    const StageContext context{.device = device_,
                               .scene = *scene_,
                               .variant = variant_,
                               .frame = {{"Frame", &frameUniform_}, {"Counters", &counters_}}};
    primary_ = std::make_unique<Stage>(context, "primary", NamedBuffers{{"Surfaces", &surfaces_}});
    pathTrace_ = std::make_unique<Stage>(context, "path_trace", NamedBuffers{{"Surfaces", &surfaces_}, {"Color", &color_}});
    accumulate_ = std::make_unique<Stage>(context, "accumulate", NamedBuffers{{"Color", &color_}, {"Film", &film_}});
    stats_.compileSeconds = secondsSince(start);
}

void Renderer::encodeFrame(gpu::CommandEncoder& encoder)
{
    const gpu::Threads pixels = {settings_.width, settings_.height};
    primary_->encode(encoder, pixels);
    pathTrace_->encode(encoder, pixels);
    accumulate_->encode(encoder, pixels);
}

void Renderer::renderFrame()
{
    frame_.frame = uint32_t(frameCount_);
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
    if (inFlight_.size() > 2) {
        device_.queue().wait(inFlight_.front());
        inFlight_.pop_front();
        collectTimings();
    }
}

void Renderer::reset() { frameCount_ = 0; }

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

image::Image Renderer::readColor() { return settings_.average ? readMean() : readFrame(); }

image::Image Renderer::readFrame()
{
    image::Image picture{.width = settings_.width, .height = settings_.height};
    for (const glm::vec4& value : device_.queue().readAs<glm::vec4>(color_))
        picture.pixels.emplace_back(glm::dvec3(value) / radianceScale_);
    return picture;
}

image::Image Renderer::readMean()
{
    image::Image picture{.width = settings_.width, .height = settings_.height};
    const std::vector<glm::vec4> film = device_.queue().readAs<glm::vec4>(film_);
    const double scale = 1 / (radianceScale_ * double(std::max<uint64_t>(frameCount_, 1)));
    for (size_t i = 0; i < film.size(); i += 2) // the carry is what the sum has too much
        picture.pixels.emplace_back((glm::dvec3(film[i]) - glm::dvec3(film[i + 1])) * scale);
    return picture;
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
    for (size_t i = 0; i < std::size(STAGE_NAMES); ++i)
        stats.nonFinite[STAGE_NAMES[i]] = counter(shared::COUNTER_NONFINITE + i);
    stats.memoryBytes = device_.allocatedBytes();
    return stats;
}

} // namespace passes
