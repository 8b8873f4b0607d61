#include "ui/window/window.h"

#include "engine/base/error.h"
#include "engine/base/files.h"
#include "engine/base/json.h"
#include "ui/cli/interrupt.h"
#include "ui/cli/output_file.h"
#include "ui/cli/presets.h"
#include "ui/window/camera_hands.h"
#include "ui/window/compare_room.h"
#include "ui/window/frame.h"
#include "ui/window/mouse.h"
#include "ui/window/panel.h"
#include "ui/window/path_room.h"
#include "ui/window/pixel_room.h"
#include "ui/window/plots.h"
#include "ui/window/presenter.h"
#include "ui/window/render_thread.h"
#include "ui/window/screenshot.h"
#include "ui/window/timeline_room.h"
#include "ui/window/undo_list.h"
#include "ui/window/window_report.h"

#include <algorithm>
#include <deque>
#include <filesystem>
#include <future>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui_impl_glfw.h>
#include <imgui_impl_vulkan.h>

namespace ui
{

namespace
{

constexpr double IDLE_SECONDS = 0.1; // between looks at the world when nothing happens
constexpr double LOSS_SECONDS = 10;  // a screen's device that is lost twice within this time is given up
constexpr size_t LATENCIES = 1000;   // that percentiles are taken of

using SettingsPair = std::pair<passes::Settings, std::optional<passes::Settings>>;

class Window
{
  public:
    explicit Window(const WindowOptions& options)
        : options_(options), memory_(recall(memoryFile())), frame_(memory_.size, memory_.layout),
          undo_({options.order.settings, options.order.rival}), meter_(glfwPostEmptyEvent),
          thread_([&device = options_.device] { return device.open(); }, options.device.shaderDirectory(),
                  glfwPostEmptyEvent)
    {
        state_.order = options.order;
        if (options.order.path) state_.start = options.order.scene.time.value_or(0); // as `render` has it
        state_.scale = frame_.scale;
        glfwSetWindowUserPointer(frame_.window, this);
        glfwSetDropCallback(frame_.window, [](GLFWwindow* window, int count, const char** files) {
            for (int i = 0; i < count; ++i) static_cast<Window*>(glfwGetWindowUserPointer(window))->open(files[i]);
        });
        // ImGui 1.86 does not see a key that goes down and up within one frame, and frames take long on a busy machine.
        glfwSetKeyCallback(frame_.window, [](GLFWwindow* window, int key, int, int action, int modifiers) {
            if (action == GLFW_PRESS)
                static_cast<Window*>(glfwGetWindowUserPointer(window))->state_.keys.push_back({key, modifiers});
        });
        glfwSetCursorPosCallback(frame_.window, [](GLFWwindow* window, double x, double y) {
            static_cast<Window*>(glfwGetWindowUserPointer(window))->mouse_.moved({float(x), float(y)});
        });
        glfwSetMouseButtonCallback(frame_.window, [](GLFWwindow* window, int button, int action, int) {
            static_cast<Window*>(glfwGetWindowUserPointer(window))->mouse_.turned(button, action == GLFW_PRESS);
        });
        ImGui_ImplGlfw_InitForVulkan(frame_.window, true); // after our own callbacks: it calls them too
        presenter_ = std::make_unique<Presenter>(frame_.window);
        if (!options.reference.empty()) loadReference(options.reference);
    }
    ~Window()
    {
        presenter_.reset();
        ImGui_ImplGlfw_Shutdown();
    }

    void run()
    {
        int hot = 3;
        while (!glfwWindowShouldClose(frame_.window) && !interrupt_.requested()) {
            const double waitStart = glfwGetTime();
            const double wait = hot > 0 ? 0.008 : IDLE_SECONDS;
            glfwWaitEventsTimeout(wait);
            const double now = glfwGetTime();
            const bool awake = now - waitStart < wait || mouse_.isBehind();
            hot = awake ? 3 : std::max(hot - 1, 0); // ImGui answers an event within a few frames
            drawOnce();
            latencies_.push_back(1000 * (glfwGetTime() - now));
            if (latencies_.size() > LATENCIES) latencies_.pop_front();
        }
        memory_.size = frame_.size();
        memory_.layout = Frame::layout();
        remember();
    }

