#include "tests/hunt/stand.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/scene/scene_tables.h"
#include "engine/scene/shapes.h"
#include "tests/support/reference_tracer.h"

namespace hunt
{

namespace
{

constexpr uint32_t PIXELS_AT_ONCE = 1u << 14; // small dispatches cost more than they do

uint32_t batchOf(const passes::Settings& settings, uint32_t pixelsAtOnce)
{
    return std::clamp(pixelsAtOnce / (settings.width * settings.height), 1u, 1024u);
}

passes::Settings pathTracing(passes::Settings settings)
{
    settings.method = passes::Method::Pt;
    settings.frames = 1;
    return settings;
}

} // namespace

Stand::Stand(gpu::Device& device, const std::shared_ptr<passes::PipelinePool>& pipelines, const Case& c)
    : case_(c), cameraAt_(passes::cameraOrbit(c.scene.cameras.at(0), c.orbit)),
      trial_(std::make_unique<passes::Renderer>(device, c.onTrial(), c.settings,
                                                passes::SceneOptions{.pipelines = pipelines, .moves = !c.moves.empty()},
                                                batchOf(c.settings, PIXELS_AT_ONCE)))
{
    for (uint32_t frame = 0; !c.moves.empty() && frame < c.settings.frames; ++frame) poses_.push_back(c.sceneIn(frame));
}

double Stand::chancesPerRun() const
{
    const passes::Settings& s = case_.settings;
    // Of what moves, frames before the last may have seen nothing.
    return s.method == passes::Method::Pt || !s.temporal || !case_.moves.empty()
               ? 1
               : double(std::min(s.frames, s.maxConfidence));
}

void Stand::take(passes::Renderer& renderer, const TakeRun& takeRun)
{
    const image::Image all = renderer.read(passes::LAST_FRAME);
    const size_t pixels = size_t{case_.settings.width} * case_.settings.height;
    for (size_t at = 0; at < all.pixels.size(); at += pixels) takeRun(std::span(all.pixels).subspan(at, pixels));
}

void Stand::runs(uint64_t seed, uint64_t count, const TakeRun& takeRun)
{
    passes::Settings settings = case_.settings;
    for (uint64_t done = 0; done < count; done += batch()) {
        settings.seed = Draw::mix(seed + done);
        showFrame(0);
        trial_->apply(settings);
        trial_->reset();
        for (uint32_t frame = 0; frame < settings.frames; ++frame) {
            showFrame(frame);
            trial_->renderFrame();
        }
        take(*trial_, takeRun);
        for (const auto& [stage, values] : trial_->stats().nonFinite) nonFinite_[stage] += values;
    }
}

void Stand::showFrame(uint32_t frame)
{
    trial_->setCamera(cameraAt_(frame));
    if (poses_.empty()) return;
    // While nothing moves the world stays the same one, as where an animation pauses.
    const auto amounts = [&](uint32_t of) {
        std::vector<float> list;
        for (const Move& move : case_.moves) list.push_back(move.amount(case_.settings.frames - 1 - of));
        return list;
    };
    uint32_t since = frame;
    while (since > 0 && amounts(since - 1) == amounts(frame)) --since;
    trial_->setScene(poses_[frame], since);
}

void Stand::frames(uint64_t seed, uint64_t count, const TakeRun& takeRun)
{
    if (!truth_) {
        const passes::Settings settings = pathTracing(case_.settings);
        const uint32_t runs = batchOf(settings, PIXELS_AT_ONCE);
        // Of a scene that moves the truth is a scene that never did, and in the truth all is stored where it is.
        truth_ = poses_.empty() && !case_.stores
                     ? std::make_unique<passes::Renderer>(*trial_, settings, runs)
                     : std::make_unique<passes::Renderer>(trial_->device(),
                                                          poses_.empty() ? case_.scene : poses_.back(), settings,
                                                          passes::SceneOptions{.pipelines = trial_->pipelines()}, runs);
    }
    passes::Settings settings = pathTracing(case_.settings);
    settings.seed = Draw::mix(seed);
    truth_->setCamera(cameraAt_(case_.settings.frames - 1));
    truth_->apply(settings);
    truth_->reset();
    for (uint64_t done = 0; done < count; done += truth_->runs()) {
        truth_->renderFrame();
        take(*truth_, takeRun);
    }
    for (const auto& [stage, values] : truth_->stats().nonFinite) nonFinite_[stage] += values;
}

namespace
{

// A camera that looks past what pixel centers look at exactly, by a ten thousandth of a pixel: more than float32
// rounds.
scene::Scene lookingAside(const Case& c, int way)
{
    scene::Scene scene = c.scene;
    scene::Camera& camera = scene.cameras.at(0);
    camera = passes::cameraOrbit(camera, c.orbit)(c.settings.frames - 1);
    const double pixel =
        1e-4 * 2 / double(c.settings.height) * (camera.orthographic ? camera.ymag : std::tan(camera.yfov / 2));
    constexpr double WAYS[4][2] = {{0.71, 0.37}, {-0.43, 0.83}, {-0.67, -0.31}, {0.41, -0.89}};
    const glm::dvec3 aside = pixel * (WAYS[way][0] * camera.right + WAYS[way][1] * camera.up);
    if (camera.orthographic) {
        camera.position += aside;
    } else {
        camera.forward = glm::normalize(camera.forward + aside);
        camera.right = glm::normalize(camera.right - glm::dot(camera.right, camera.forward) * camera.forward);
        camera.up = glm::cross(camera.right, camera.forward);
    }
    return scene;
}

} // namespace

namespace
{

// Calls visit(probability that the path tracer picks it, kind, index) for each light.
template <class Visit>
void eachLight(const scene::Scene& scene, Visit&& visit)
{
    const scene::SceneTables tables = scene::makeSceneTables(scene, UINT64_MAX);
    for (uint32_t i = 0; i < tables.uniform.lightCount; ++i) {
        const glm::uvec4 row = tables.sceneData[tables.uniform.lightOffset - tables.environment.size() + i];
        visit(double(std::bit_cast<float>(row.z)), row.w & 3u, row.w >> 2u);
    }
}

void darken(scene::Scene& scene, uint32_t kind, uint32_t index)
{
    if (kind == shared::LIGHT_ENVIRONMENT) {
        scene.environment = {};
    } else if (kind == shared::LIGHT_TRIANGLE) {
        scene::Material dark = scene.materials[scene.triangles[index].material];
        dark.emission = glm::vec3(0);
        scene.triangles[index].material = scene::addMaterial(scene, dark);
    } else {
        scene.lights[index].intensity = glm::vec3(0);
    }
}

} // namespace

double Stand::leastPick() const
{
    double least = 1;
    eachLight(case_.scene, [&](double pick, uint32_t, uint32_t) { least = std::min(least, pick); });
    return least;
}

support::PixelEstimates Stand::reference(uint64_t seed, uint64_t samples, double leastPick) const
{
    scene::Scene scene = lookingAside(case_, int(seed % 4));
    if (leastPick > 0)
        eachLight(case_.scene, [&](double pick, uint32_t kind, uint32_t index) {
            if (pick < leastPick) darken(scene, kind, index);
        });
    return support::reference(scene, case_.settings, samples, Draw::mix(seed));
}

std::vector<bool> Stand::undefinedPixels() const
{
    constexpr uint64_t SAMPLES = 16;
    std::vector<bool> undefined(size_t{case_.settings.width} * case_.settings.height);
    if (case_.settings.pixelFilter != passes::PixelFilter::Center) return undefined;
    const support::PixelEstimates first = support::reference(lookingAside(case_, 0), case_.settings, SAMPLES, 1);
    for (int way = 1; way < 4; ++way) {
        const support::PixelEstimates other = support::reference(lookingAside(case_, way), case_.settings, SAMPLES, 1);
        for (size_t i = 0; i < undefined.size(); ++i)
            for (size_t c = 0; c < 3; ++c) {
                const double a = first.pixels[i][c].mean, b = other.pixels[i][c].mean;
                if (std::abs(a - b) > 1e-3 * std::max(a, b)) undefined[i] = true;
            }
    }
    return undefined;
}

} // namespace hunt
