#include "passes/renderer.h"

#include "engine/base/check.h"
#include "engine/base/clock.h"
#include "engine/base/error.h"
#include "passes/camera_path.h"
#include "passes/estimator.h"
#include "shaders/shared/rows.h"

#include <algorithm>
#include <array>
#include <bit>

namespace passes
{

namespace
{

// SplitMix64's finalizer: every bit of the user's seed reaches every bit of the keys.
uint64_t mix(uint64_t z)
{
    z += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

constexpr const char* RAY_NAMES[] = {"primary", "bounce", "shadow", "replay", "reconnection"};
constexpr const char* SHIFT_NAMES[] = {"done", "ended", "joined-earlier", "not-joinable", "hidden", "dark"};
#define ADD_NAME(INDEX, NAME, SHADER) SHADER,
constexpr const char* STAGE_NAMES[] = {FRAME_STAGES(ADD_NAME)};
#undef ADD_NAME
static_assert(std::size(RAY_NAMES) == shared::RAY_KINDS && std::size(SHIFT_NAMES) == shared::SHIFT_OUTCOMES &&
              std::size(STAGE_NAMES) == shared::STAGE_COUNT);

// Neighbors see alike light as far as the picture's detail allows, so by default the radius follows its height: an
// 18th, measured with 72 lines (tests/bench/LOG.md).
float neighborRadius(const Settings& settings)
{
    return settings.spatialRadius > 0 ? settings.spatialRadius : std::max(2.0f, float(settings.height) / 18);
}

} // namespace

uint64_t sumOf(const std::map<std::string, uint64_t>& counts)
{
    uint64_t sum = 0;
    for (const auto& [name, count] : counts) sum += count;
    return sum;
}

Renderer::Renderer(gpu::Device& device, const scene::Scene& scene, const Settings& settings,
                   const SceneOptions& options, uint32_t runs)
    : device_(device), settings_(settings), runs_(runs)
{
    const scene::Camera& camera = scene.cameras[chooseCamera(scene, settings.camera)];
    createBuffers(); // first: a picture too large for the device is said so before a long build
    scene_ = std::make_shared<SceneOnDevice>(device, scene, camera, options);
    setCamera(camera);
    frame_.previousCamera = frame_.camera;
    createStages();
}

Renderer::Renderer(const Renderer& sibling, const Settings& settings, uint32_t runs)
    : device_(sibling.device_), settings_(settings), runs_(runs), scene_(sibling.scene_),
      sceneSeconds_(sibling.sceneSeconds_)
{
    if (scene_->moves()) scene_ = std::make_shared<SceneOnDevice>(*scene_);
    CHECK(settings.environment == sibling.settings_.environment);
    CHECK(settings.environmentScale == sibling.settings_.environmentScale);
    createBuffers();
    frame_.camera = frame_.previousCamera = sibling.frame_.camera;
    frame_.world = lastWorld_ = sibling.frame_.world;
    createStages();
}

void Renderer::createBuffers()
{
    frameUniform_ =
        device_.createBuffer({.label = "Frame", .size = sizeof(shared::FrameUniform), .usage = gpu::Usage::Uniform});
    counters_ =
        device_.createBuffer({.label = "Counters", .size = uint64_t{shared::COUNTER_COUNT} * 2 * sizeof(uint32_t)});
    buffers_ = {}; // before there are new ones: both may be more than there is memory for
    buffers_ = FrameBuffers(device_, settings_, runs_);

    frame_.width = settings_.width;
    frame_.height = pictureHeight();
    frame_.runHeight = settings_.height;
    if (settings_.method != Method::Pt) {
        const Estimator& estimator = estimatorOf(settings_.method);
        for (size_t c = 0; c < estimator.target.size(); ++c) {
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
    frame_.colorConfidence = settings_.colorConfidence;
    frame_.neighborCount = settings_.spatial;
    frame_.neighborRadius = neighborRadius(settings_);
}

void Renderer::createStages()
{
    hitsFrom_.reset();
    reproject_ = {};
    compileSeconds_ = 0;
    plan_ = framePlan(*scene_, settings_, runs_);
    stages_.clear();
    stages_.resize(plan_.size());
    for (size_t i = 0; i < plan_.size(); ++i)
        if (plan_[i].runs({})) planned(i); // what the first frame runs; others when they are first needed
}

const Stage& Renderer::planned(size_t i)
{
    if (!stages_[i]) stages_[i] = makeStage(plan_[i].shader, plan_[i].variant);
    return *stages_[i];
}

void Renderer::recompile()
{
    wait();
    createStages();
    reset();
}

std::unique_ptr<Stage> Renderer::makeStage(const std::string& name, const Variant& variant, const NamedBuffers& more)
{
    const auto start = Clock::now();
    const StageContext context{.device = device_,
                               .pipelines = *scene_->pipelines,
                               .scene = *scene_->tables,
                               .variant = variant,
                               .frame = {{"Frame", &frameUniform_}, {"Counters", &counters_}}};
    NamedBuffers all = buffers_.named();
    all.insert(all.end(), more.begin(), more.end());
    auto stage = std::make_unique<Stage>(context, name, all);
    compileSeconds_ += secondsSince(start);
    return stage;
}

// Does every pixel of this frame see the same point as from there?
bool Renderer::seesTheSame(const std::optional<shared::CameraUniform>& from) const
{
    using Bits = std::array<uint32_t, sizeof(shared::CameraUniform) / sizeof(uint32_t)>;
    return scene_->viewRepeats(settings_) && from && std::bit_cast<Bits>(frame_.camera) == std::bit_cast<Bits>(*from);
}

void Renderer::apply(const Settings& settings)
{
    const Change change = changeBetween(settings_, settings);
    wait();
    settings_ = settings;
    if (change < Change::Compile) {
        tune();
    } else {
        createBuffers();
        createStages();
    }
    if (change >= Change::Reset) reset();
}

// Stage by stage, as framePlan() lists them.
void Renderer::encodeFrame(gpu::CommandEncoder& encoder, const FrameState& state)
{
    for (size_t i = 0; i < plan_.size(); ++i)
        if (plan_[i].runs(state)) planned(i).encode(encoder, plan_[i].threads);
}

void Renderer::renderFrame()
{
    frame_.frame = nextFrame_++;
    frame_.previousSlice = frame_.slice;
    CHECK(hasPose_);
    moved_ = frame_.world != lastWorld_;
    const FrameState state{.hitsKnown = seesTheSame(hitsFrom_),
                           .history = settings_.temporal && historyFrames_ > 0,
                           .sameView = !moved_ && seesTheSame(frame_.previousCamera),
                           .moved = moved_};
    if (!state.hitsKnown) frame_.slice = 1 - frame_.slice;
    hitsFrom_ = frame_.camera;
    device_.queue().writeValue(frameUniform_, frame_);
    gpu::CommandEncoder encoder = device_.createCommandEncoder("frame");
    if (frameCount_ == 0) {
        encoder.clear(buffers_["Film"]);
        encoder.clear(counters_);
    }
    encodeFrame(encoder, state);
    inFlight_.push_back(device_.queue().submit(std::move(encoder)));
    frame_.previousCamera = frame_.camera;
    lastWorld_ = frame_.world;
    ++frameCount_;
    ++historyFrames_;
    if (inFlight_.size() > 2) finishOldest();
}

void Renderer::reset()
{
    wait();
    nextFrame_ = 0;
    frameCount_ = 0;
    historyFrames_ = 0;
    frame_.previousCamera = frame_.camera;
    lastWorld_ = frame_.world;
    milliseconds_.clear();
    timedFrames_ = 0;
}

void Renderer::setCamera(const scene::Camera& camera)
{
    frame_.camera = scene_->uniformOf(camera, double(settings_.width) / double(settings_.height));
}

void Renderer::setScene(const scene::Scene& posed, double seconds)
{
    CHECK(scene_->moves());
    if (sceneSeconds_ == seconds) return;
    const uint32_t world = 1 - lastWorld_; // the other one belongs to the last frame, and may be asked once more
    scene_->show(world, posed);
    frame_.world = world;
    sceneSeconds_ = seconds;
    if (hasPose_)
        hitsFrom_.reset();
    else
        lastWorld_ = world; // the first pose is that of the last frame, if there was one: restore()
    hasPose_ = true;
}

void Renderer::wait()
{
    while (!inFlight_.empty()) finishOldest();
}

void Renderer::finishOldest()
{
    const gpu::Submission frame = inFlight_.front();
    inFlight_.pop_front();
    device_.queue().wait(frame);
    for (const gpu::Timing& timing : device_.queue().takeTimings(frame))
        milliseconds_[timing.label] += timing.milliseconds;
    ++timedFrames_;
}

image::Image Renderer::read(const Output& output)
{
    image::Image picture{.width = settings_.width, .height = pictureHeight()};
    const std::vector<glm::vec4> rows = device_.queue().readAs<glm::vec4>(buffers_[output.buffer]);
    const double frames = output.sums ? double(std::max<uint64_t>(frameCount_, 1)) : 1;
    const double scale = 1 / ((output.light ? scene_->radianceScale : 1) * frames);
    for (size_t i = 0; i < rows.size(); i += output.sums ? shared::FILM_ROWS : shared::COLOR_ROWS) {
        glm::dvec3 value(rows[i]);
        if (output.sums) value -= glm::dvec3(rows[i + 1]);
        picture.pixels.emplace_back(value * scale);
    }
    return picture;
}

std::vector<uint32_t> Renderer::readPreviousPixels()
{
    CHECK_LE(uint64_t{2}, frameCount_);
    CHECK_EQ(frame_.world, lastWorld_); // else the frame before the last one's is overwritten
    wait();
    std::unique_ptr<Stage>& reproject = reproject_[moved_ ? 1 : 0];
    if (!reproject) {
        const uint64_t pixels = uint64_t{settings_.width} * settings_.height;
        if (!reproject_[0] && !reproject_[1])
            previousPixels_ = device_.createBuffer({.label = "PreviousPixels",
                                                    .size = std::max<uint64_t>(pixels, 4) * sizeof(uint32_t),
                                                    .setting = "--size"});
        Variant between = variant();
        between.BETWEEN_WORLDS = moved_;
        reproject = makeStage("reproject", between, {{"PreviousPixels", &previousPixels_}});
    }
    gpu::CommandEncoder encoder = device_.createCommandEncoder("reproject");
    reproject->encode(encoder, {settings_.width, settings_.height});
    device_.queue().wait(device_.queue().submit(std::move(encoder)));
    std::vector<uint32_t> list = device_.queue().readAs<uint32_t>(previousPixels_);
    list.resize(size_t{settings_.width} * settings_.height); // the buffer may be larger
    return list;
}

RenderStats Renderer::stats()
{
    wait();
    RenderStats stats{.tablesSeconds = scene_->tablesSeconds,
                      .bvhSeconds = scene_->bvh.buildSeconds,
                      .compileSeconds = compileSeconds_,
                      .bvh = scene_->bvh,
                      .lights = scene_->lights,
                      .memoryBytes = device_.allocatedBytes(),
                      .sceneBytes = scene_->tables->bytes(),
                      .bytesPerPixel = double(bytesPerPixel(settings_)),
                      .reservoirBytes = bytesPerReservoir(settings_),
                      .variant = describe(plan_.front().variant)};
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
    stats.mutations = {{"proposed", counter(shared::COUNTER_PROPOSED)},
                       {"accepted", counter(shared::COUNTER_ACCEPTED)}};
    stats.treesPerPixel = held > 0 ? double(counter(shared::COUNTER_TREES)) / double(held) : 0;
    return stats;
}

std::vector<const gpu::Buffer*> Renderer::lastingBuffers() const
{
    std::vector<const gpu::Buffer*> list = buffers_.lasting();
    list.insert(list.begin(), &counters_);
    return list;
}

RendererState Renderer::save()
{
    wait();
    RendererState state{.frames = frameCount_,
                        .historyFrames = historyFrames_,
                        .camera = frame_.camera,
                        .previousCamera = frame_.previousCamera};
    for (const gpu::Buffer* buffer : lastingBuffers()) {
        std::vector<std::byte> bytes = device_.queue().read(*buffer);
        if (buffer == &buffers_["Surfaces"] && frame_.slice == 1) // the last frame's half goes first
            std::rotate(bytes.begin(), bytes.begin() + std::ptrdiff_t(bytes.size() / 2), bytes.end());
        state.buffers.emplace_back(buffer->label(), std::move(bytes));
    }
    return state;
}

void Renderer::restore(const RendererState& state)
{
    const std::vector<const gpu::Buffer*> buffers = lastingBuffers();
    if (state.buffers.size() != buffers.size())
        throw Error("A state of {} buffers does not fit a renderer that keeps {}.", state.buffers.size(),
                    buffers.size());
    for (size_t i = 0; i < buffers.size(); ++i) {
        const auto& [name, bytes] = state.buffers[i];
        if (name != buffers[i]->label() || bytes.size() != buffers[i]->size())
            throw Error("A state with {} bytes of \"{}\" does not fit a renderer with {} bytes of \"{}\".",
                        bytes.size(), name, buffers[i]->size(), buffers[i]->label());
    }
    reset();
    for (size_t i = 0; i < buffers.size(); ++i) device_.queue().write(*buffers[i], state.buffers[i].second);
    frameCount_ = state.frames;
    nextFrame_ = uint32_t(frameCount_);
    historyFrames_ = state.historyFrames;
    frame_.camera = state.camera;
    frame_.previousCamera = state.previousCamera;
    hasPose_ = !scene_->moves();
    sceneSeconds_.reset();
    frame_.slice = 0; // save() has put the last frame's half of surfaces_ there
    hitsFrom_.reset();
    if (frameCount_ > 0 && std::ranges::find(buffers, &buffers_["Surfaces"]) != buffers.end())
        hitsFrom_ = state.previousCamera;
}

} // namespace passes