  private:
    // A file that was dropped into the window, or chosen.
    void open(const std::string& file)
    {
        const std::string kind = files::extensionOf(file);
        if (kind == ".json") {
            usePreset(file);
        } else if (kind == ".exr" || kind == ".png" || kind == ".hdr" || kind == ".jpg" || kind == ".jpeg") {
            loadReference(file);
        } else {
            state_.order.scene = {.name = file, .assetRoot = state_.order.scene.assetRoot}; // at rest
            state_.order.playing = false;
            state_.order.frame = 0;
            state_.order.path.reset();
            state_.order.pose.reset();
            state_.start = 0;
            state_.order.settings.camera.clear();
        }
    }

    static std::string linesOf(const std::vector<std::string>& sentences)
    {
        return fmt::format("{}", fmt::join(sentences, "\n"));
    }

    // An Error is told to the person.
    template <class Work>
    void attempt(Work&& work)
    {
        try {
            work();
        } catch (const Error& error) {
            state_.message = error.what();
        }
    }

    void usePreset(const std::string& nameOrFile)
    {
        attempt([&] {
            applyPreset(state_.edited(), nameOrFile);
            state_.message = fmt::format("Preset \"{}\" is set.", nameOrFile);
        });
    }

    // Large files take their time: elsewhere.
    void loadReference(const std::string& file)
    {
        loading_ = std::async(std::launch::async, [file] {
            image::Loaded loaded = image::read(file);
            auto reference = std::make_shared<const Reference>(
                Reference{std::move(loaded.image), std::filesystem::path(file).filename().string()});
            glfwPostEmptyEvent();
            return std::pair(ReferencePointer(reference), std::move(loaded.warnings));
        });
    }

