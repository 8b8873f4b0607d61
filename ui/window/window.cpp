#include "ui/window/window.h"

#include "engine/base/error.h"
#include "engine/base/files.h"
#include "passes/camera_choice.h"
#include "ui/cli/output_file.h"
#include "ui/window/panel.h"
#include "ui/window/presenter.h"
#include "ui/window/screenshot.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <deque>
#include <filesystem>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_impl_glfw.h>
#include <imgui_impl_vulkan.h>
#include <nlohmann/json.hpp>

namespace ui
{

namespace
{

constexpr double IDLE_SECONDS = 0.1;        // between looks at the world when nothing happens
constexpr double STILL_SECONDS = 0.25;      // after its last move the camera stands
constexpr double RADIANS_PER_POINT = 0.006; // of dragging
constexpr size_t LATENCIES = 1000;          // that percentiles are taken of
constexpr uint64_t MAX_PRESET_BYTES = 1 << 20;

volatile std::sig_atomic_t stopRequested = 0;
extern "C" void onStop(int)
{
    stopRequested = 1;
}

// GLFW and ImGui, as long as it lives.
class Frame
{
  public:
    Frame()
    {
        glfwSetErrorCallback([](int, const char* text) { lastError() = text; });
        if (!glfwInit()) throw Error("No window can be shown: {}.", lastError());
        glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
        glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
        if (!glfwVulkanSupported() || !(window = glfwCreateWindow(1280, 720, "Trichrome", nullptr, nullptr))) {
            const std::string why = window || lastError().empty() ? "there is no Vulkan driver" : lastError();
            glfwTerminate();
            throw Error("No window can be shown: {}.", why);
        }
        float vertical = 1;
        glfwGetWindowContentScale(window, &scale, &vertical);
        ImGui::CreateContext();
        ImGui::GetIO().IniFilename = nullptr;
        ImGui::StyleColorsDark();
        ImGui::GetStyle().ScaleAllSizes(scale);
        ImFontConfig font;
        font.SizePixels = std::floor(13 * scale);
        ImGui::GetIO().Fonts->AddFontDefault(&font);
    }
    ~Frame()
    {
        ImGui::DestroyContext();
        glfwDestroyWindow(window);
        glfwTerminate();
    }
    Frame(const Frame&) = delete;
    Frame& operator=(const Frame&) = delete;

    GLFWwindow* window = nullptr;
    float scale = 1;

  private:
    static std::string& lastError()
    {
        static std::string text;
        return text;
    }
};

class Window
{
  public:
    explicit Window(const WindowOptions& options) : options_(options), thread_(options.device, glfwPostEmptyEvent)
    {
        state_.order = options.order;
        glfwSetWindowUserPointer(frame_.window, this);
        glfwSetDropCallback(frame_.window, [](GLFWwindow* window, int count, const char** files) {
            for (int i = 0; i < count; ++i) static_cast<Window*>(glfwGetWindowUserPointer(window))->drop(files[i]);
        });
        ImGui_ImplGlfw_InitForVulkan(frame_.window, true); // after our own callbacks: it calls them too
        presenter_ = std::make_unique<Presenter>(frame_.window);
    }
    ~Window()
    {
        presenter_.reset();
        ImGui_ImplGlfw_Shutdown();
    }
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    void run()
    {
        int hot = 3;
        while (!glfwWindowShouldClose(frame_.window) && !stopRequested) {
            const double waitStart = glfwGetTime();
            const double wait = hot > 0 ? 0.008 : IDLE_SECONDS;
            glfwWaitEventsTimeout(wait);
            const double now = glfwGetTime();
            hot = now - waitStart < wait ? 3 : std::max(hot - 1, 0); // ImGui answers an event within a few frames
            drawOnce();
            latencies_.push_back(1000 * (glfwGetTime() - now));
            if (latencies_.size() > LATENCIES) latencies_.pop_front();
        }
    }

