#include "ui/window/render_thread.h"

#include "engine/base/error.h"
#include "engine/scene/motion.h"
#include "passes/camera_path.h"
#include "ui/cli/scene_source.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <unistd.h>
#include <utility>

namespace ui
{

namespace
{

using namespace std::chrono_literals;

constexpr int BACKGROUND = 5;          // nice: the window's thread comes first where the device is the CPU
constexpr auto WATCH_INTERVAL = 300ms; // between looks at the shaders

// At rest it costs what a scene without animations does; else the renderers are made for all its times.
std::vector<uint32_t> animationsOf(const scene::Scene& scene, const Order& order)
{
    return order.scene.atRest() ? std::vector<uint32_t>() : chosenAnimations(scene, order.scene);
}

passes::Playback playbackOf(const Order& order, std::vector<uint32_t> animations)
{
    const double start = order.scene.time.value_or(0);
    if (order.playing) return order.play.playback(std::move(animations), start);
    return {.animations = std::move(animations), .start = start, .step = 0, .loop = false};
}

} // namespace

RenderThread::RenderThread(std::function<gpu::Device()> open, const std::string& shaders, std::function<void()> wake)
    : open_(std::move(open)), shaderDirectory_(shaders), wake_(std::move(wake)), compiler_(open_, [this] {
          {
              const std::lock_guard lock(mutex_);
              news_ = true;
          }
          changed_.notify_all();
          wake_();
      })
{
    if (!shaders.empty()) watcher_.emplace(shaders);
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void RenderThread::order(const Order& order)
{
    const std::lock_guard lock(mutex_);
    if (order == wanted_) return;
    wanted_ = order;
    news_ = true;
    changed_.notify_all();
}

std::string RenderThread::activity() const
{
    const std::lock_guard lock(mutex_);
    return activity_.empty() && pending_ ? compiler_.activity() : activity_;
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

void RenderThread::run(const std::stop_token& stop)
{
    // On Linux a thread's own; the threads of a CPU driver inherit it. Not being allowed to is no failure.
    [[maybe_unused]] const int niceness = nice(BACKGROUND);
    while (true) {
        Order order;
        {
            std::unique_lock lock(mutex_);
            const auto due = [&] {
                const bool idle = !sides_[A] || (running_.paused && running_.steps >= wanted_.steps &&
                                                 (!studies_.busy() || running_.playing));
                return news_ || !idle;
            };
            if (watcher_)
                changed_.wait_for(lock, stop, WATCH_INTERVAL, due);
            else
                changed_.wait(lock, stop, due);
            if (stop.stop_requested()) break;
            order = wanted_;
            news_ = false;
        }
        try {
            reloadShaders();
            follow(order);
        } catch (const std::bad_alloc&) {
            fail("Out of memory.");
        } catch (const Error& error) {
            fail(error.what());
        }
    }
    closeDevice();
}

void RenderThread::closeDevice()
{
    compiler_.serve(nullptr);
    studies_.clear();
    for (std::unique_ptr<Contender>& side : sides_) side.reset();
    device_.reset();
}

bool RenderThread::sameWorld(const Order& order) const
{
    const passes::Settings &next = order.settings, &now = running_.settings;
    SceneSource atThatTime = running_.scene;
    if (atThatTime.time && order.scene.time) atThatTime.time = order.scene.time;
    if (order.scene != atThatTime || passes::changeBetween(now, next) == passes::Change::Reload) return false;
    const auto parallel = [&](const std::string& name) { // what is compiled depends on it
        return scene_->cameras[passes::chooseCamera(*scene_, name)].orthographic;
    };
    return next.camera == now.camera || parallel(next.camera) == parallel(now.camera);
}

void RenderThread::follow(const Order& order)
{
    if (order.scene.name.empty()) return;
    if (!device_) {
        say("Opening the device");
        device_ = std::make_unique<gpu::Device>(open_());
        compiler_.serve(device_.get());
    }
    {
        const std::lock_guard lock(mutex_);
        pending_ = false;
    }
    if (!sides_[A] || !sameWorld(order))
        load(order);
    else
        pose(order), tune(order, A);
    tune(order, B);
    {
        const std::lock_guard lock(mutex_);
        if (!pending_) good_ = order;
    }
    const bool changed = order != running_;
    if (changed) compileAhead(order);
    say("");
    advance(order);
    renderAndPublish(order, changed);
    study(order);
}

// The old pictures stay until the new ones are there.
void RenderThread::load(const Order& order)
{
    say("Loading the scene");
    auto world = std::make_unique<scene::Scene>(
        openScene(order.scene, order.settings, [&](const std::string& what, double fraction) {
            say(fmt::format("{}: {:.0f}%", what, 100 * fraction));
        }));
    say("Building the BVH");
    int shown = -1;
    const auto progress = [&](double fraction) {
        const int percent = int(100 * fraction);
        if (percent != shown) say(fmt::format("Building the BVH: {}%", shown = percent));
        if (percent >= 100) say("Compiling");
    };
    const passes::Settings settings = settingsOf(order, A);
    const passes::Playback playback = playbackOf(order, animationsOf(*world, order));
    const bool moves = !playback.animations.empty();
    if (moves) scene::pose(*world, {}, 0); // what renderers are made of
    auto renderer = std::make_unique<passes::Renderer>(
        *device_, *world, settings,
        passes::SceneOptions{.bvhProgress = progress,
                             .pipelines = sides_[A] ? sides_[A]->renderer().pipelines() : nullptr,
                             .moves = moves});
    if (moves) {
        const double seconds = playback.secondsAt(0, *world->motion);
        scene::pose(*world, playback.animations, seconds);
        renderer->setScene(*world, seconds);
    }
    studies_.clear();
    sides_[B].reset(); // of the old scene
    sides_[A] = std::make_unique<Contender>(std::move(renderer), *world, order, A);
    scene_ = std::move(world);
    playback_ = playback;
    first_ = shown_ = order.frame;
    compiler_.learn(passes::stagesOf(sides_[A]->renderer().scene(), {&settings, 1}));
    SceneFacts facts{.name = order.scene.name, .origin = scene_->origin, .warnings = scene_->warnings};
    if (scene_->motion)
        for (const scene::Animation& animation : scene_->motion->animations)
            facts.animations.push_back({animation.name, animation.fault, animation.seconds});
    const std::lock_guard lock(mutex_);
    sceneFacts_ = std::make_shared<const SceneFacts>(facts);
}

// Where the order says another time, or another way to play, that is shown from the first frame on.
void RenderThread::pose(const Order& order)
{
    const bool same = order.scene.time == running_.scene.time && order.playing == running_.playing &&
                      (!order.playing || (order.play == running_.play && order.plays == running_.plays));
    if (same) return;
    begin(playbackOf(order, playback_.animations), order.frame);
}

// Frame `first` of the timeline is the first one of both sides, and shows what `playback` starts with. Throws Error,
// and leaves all as it was: the scene has no pose at that time.
void RenderThread::begin(const passes::Playback& playback, uint64_t first)
{
    bring(playback, 0, first);
    playback_ = playback;
    first_ = first;
    for (const std::unique_ptr<Contender>& side : sides_)
        if (side) side->startOver();
}

// Throws Error, and leaves the scene as it was: it has no pose at that time.
void RenderThread::bring(const passes::Playback& playback, uint64_t frame, uint64_t first)
{
    const std::optional<double> before = sides_[A]->renderer().sceneSeconds();
    const std::optional<double> seconds =
        moves() ? playback.secondsAt(int64_t(frame), *scene_->motion) : std::optional<double>();
    try {
        if (seconds != before) scene::pose(*scene_, playback.animations, *seconds);
    } catch (const Error&) {
        scene::pose(*scene_, playback.animations, *before);
        throw;
    }
    shown_ = first + frame;
    for (const std::unique_ptr<Contender>& side : sides_)
        if (side) side->show(*scene_, seconds, shown_);
}

// While it plays the next frame is the next one of the timeline, and both sides show it. When one of them starts over
// so does the other, there: frame f of both shows playback_.secondsAt(f), seen from where the path is at first_ + f,
// which `render` repeats.
void RenderThread::advance(const Order& order)
{
    if (!order.playing) return;
    const std::optional<double> shown = sides_[A]->renderer().sceneSeconds();
    if (sides_[A]->frames() == 0 || (sides_[B] && sides_[B]->frames() == 0)) {
        passes::Playback here = playback_;
        here.start = shown.value_or(0);
        begin(here, shown_);
        return;
    }
    if (order.paused && order.steps <= running_.steps) return;
    try {
        bring(playback_, sides_[A]->frames(), first_);
    } catch (const Error&) {
        const std::lock_guard lock(mutex_);
        good_.playing = false;
        good_.scene.time = shown;
        good_.frame = shown_;
        throw;
    }
}

// A side whose new settings are not compiled yet goes on with the old ones.
void RenderThread::tune(const Order& order, Side side)
{
    std::unique_ptr<Contender>& contender = sides_[side];
    if (side == B && !order.rival) {
        contender.reset();
        publish(B, nullptr);
        return;
    }
    passes::Renderer& renderer = sides_[A]->renderer();
    const passes::Settings next = settingsOf(order, side);
    const bool runs = contender && contender->runs(order);
    if (!runs && !compiler_.ready(stagesFor(order, side, renderer))) {
        const std::lock_guard lock(mutex_);
        pending_ = true;
        return;
    }
    compiler_.handOver(*renderer.pipelines());
    if (contender)
        contender->follow(order, *scene_);
    else
        contender =
            std::make_unique<Contender>(std::make_unique<passes::Renderer>(renderer, next), *scene_, order, side);
}

// Only while camera and scene rest, and when all that the sides need is compiled.
void RenderThread::study(const Order& order)
{
    {
        const std::lock_guard lock(mutex_);
        if (pending_) return;
    }
    if (order.moving || order.playing) return;
    passes::Renderer& like = sides_[A]->renderer();
    const CompileAhead::Stages stages = Studies::stagesFor(order, like);
    if (!stages.empty() && !compiler_.ready(stages)) return;
    compiler_.handOver(*like.pipelines());
    bool news = false;
    try {
        news = studies_.follow(order, like, *scene_);
    } catch (const Error&) { // of memory: what is studied is given up, the pictures go on
        studies_.clear();
        const std::lock_guard lock(mutex_);
        findings_ = studies_.findings();
        good_.studies = {};
        throw;
    }
    try {
        news |= studies_.step();
    } catch (const Error& error) {
        closeDevice();
        throw Error("{} R opens the device again.", error.what());
    }
    if (!news) return;
    {
        const std::lock_guard lock(mutex_);
        findings_ = studies_.findings();
    }
    wake_();
}

// What one more click would ask for, the likeliest first.
void RenderThread::compileAhead(const Order& order)
{
    const passes::Settings settings = settingsOf(order, A);
    std::vector<passes::Settings> others;
    using passes::Method, passes::Shift;
    for (const Method method : {Method::RgbRestir, Method::RestirPt, Method::Pt}) {
        others.push_back(settings);
        others.back().method = method;
    }
    for (const Shift shift : {Shift::Hybrid, Shift::Reconnection, Shift::Replay}) {
        passes::Settings& other = others.emplace_back(settings);
        if (other.method == Method::Pt) other.method = Method::RgbRestir;
        other.shift = shift;
    }
    const passes::SceneOnDevice& scene = sides_[A]->renderer().scene();
    passes::StageList stages;
    if (scene.moves()) stages = passes::stagesOf(scene, {&settings, 1}, false, true);
    std::ranges::move(passes::stagesOf(scene, {&settings, 1}, true), std::back_inserter(stages)); // a moved camera
    std::ranges::move(passes::stagesOf(scene, others), std::back_inserter(stages));
    compiler_.later(stages);
}

void RenderThread::reloadShaders()
{
    if (!watcher_ || !sides_[A]) return;
    if (watcher_->changed()) {
        compiler_.forget();
        reload_ = true;
    }
    if (!reload_) return;
    try {
        std::vector<passes::Settings> settings;
        for (const std::unique_ptr<Contender>& side : sides_)
            if (side) settings.push_back(side->renderer().settings());
        passes::Renderer& renderer = sides_[A]->renderer();
        if (!compiler_.ready(passes::stagesOf(renderer.scene(), settings))) return;
        reload_ = false;
        passes::PipelinePool& pool = *renderer.pipelines();
        pool.clear();
        compiler_.handOver(pool);
        for (const std::unique_ptr<Contender>& side : sides_)
            if (side) side->recompile();
    } catch (const Error& error) {
        reload_ = false;
        throw Error("The shaders in \"{}\" have changed and do not compile; the old ones go on. {}", shaderDirectory_,
                    error.what());
    }
}

void RenderThread::renderAndPublish(const Order& order, bool changed)
{
    const bool step = order.steps > running_.steps, once = order.paused || order.moving || order.playing;
    running_ = order;
    try {
        for (const Side side : {A, B}) {
            if (!sides_[side]) continue;
            Contender& contender = *sides_[side];
            const Contender* other = sides_[side == A ? B : A].get();
            const bool behind = !other || contender.seconds() <= other->seconds(); // both get the same time
            const bool due = once ? !order.paused || step : behind;
            if (due || contender.frames() == 0) contender.render(once);
            if (due || changed || contender.frames() == 1) publish(side, contender.shot(order));
        }
    } catch (const Error& error) {
        closeDevice();
        throw Error("{} R opens the device again.", error.what());
    }
    wake_();
}

void RenderThread::publish(Side side, ShotPointer shot)
{
    const std::lock_guard lock(mutex_);
    shots_[side] = std::move(shot);
}

} // namespace ui