    void takeReference()
    {
        if (!loading_.valid() || loading_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
        attempt([&] {
            auto [reference, warnings] = loading_.get();
            setReference(std::move(reference));
            if (!warnings.empty()) state_.message = linesOf(warnings);
        });
    }

    void setReference(ReferencePointer reference)
    {
        state_.order.studies.reference = false;
        state_.pictures.reference = std::move(reference);
        if (state_.pictures.reference) showReference();
    }

    void showReference()
    {
        state_.plots = true;
        if (!state_.order.rival) state_.view.second = Source::Reference;
    }

    void freeze()
    {
        const ShotPointer shot = state_.pictures.shotOf(state_.view.left());
        if (!shot || shot->order.moving) return;
        if (shot->order.playing) {
            state_.message = "A reference is of a scene that rests: stop it first (T).";
            return;
        }
        const std::string name =
            fmt::format("{}, {} frames", passes::toText(shot->order.settings).front().second, shot->frames);
        setReference(std::make_shared<const Reference>(Reference{shot->picture, name}));
    }

    void readKeys()
    {
        const ImGuiIO& io = ImGui::GetIO();
        if (io.WantCaptureKeyboard && io.WantTextInput) return;
        for (const KeyPress& press : state_.keys) readKey(press);
    }

    void readKey(const KeyPress& press)
    {
        const auto pressed = [&](int key) { return press.key == key; };
        Requests& requests = state_.requests;
        if ((press.modifiers & GLFW_MOD_CONTROL) != 0) {
            if (pressed(GLFW_KEY_Z)) ((press.modifiers & GLFW_MOD_SHIFT) != 0 ? requests.redo : requests.undo) = true;
            if (pressed(GLFW_KEY_Y)) requests.redo = true;
            return;
        }
        if (pressed(GLFW_KEY_F1)) state_.help = !state_.help;
        if (pressed(GLFW_KEY_F11)) requests.film = true;
        if (pressed(GLFW_KEY_F12)) requests.screenshot = true;
        if (pressed(GLFW_KEY_HOME)) requests.resetView = true;
        if (pressed(GLFW_KEY_SPACE)) state_.order.paused = !state_.order.paused;
        if (pressed(GLFW_KEY_N)) state_.order.paused = true, ++state_.order.steps;
        if (pressed(GLFW_KEY_R)) ++state_.order.restarts;
        if (pressed(GLFW_KEY_T)) play(state_, !state_.order.playing);
        if (pressed(GLFW_KEY_M)) addKeyframe(state_);
        if (pressed(GLFW_KEY_COMMA)) stepScene(state_, -1);
        if (pressed(GLFW_KEY_PERIOD)) stepScene(state_, 1);
        if (pressed(GLFW_KEY_C)) compare(state_, !state_.order.rival);
        if (pressed(GLFW_KEY_TAB)) state_.view.flipped = !state_.view.flipped;
        if (pressed(GLFW_KEY_F)) requests.freeze = true;
        if (pressed(GLFW_KEY_P)) state_.plots = !state_.plots;
        if (pressed(GLFW_KEY_K)) state_.correlation = !state_.correlation;
        if (pressed(GLFW_KEY_I)) state_.pixel = !state_.pixel;
        if (pressed(GLFW_KEY_H)) state_.hidden = !state_.hidden;
        if (pressed(GLFW_KEY_X)) state_.view.falseColor = FalseColor((int(state_.view.falseColor) + 1) % FALSE_COLORS);
    }

    void saveShot()
    {
        const ShotPointer& shot = state_.pictures.sides[state_.editing];
        if (!shot || shot->order.moving) return;
        attempt([&] { giveLine("Saved", takeScreenshot(*shot)); });
    }

    void giveLine(const std::string& done, const std::string& line)
    {
        line_ = line;
        glfwSetClipboardString(frame_.window, line_.c_str());
        state_.message = fmt::format("{}; in the clipboard: {}", done, line_);
    }

    void makeFilm()
    {
        const ShotPointer& shot = state_.pictures.sides[state_.editing];
        if (!shot || shot->order.scene.name != state_.order.scene.name) return;
        const uint64_t frames = framesOfAll(state_);
        if (frames == 0) {
            state_.message = "Nothing moves that a film could show: play the scene's animations (T), if it has any, or "
                             "add keyframes (M).";
            return;
        }
        const std::optional<double> start = sceneMoves(state_) ? std::optional(startOfScene(state_)) : std::nullopt;
        attempt([&] { giveLine("Ready to render", prepareFilm(*shot, state_.order, frames, start)); });
    }

    void keepPath()
    {
        if (!state_.order.path) return;
        attempt([&] {
            state_.message = fmt::format("Saved as {}; view --camera-path plays it.", savePath(state_.order.path));
        });
    }

    void answerRequests()
    {
        const Requests requests = std::exchange(state_.requests, {});
        const auto restore = [&](const std::optional<SettingsPair>& pair) {
            if (!pair) return;
            std::tie(state_.order.settings, state_.order.rival) = *pair;
            if (!state_.order.rival) state_.editing = A;
        };
        if (requests.undo) restore(undo_.undo());
        if (requests.redo) restore(undo_.redo());
        undo_.watch({state_.order.settings, state_.order.rival}, !ImGui::IsAnyItemActive());
        state_.canUndo = undo_.canUndo();
        state_.canRedo = undo_.canRedo();
        if (!requests.file.empty()) open(requests.file);
        if (!requests.preset.empty()) usePreset(requests.preset);
        if (requests.freeze) freeze();
        if (requests.dropReference) setReference(nullptr);
        if (requests.converge) state_.order.studies.reference = true, state_.plots = true;
        if (requests.resetView) CameraHands::reset(state_.order);
        if (requests.screenshot) saveShot();
        if (requests.film) makeFilm();
        if (requests.savePath) keepPath();
    }

    void remember()
    {
        const std::string file = memoryFile();
        if (!file.empty()) attempt([&] { keep(memory_, file); });
    }

    // Where the picture fits beside the panel, in pixels of the framebuffer.
    Rectangle pictureArea() const
    {
        if (!state_.pictures.sides[A]) return {};
        int width = 0, height = 0;
        glfwGetFramebufferSize(frame_.window, &width, &height);
        const int left = std::min(int(state_.panelWidth()), width);
        height = std::max(height - int(timelineHeight(state_)), 0);
        const passes::Settings& full = state_.order.settings;
        const double scale = std::min(double(width - left) / full.width, double(height) / full.height);
        const int w = int(full.width * scale), h = int(full.height * scale);
        return {left + (width - left - w) / 2, (height - h) / 2, w, h};
    }

    void hover(const Rectangle& area)
    {
        const ImVec2 mouse = ImGui::GetIO().MousePos;
        const double x = (double(mouse.x) - area.x) / area.width, y = (double(mouse.y) - area.y) / area.height;
        state_.area = {area.x, area.y, area.width, area.height};
        if (area.width <= 0 || ImGui::GetIO().WantCaptureMouse || !(x >= 0 && x < 1 && y >= 0 && y < 1)) return;
        const passes::Settings& full = state_.order.settings;
        state_.inspected = {uint32_t(x * full.width), uint32_t(y * full.height)};
    }

    void takeNews()
    {
        Order back;
        if (const std::optional<std::string> failure = thread_.takeFailure(back)) {
            state_.message = *failure;
            back.steps = state_.order.steps;
            back.restarts = state_.order.restarts;
            state_.order = back;
            if (!back.rival) state_.editing = A;
            if (!back.studies.correlation) state_.correlation = false; // they may be what failed
            if (!back.studies.floor && state_.view.falseColor == FalseColor::Floor)
                state_.view.falseColor = FalseColor::Off;
        }
        takeReference();
        state_.findings = thread_.findings();
        for (const Side side : {A, B}) {
            state_.pictures.sides[side] = thread_.shot(side);
            state_.pictures.floors[side] = state_.findings->floors[side];
        }
        if (state_.order.studies.reference && state_.pictures.reference != state_.findings->reference) {
            const bool first = !state_.pictures.reference && state_.findings->reference;
            state_.pictures.reference = state_.findings->reference;
            if (first) showReference();
        }
        state_.activity = thread_.activity();
        state_.ahead = thread_.ahead();
        if (const std::shared_ptr<const SceneFacts> facts = thread_.scene(); facts != state_.facts) takeScene(facts);
    }

    // What was said of the scene before goes with it.
    void takeScene(const std::shared_ptr<const SceneFacts>& facts)
    {
        const std::string before = state_.facts ? linesOf(state_.facts->warnings) : "", now = linesOf(facts->warnings);
        if (!now.empty() || state_.message == before) state_.message = now;
        state_.facts = facts;
        if (facts->animations.empty() && !state_.order.path) state_.order.playing = false;
        memory_.opened(std::filesystem::exists(facts->name) ? std::filesystem::absolute(facts->name).string()
                                                            : facts->name);
        state_.recent = memory_.recent;
        remember();
    }

    // Looks at every pixel, so only when there is something new.
    void updateLegend()
    {
        if (legendOf_ == std::pair(state_.pictures, state_.view)) return;
        legendOf_ = {state_.pictures, state_.view};
        const View& view = state_.view;
        const ShotPointer shot = state_.pictures.shotOf(view.left());
        state_.legend.clear();
        if (shot && view.falseColor != FalseColor::Off)
            state_.legend = legendOf(*shot, state_.pictures.floorOf(view.left()), view.falseColor, view.reservoir);
    }

    void drawOnce()
    {
        ImGui_ImplVulkan_NewFrame();
        ImGui_ImplGlfw_NewFrame();
        mouse_.play(ImGui::GetIO());
        ImGui::NewFrame();
        state_.places.clear();
        takeNews();
        updateLegend();
        const Rectangle area = pictureArea();
        hover(area);
        drawPanel(state_);
        drawHelp(state_);
        drawTimeline(state_);
        stopAtTheEnd(state_);
        drawPixel(state_);
        drawErrorPlot(state_, meter_);
        drawCorrelationPlot(state_);
        const bool mouseTaken = drawOverPicture(state_, {float(area.x), float(area.y)},
                                                {float(area.x + area.width), float(area.y + area.height)});
        readKeys();
        hands_.move(state_, mouseTaken);
        if (hands_.bookmarks(state_, memory_)) remember();
        state_.keys.clear();
        answerRequests();
        state_.order.inspect = inspectionFor(state_);
        state_.order.studies.correlation = state_.correlation;
        state_.order.studies.floor = state_.view.falseColor == FalseColor::Floor;
        thread_.order(state_.order);
        meter_.offer(state_.pictures);

        const bool news = state_.pictures != shown_;
        ImGui::Render();
        show(news, area);
        if (!options_.report.empty() && (news || glfwGetTime() - reportedAt_ > IDLE_SECONDS)) report();
    }

    // A screen's device can be lost like any other: then once more from the start.
    void show(bool news, const Rectangle& area)
    {
        const bool stale = news || state_.view != shownView_ || freshPresenter_;
        try {
            if (stale)
                if (const ScreenPicture screen = compose(state_.pictures, state_.view); screen.width > 0)
                    presenter_->setPicture(screen);
            presenter_->setTone(state_.tone);
            presenter_->draw(ImGui::GetDrawData(), area);
            freshPresenter_ = false;
        } catch (const Error& error) {
            if (glfwGetTime() - lostAt_ < LOSS_SECONDS) throw;
            lostAt_ = glfwGetTime();
            state_.message = fmt::format("{} It was opened anew.", error.what());
            presenter_.reset();
            presenter_ = std::make_unique<Presenter>(frame_.window);
            freshPresenter_ = true;
        }
        shown_ = state_.pictures;
        shownView_ = state_.view;
    }

    void report()
    {
        reportedAt_ = glfwGetTime();
        std::vector<double> sorted(latencies_.begin(), latencies_.end());
        std::ranges::sort(sorted);
        const auto percentile = [&](double p) {
            return sorted.empty() ? 0 : sorted[size_t(p * double(sorted.size() - 1))];
        };
        nlohmann::ordered_json json = reportOf(state_, meter_);
        json["line"] = line_;
        json["presents_on"] = presenter_->deviceName();
        json["answer_ms"] = {{"p50", percentile(0.5)}, {"p99", percentile(0.99)}};
        writeText(options_.report, jsonText(json, 2) + "\n");
    }

    Interrupt interrupt_;
    WindowOptions options_;
    WindowMemory memory_;
    Frame frame_;
    std::unique_ptr<Presenter> presenter_;
    WindowState state_;
    Mouse mouse_;
    CameraHands hands_;
    UndoList<SettingsPair> undo_;
    Pictures shown_;
    View shownView_;
    std::pair<Pictures, View> legendOf_;
    bool freshPresenter_ = false;
    std::string line_;
    std::future<std::pair<ReferencePointer, std::vector<std::string>>> loading_;
    double reportedAt_ = 0, lostAt_ = -LOSS_SECONDS;
    std::deque<double> latencies_;
    ErrorMeter meter_;
    RenderThread thread_; // last: ends first
};

} // namespace

void showWindow(const WindowOptions& options)
{
    Window(options).run();
}

} // namespace ui