  private:
    void drop(const std::string& file)
    {
        const std::string kind = std::filesystem::path(file).extension().string();
        try {
            if (kind == ".json") {
                const std::vector<std::byte> bytes = files::read(file, MAX_PRESET_BYTES);
                const char* text = reinterpret_cast<const char*>(bytes.data());
                passes::Settings settings = state_.order.settings;
                passes::apply(settings, nlohmann::ordered_json::parse(text, text + bytes.size()));
                state_.order.settings = settings;
            } else {
                state_.order.scene = file;
                state_.order.pose.reset();
                state_.order.settings.camera.clear();
            }
        } catch (const nlohmann::json::exception& error) {
            state_.message = fmt::format("\"{}\" is no preset: {}.", file, error.what());
        } catch (const Error& error) {
            state_.message = error.what();
        }
    }

    void resetView()
    {
        state_.order.pose.reset();
        state_.order.moving = false;
    }

    // The pose to change; empty before there is a scene.
    Pose* pose()
    {
        const std::shared_ptr<const SceneFacts> facts = thread_.scene();
        if (!facts || facts->name != state_.order.scene) return nullptr;
        if (!state_.order.pose) {
            size_t index = 0; // the name was good enough for the render thread
            for (size_t i = 0; i < facts->cameras.size(); ++i)
                if (facts->cameras[i].name == state_.order.settings.camera ||
                    std::to_string(i) == state_.order.settings.camera)
                    index = i;
            state_.order.pose = poseOf(facts->cameras[index], facts->origin);
        }
        return &*state_.order.pose;
    }

    void moveCamera()
    {
        const ImGuiIO& io = ImGui::GetIO();
        const std::optional<Pose> before = state_.order.pose;
        const bool dragging = io.MouseDelta.x != 0 || io.MouseDelta.y != 0;
        if (!io.WantCaptureMouse && (dragging || io.MouseWheel != 0)) {
            const double x = io.MouseDelta.x * RADIANS_PER_POINT, y = io.MouseDelta.y * RADIANS_PER_POINT;
            const bool left = io.MouseDown[0], right = io.MouseDown[1], middle = io.MouseDown[2];
            Pose* p = left || right || middle || io.MouseWheel != 0 ? pose() : nullptr;
            if (p && left) orbit(*p, -x, y);
            if (p && right) look(*p, -x, -y);
            if (p && middle) pan(*p, -io.MouseDelta.x / io.DisplaySize.y, io.MouseDelta.y / io.DisplaySize.y);
            if (p && io.MouseWheel != 0) dolly(*p, std::pow(0.9, double(io.MouseWheel)));
        }
        if (!io.WantCaptureKeyboard && !io.KeyCtrl) {
            const auto axis = [](int plus, int minus) {
                return double(ImGui::IsKeyDown(plus)) - double(ImGui::IsKeyDown(minus));
            };
            const glm::dvec3 way(axis(GLFW_KEY_D, GLFW_KEY_A), axis(GLFW_KEY_E, GLFW_KEY_Q),
                                 axis(GLFW_KEY_W, GLFW_KEY_S));
            Pose* p = way != glm::dvec3(0) ? pose() : nullptr;
            if (p) {
                const double speed = (io.KeyShift ? 4 : 1) * glm::length(p->target - p->position);
                fly(*p, way * speed * std::min(double(io.DeltaTime), 0.1));
            }
        }
        if (state_.order.pose != before && state_.order.pose) {
            movedAt_ = glfwGetTime();
            state_.order.moving = true;
        } else if (glfwGetTime() - movedAt_ > STILL_SECONDS) {
            state_.order.moving = false;
        }
    }

    void readKeys()
    {
        if (ImGui::GetIO().WantCaptureKeyboard) return;
        const auto pressed = [](int key) { return ImGui::IsKeyPressed(key, false); };
        if (pressed(GLFW_KEY_F1)) state_.help = !state_.help;
        if (pressed(GLFW_KEY_F12)) state_.screenshot = true;
        if (pressed(GLFW_KEY_HOME)) state_.resetView = true;
        if (pressed(GLFW_KEY_SPACE)) state_.order.paused = !state_.order.paused;
        if (pressed(GLFW_KEY_N)) state_.order.paused = true, ++state_.order.steps;
        if (pressed(GLFW_KEY_R)) ++state_.order.restarts;
    }

