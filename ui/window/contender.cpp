#include "ui/window/contender.h"

#include "engine/base/clock.h"

#include <algorithm>
#include <iterator>

namespace ui
{

namespace
{

constexpr uint32_t MOVING_DIVISOR = 2;       // of width and height while the camera moves
constexpr double PUBLISH_SECONDS = 1.0 / 60; // no more pictures than a screen shows

} // namespace

std::vector<std::pair<std::string, std::string>> poseText(const Shot& shot)
{
    SceneSource scene = shot.order.scene;
    if (shot.order.playing) scene.time = shot.firstSeconds;
    std::vector<std::pair<std::string, std::string>> text = scene.toText();
    Play play = shot.order.play;
    if (!shot.order.playing) play.speed = 0, play.loop = false;
    if (shot.sceneSeconds) std::ranges::move(play.toText(), std::back_inserter(text));
    return text;
}

bool followsPath(const Order& order)
{
    return order.playing && order.path && !order.pose;
}

passes::Settings settingsOf(const Order& order, Side side)
{
    const passes::Settings& world = order.settings;
    passes::Settings settings = side == B && order.rival ? *order.rival : world;
    passes::copy(settings, world, {passes::Role::Scene, passes::Role::View});
    if (order.moving) {
        settings.width = std::max(settings.width / MOVING_DIVISOR, 1u);
        settings.height = std::max(settings.height / MOVING_DIVISOR, 1u);
    }
    return settings;
}

passes::StageList stagesFor(const Order& order, Side side, const passes::Renderer& renderer)
{
    const passes::Settings settings = settingsOf(order, side);
    const bool cameraMoves = order.moving || followsPath(order), sceneMoves = order.playing && renderer.scene().moves();
    passes::StageList stages = passes::stagesOf(renderer.scene(), {&settings, 1}, cameraMoves, sceneMoves);
    const passes::Variant variant = renderer.scene().variant(settings);
    const bool resamples = settings.method != passes::Method::Pt;
    if (order.inspect.reservoirs && resamples) stages.emplace_back("inspect", variant);
    if (order.inspect.shifts && resamples && settings.spatial > 0) stages.emplace_back("inspect_shifts", variant);
    if (order.inspect.pixel) stages.emplace_back("inspect_path", variant);
    return stages;
}

Contender::Contender(std::unique_ptr<passes::Renderer> renderer, const scene::Scene& scene, const Order& order,
                     Side side)
    : renderer_(std::move(renderer)), side_(side), followed_(order)
{
    place(order, scene);
    startOver();
}

void Contender::follow(const Order& order, const scene::Scene& scene)
{
    const passes::Settings next = settingsOf(order, side_), now = renderer_->settings();
    const auto pathOf = [](const Order& one) { return followsPath(one) ? one.path : nullptr; };
    const bool cameraChanged =
        order.pose != followed_.pose || next.camera != now.camera || pathOf(order) != pathOf(followed_);
    if (cameraChanged) cameraAt_ = {};
    const bool settingsChanged = passes::changeBetween(now, next) > passes::Change::Nothing;
    if (next != now) {
        inspector_.reset(); // its stage is over buffers that apply() may replace
        try {
            renderer_->apply(next);
        } catch (...) {
            renderer_->apply(now);
            throw;
        }
    }
    if (cameraChanged || next.width != now.width || next.height != now.height) place(order, scene);
    const bool stands = !order.moving && (cameraChanged || followed_.moving);
    if (settingsChanged || stands || order.restarts != followed_.restarts) startOver();
    followed_ = order;
}

bool Contender::runs(const Order& order) const
{
    return renderer_->settings() == settingsOf(order, side_) && order.inspect == followed_.inspect;
}

void Contender::recompile()
{
    inspector_.reset();
    renderer_->recompile();
    startOver();
}

void Contender::startOver()
{
    static uint64_t runs = 0; // of all contenders, which live in one thread
    run_ = ++runs;
    renderer_->reset();
    raysBefore_ = 0;
    seconds_ = 0;
}

void Contender::place(const Order& order, const scene::Scene& scene)
{
    const scene::Camera& base = scene.cameras[passes::chooseCamera(scene, order.settings.camera)];
    if (followsPath(order) && !cameraAt_) cameraAt_ = passes::cameraPath(*order.path, base, scene.origin);
    camera_ = order.pose ? cameraOf(*order.pose, base, scene.origin) : followsPath(order) ? cameraAt_(frame_) : base;
    renderer_->setCamera(camera_);
}

void Contender::show(const scene::Scene& posed, std::optional<double> seconds, uint64_t frame)
{
    if (seconds) renderer_->setScene(posed, *seconds);
    frame_ = frame;
    place(followed_, posed);
}

void Contender::render(bool once)
{
    const auto start = Clock::now();
    const uint64_t before = frames();
    if (before == 0) firstSeconds_ = renderer_->sceneSeconds(), firstFrame_ = frame_;
    do renderer_->renderFrame(), renderer_->wait();
    while (!once && secondsSince(start) < PUBLISH_SECONDS);
    const double seconds = secondsSince(start);
    seconds_ += seconds;
    const uint64_t rays = passes::sumOf(renderer_->stats().rays);
    frameMilliseconds_ = 1000 * seconds / double(frames() - before);
    raysPerSecond_ = double(rays - std::min(rays, raysBefore_)) / seconds;
    raysBefore_ = rays;
}

ShotPointer Contender::shot(const Order& order)
{
    auto shot = std::make_shared<Shot>();
    shot->single = order.moving || order.playing || !renderer_->settings().average;
    shot->picture = renderer_->read(shot->single ? passes::LAST_FRAME : passes::MEAN);
    shot->order = order;
    shot->order.settings = renderer_->settings();
    shot->camera = camera_;
    shot->sceneSeconds = renderer_->sceneSeconds();
    shot->firstSeconds = firstSeconds_;
    shot->firstFrame = firstFrame_;
    shot->run = run_;
    shot->frames = frames();
    shot->seconds = seconds_;
    shot->stats = renderer_->stats();
    shot->adapter = renderer_->device().adapter();
    shot->frameMilliseconds = frameMilliseconds_;
    shot->raysPerSecond = raysPerSecond_;
    inspect(*shot);
    return shot;
}

void Contender::inspect(Shot& shot)
{
    const Inspect& wanted = followed_.inspect;
    if (wanted == Inspect{}) inspector_.reset();
    if (wanted == Inspect{} || frames() == 0) return;
    if (!inspector_) inspector_ = std::make_unique<passes::Inspector>(*renderer_);
    if (wanted.reservoirs) shot.reservoirs = inspector_->reservoirs();
    if (wanted.shifts) shot.shifts = inspector_->shifts();
    if (!wanted.pixel) return;
    const passes::Settings &full = followed_.settings, &now = renderer_->settings(); // smaller while the camera moves
    const uint32_t x = std::min((*wanted.pixel)[0] * now.width / full.width, now.width - 1);
    const uint32_t y = std::min((*wanted.pixel)[1] * now.height / full.height, now.height - 1);
    shot.paths = inspector_->paths(y * now.width + x);
}

} // namespace ui
