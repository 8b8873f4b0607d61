#include "ui/window/render_thread.h"

#include "engine/base/error.h"
#include "passes/camera_choice.h"
#include "ui/cli/scene_source.h"

#include <algorithm>
#include <chrono>
#include <unistd.h>

namespace ui
{

namespace
{

using Clock = std::chrono::steady_clock;

constexpr uint32_t MOVING_DIVISOR = 2;       // of width and height while the camera moves
constexpr double PUBLISH_SECONDS = 1.0 / 60; // no more pictures than a screen shows
constexpr int BACKGROUND = 5;                // nice: the window's thread comes first where the device is the CPU

double secondsSince(Clock::time_point start)
{
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// What is on the device for the settings: a part of the resolution while the camera moves.
passes::Settings effective(const Order& order)
{
    passes::Settings settings = order.settings;
    if (order.moving) {
        settings.width = std::max(settings.width / MOVING_DIVISOR, 1u);
        settings.height = std::max(settings.height / MOVING_DIVISOR, 1u);
    }
    return settings;
}

// Settings that only say which picture is read, or when `render` stops.
passes::Settings withoutReading(passes::Settings settings)
{
    settings.average = true;
    settings.frames = 1;
    settings.seconds = 0;
    return settings;
}

bool sameWorld(const Order& a, const Order& b)
{
    return a.scene == b.scene && a.settings.environment == b.settings.environment &&
           a.settings.environmentScale == b.settings.environmentScale;
}

uint64_t sumOf(const std::map<std::string, uint64_t>& counts)
{
    uint64_t sum = 0;
    for (const auto& [name, count] : counts) sum += count;
    return sum;
}

} // namespace

RenderThread::RenderThread(const DeviceOptions& device, std::function<void()> wake)
    : deviceOptions_(device), wake_(std::move(wake)), thread_([this] { run(); })
{
}

RenderThread::~RenderThread()
{
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

void RenderThread::order(const Order& order)
{
    {
        const std::lock_guard lock(mutex_);
        if (order == wanted_) return;
        wanted_ = order;
        news_ = true;
    }
    changed_.notify_all();
}

std::shared_ptr<const Shot> RenderThread::shot() const
{
    const std::lock_guard lock(mutex_);
    return shot_;
}

std::shared_ptr<const SceneFacts> RenderThread::scene() const
{
    const std::lock_guard lock(mutex_);
    return sceneFacts_;
}

std::string RenderThread::activity() const
{
    const std::lock_guard lock(mutex_);
    return activity_;
}

std::optional<std::string> RenderThread::takeFailure(Order& back)
{
    const std::lock_guard lock(mutex_);
    if (failure_) back = good_;
    return std::exchange(failure_, std::nullopt);
}

void RenderThread::say(const std::string& activity)
{
    {
        const std::lock_guard lock(mutex_);
        if (activity_ == activity) return;
        activity_ = activity;
    }
    wake_();
}

// What still stands goes on; the window is told, and orders what stands.
void RenderThread::fail(const std::string& sentence)
{
    {
        const std::lock_guard lock(mutex_);
        failure_ = sentence;
        if (!news_) wanted_ = good_;
        activity_.clear();
    }
    wake_();
}

void RenderThread::run()
{
    // On Linux a thread's own; the threads of a CPU driver inherit it. Not being allowed to is no failure.
    [[maybe_unused]] const int niceness = nice(BACKGROUND);
    while (true) {
        Order order;
        {
            std::unique_lock lock(mutex_);
            changed_.wait(lock, [&] {
                const bool idle = !renderer_ || (running_.paused && running_.steps >= wanted_.steps);
                return stop_ || news_ || !idle;
            });
            if (stop_) break;
            order = wanted_;
            news_ = false;
        }
        try {
            follow(order);
        } catch (const std::bad_alloc&) {
            fail("Out of memory.");
        } catch (const Error& error) {
            fail(error.what());
        }
    }
    renderer_.reset();
    device_.reset();
}

void RenderThread::follow(const Order& order)
{
    if (order.scene.empty()) return;
    if (!device_) {
        say("Opening the device");
        device_ = std::make_unique<gpu::Device>(deviceOptions_.open());
    }
    if (!renderer_ || !sameWorld(order, running_))
        load(order);
    else
        tune(order);
    {
        const std::lock_guard lock(mutex_);
        good_ = order;
    }
    const bool step = order.steps > running_.steps;
    const bool due = !order.paused || step || renderer_->frameCount() == 0;
    running_ = order;
    say("");
    if (due) renderAndPublish(order);
}

// The old renderer stays until the new one is there.
void RenderThread::load(const Order& order)
{
    say("Loading the scene");
    auto world = std::make_unique<scene::Scene>(
        openScene(order.scene, order.settings, [&](const std::string& what, double fraction) {
            say(fmt::format("{}: {:.0f}%", what, 100 * fraction));
        }));
    say("Building the BVH");
    int shown = -1;
    auto renderer = std::make_unique<passes::Renderer>(*device_, *world, effective(order), [&](double fraction) {
        const int percent = int(100 * fraction);
        if (percent != shown) say(fmt::format("Building the BVH: {}%", shown = percent));
        if (percent >= 100) say("Compiling");
    });
    renderer_ = std::move(renderer);
    scene_ = std::move(world);
    place(order);
    const SceneFacts facts{order.scene, scene_->cameras, scene_->origin, scene_->warnings};
    {
        const std::lock_guard lock(mutex_);
        sceneFacts_ = std::make_shared<const SceneFacts>(facts);
    }
    raysBefore_ = 0;
}

// Anything that changes the estimate starts over: a mean over two settings would be the picture of neither, and no
// command line could repeat it. While the camera moves, reuse goes on from frame to frame.
void RenderThread::tune(const Order& order)
{
    const passes::Settings next = effective(order), now = renderer_->settings();
    const bool cameraChanged = order.pose != running_.pose || next.camera != now.camera;
    const bool settingsChanged = withoutReading(next) != withoutReading(now);
    if (next.camera != now.camera) {
        const auto kind = [&](const std::string& name) {
            return scene_->cameras[passes::chooseCamera(*scene_, name)].orthographic;
        };
        if (kind(next.camera) != kind(now.camera)) {
            load(order); // what is compiled depends on the kind of camera
            return;
        }
    }
    if (next != now) {
        if (settingsChanged) say("Compiling for " + passes::toText(next).front().second);
        try {
            renderer_->apply(next);
        } catch (...) {
            renderer_->apply(now); // such as a picture too large for the device
            throw;
        }
    }
    if (cameraChanged || next.width != now.width || next.height != now.height) place(order);
    const bool stands = !order.moving && (cameraChanged || running_.moving);
    if (settingsChanged || stands || order.restarts != running_.restarts) {
        renderer_->reset();
        raysBefore_ = 0;
    }
}

void RenderThread::place(const Order& order)
{
    const scene::Camera& base = scene_->cameras[passes::chooseCamera(*scene_, order.settings.camera)];
    renderer_->setCamera(order.pose ? cameraOf(*order.pose, base, scene_->origin) : base);
}

void RenderThread::renderAndPublish(const Order& order)
{
    const auto start = Clock::now();
    const uint64_t before = renderer_->frameCount();
    const bool once = order.paused || order.moving;
    try {
        do renderer_->renderFrame(), renderer_->wait();
        while (!once && secondsSince(start) < PUBLISH_SECONDS);

        auto shot = std::make_shared<Shot>();
        shot->single = order.moving || !order.settings.average;
        shot->picture = shot->single ? renderer_->readFrame() : renderer_->readMean();
        shot->order = order;
        shot->order.settings = renderer_->settings();
        shot->frames = renderer_->frameCount();
        shot->stats = renderer_->stats();
        shot->adapter = device_->adapter();
        const double seconds = secondsSince(start);
        const uint64_t rays = sumOf(shot->stats.rays);
        shot->frameMilliseconds = 1000 * seconds / double(shot->frames - before);
        shot->raysPerSecond = double(rays - std::min(rays, raysBefore_)) / seconds;
        raysBefore_ = rays;
        const std::lock_guard lock(mutex_);
        shot_ = std::move(shot);
    } catch (const Error&) {
        renderer_.reset(); // a lost device: the next order tries with a new one
        device_.reset();
        throw;
    }
    wake_();
}

} // namespace ui