    void saveShot()
    {
        if (!shot_ || shot_->order.moving) return;
        try {
            line_ = takeScreenshot(*shot_);
            glfwSetClipboardString(frame_.window, line_.c_str());
            state_.message = "Saved; in the clipboard: " + line_;
        } catch (const Error& error) {
            state_.message = error.what();
        }
    }

    // Where the picture fits beside the panel.
    Rectangle pictureArea() const
    {
        if (!shot_) return {};
        int width = 0, height = 0;
        glfwGetFramebufferSize(frame_.window, &width, &height);
        const int left = int(PANEL_WIDTH * frame_.scale);
        const passes::Settings& full = state_.order.settings;
        const double scale = std::min(double(width - left) / full.width, double(height) / full.height);
        const int w = int(full.width * scale), h = int(full.height * scale);
        return {left + (width - left - w) / 2, (height - h) / 2, w, h};
    }

    void drawOnce()
    {
        ImGui_ImplVulkan_NewFrame();
        ImGui_ImplGlfw_NewFrame();
        ImGui::NewFrame();
        Order back;
        if (const std::optional<std::string> failure = thread_.takeFailure(back)) {
            state_.message = *failure;
            back.steps = state_.order.steps;
            state_.order = back;
        }
        drawPanel(state_, shot_, thread_.activity(), frame_.scale);
        drawHelp(state_.help);
        readKeys();
        moveCamera();
        if (std::exchange(state_.resetView, false)) resetView();
        thread_.order(state_.order);

        const std::shared_ptr<const Shot> latest = thread_.shot();
        if (latest && (latest != shot_ || state_.tone != shownTone_))
            presenter_->setPicture(toScreen(latest->picture, shownTone_ = state_.tone));
        const bool news = latest != shot_;
        shot_ = latest;
        if (std::exchange(state_.screenshot, false)) saveShot();
        ImGui::Render();
        presenter_->draw(ImGui::GetDrawData(), pictureArea());
        if (!options_.report.empty() && (news || glfwGetTime() - reportedAt_ > IDLE_SECONDS)) report();
    }

    void report()
    {
        reportedAt_ = glfwGetTime();
        std::vector<double> sorted(latencies_.begin(), latencies_.end());
        std::ranges::sort(sorted);
        const auto percentile = [&](double p) {
            return sorted.empty() ? 0 : sorted[size_t(p * double(sorted.size() - 1))];
        };
        nlohmann::ordered_json json = {{"activity", thread_.activity()},
                                       {"message", state_.message},
                                       {"line", line_},
                                       {"presents_on", presenter_->deviceName()},
                                       {"answer_ms", {{"p50", percentile(0.5)}, {"p99", percentile(0.99)}}},
                                       {"places", state_.places}};
        if (shot_) {
            json["scene"] = shot_->order.scene;
            json["settings"] = passes::toJson(shot_->order.settings);
            json["frames"] = shot_->frames;
            json["moving"] = shot_->order.moving;
            json["camera_moved"] = shot_->order.pose.has_value();
            json["paused"] = shot_->order.paused;
            json["variant"] = shot_->stats.variant;
            json["nonfinite"] = shot_->stats.nonFinite;
        }
        writeText(options_.report, json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    }

    WindowOptions options_;
    Frame frame_;
    std::unique_ptr<Presenter> presenter_;
    PanelState state_;
    Tone shownTone_;
    std::shared_ptr<const Shot> shot_;
    std::string line_;
    double movedAt_ = -1, reportedAt_ = 0;
    std::deque<double> latencies_;
    RenderThread thread_; // last: ends first
};

} // namespace

void showWindow(const WindowOptions& options)
{
    stopRequested = 0;
    std::signal(SIGTERM, onStop);
    std::signal(SIGINT, onStop);
    Window(options).run();
    std::signal(SIGTERM, SIG_DFL);
    std::signal(SIGINT, SIG_DFL);
}

} // namespace ui
