#include "tests/ui/window/window_fixture.h"

#include "engine/base/error.h"
#include "engine/image/image.h"
#include "tests/support/program.h"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

using namespace std::chrono_literals;

int shell(const std::string& command)
{
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

void WindowTest::SetUp()
{
    if (shell("command -v Xvfb >/dev/null && command -v xdotool >/dev/null") != 0)
        GTEST_SKIP() << "SKIPPED: the window is not tested, because Xvfb or xdotool is not installed.";
    char pattern[] = "/tmp/trichrome-window-XXXXXX";
    folder_ = mkdtemp(pattern);
    static int count = 0;
    display_ = fmt::format(":{}", 100 + getpid() % 20000 + 20000 * count++);
    std::vector<std::string> words = {"Xvfb", display_, "-nolisten", "tcp", "-fbdir", folder_};
    words.insert(words.end(), serverWords_.begin(), serverWords_.end());
    server_ = start(words);
    for (int i = 0; i < 100 && !std::filesystem::exists("/tmp/.X11-unix/X" + display_.substr(1)); ++i)
        std::this_thread::sleep_for(50ms);
    setenv("DISPLAY", display_.c_str(), 1);
    setenv("XDG_CONFIG_HOME", folder_.c_str(), 1); // what windows remember
}

void WindowTest::TearDown()
{
    for (const pid_t process : {window_, server_}) {
        if (process <= 0) continue;
        kill(process, process == server_ ? SIGTERM : SIGKILL);
        waitpid(process, nullptr, 0);
    }
    if (!folder_.empty()) std::filesystem::remove_all(folder_);
}

pid_t WindowTest::start(const std::vector<std::string>& words) const
{
    const pid_t process = fork();
    if (process != 0) return process;
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    const int log = open((folder_ + "/" + std::filesystem::path(words[0]).filename().string() + ".log").c_str(),
                         O_WRONLY | O_CREAT | O_APPEND, 0600);
    dup2(log, STDOUT_FILENO);
    dup2(log, STDERR_FILENO);
    if (chdir(folder_.c_str()) == 0) execvp(arguments[0], arguments.data());
    _exit(127);
}

void WindowTest::view(const std::vector<std::string>& more, const std::string& scene)
{
    std::filesystem::remove(folder_ + "/report.json");
    std::vector<std::string> words = {TRICHROME, "view",  scene,           "--report", folder_ + "/report.json",
                                      "--size",  "64x36", "--max-bounces", "2"};
    words.insert(words.end(), more.begin(), more.end());
    window_ = start(words);
}

int WindowTest::close()
{
    kill(window_, SIGTERM);
    return waitForEnd();
}

int WindowTest::waitForEnd()
{
    int status = 0;
    waitpid(window_, &status, 0);
    window_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

bool WindowTest::alive() const
{
    return waitpid(window_, nullptr, WNOHANG) == 0;
}

nlohmann::json WindowTest::report() const
{
    try {
        return readJson(folder_ + "/report.json");
    } catch (const std::exception&) {
        return {};
    }
}

testing::AssertionResult WindowTest::comes(const Condition& condition) const
{
    Json last;
    for (int i = 0; i < 3600; ++i, std::this_thread::sleep_for(50ms)) {
        last = report();
        if (last.is_object() && condition(last)) return testing::AssertionSuccess();
    }
    return testing::AssertionFailure() << "the last report: " << last.dump(1) << log();
}

testing::AssertionResult WindowTest::until(const Condition& condition, const std::function<void()>& act) const
{
    for (int attempt = 0; attempt < 6; ++attempt) {
        act();
        for (int i = 0; i < 120; ++i, std::this_thread::sleep_for(50ms)) {
            const Json json = report();
            if (json.is_object() && condition(json)) return testing::AssertionSuccess();
        }
    }
    return testing::AssertionFailure() << "six tries, and the last report is " << report().dump(1) << log();
}

WindowTest::Condition WindowTest::runs(const std::string& setting, const Json& value)
{
    return [=](const Json& json) { return json["settings"].value(setting, Json()) == value && json["frames"] > 0; };
}

WindowTest::Condition WindowTest::asks(const std::string& what, const Json& value)
{
    return [=](const Json& json) {
        const Json& asked = json["asked"];
        return asked.value(what, asked["settings"].value(what, Json())) == value;
    };
}

void WindowTest::click(const std::string& widget) const
{
    const Json place = report()["places"][widget];
    ASSERT_TRUE(place.is_array()) << widget;
    shell(fmt::format("xdotool mousemove {} {} sleep 0.1 click 1", place[0].get<int>(), place[1].get<int>()));
}

std::array<int, 2> WindowTest::inPicture(double x, double y) const
{
    const Json area = report().value("picture", Json({0, 0, 0, 0}));
    return {int(area[0].get<double>() + x * area[2].get<double>()),
            int(area[1].get<double>() + y * area[3].get<double>())};
}

void WindowTest::key(const std::string& name) const
{
    const auto [x, y] = inPicture(0.7, 0.6);
    shell(fmt::format("xdotool mousemove {} {} search --name Trichrome windowfocus sleep 0.05 key {}", x, y, name));
}

void WindowTest::dragAcross(int fromX, int toX, int y) const
{
    shell(fmt::format("xdotool mousemove {0} {2} sleep 0.15 mousedown 1 sleep 0.15 mousemove {3} {2} sleep 0.15 "
                      "mousemove {1} {2} sleep 0.15 mouseup 1",
                      fromX, toX, y, (fromX + toX) / 2));
}

testing::AssertionResult WindowTest::dragUntilMoved() const
{
    return until([](const Json& json) { return json["camera_moved"] == true && json["moving"] == false; },
                 [&] {
                     const auto from = inPicture(0.7, 0.3), to = inPicture(0.8, 0.3);
                     dragAcross(from[0], to[0], from[1]);
                 });
}

std::string WindowTest::screenshot(int number) const
{
    EXPECT_TRUE(until(
        [&](const Json& json) {
            return json["line"].get<std::string>().find(fmt::format("trichrome-{}-again", number)) != std::string::npos;
        },
        [&] { key("F12"); }));
    return report()["line"];
}

void WindowTest::expectTheLineGivesTheSamePixels(int number) const
{
    const std::string line = screenshot(number);
    ASSERT_EQ(runLine(line), 0) << line;
    const std::string kept = fmt::format("{}/trichrome-{}", folder_, number);
    EXPECT_TRUE(image::read(kept + ".exr").image.pixels == image::read(kept + "-again.exr").image.pixels) << line;
}

int WindowTest::runLine(const std::string& line) const
{
    EXPECT_EQ(line.substr(0, 10), "trichrome ");
    return shell("cd " + folder_ + " && " + TRICHROME + line.substr(9));
}

WindowTest::Screen WindowTest::screen() const
{
    // Xvfb maps its screen into a file in the format of xwd: a header of 32-bit words, a color map, lines of pixels.
    const std::string bytes = readFile(folder_ + "/Xvfb_screen0");
    const auto word = [&](size_t i) {
        const auto* b = reinterpret_cast<const unsigned char*>(bytes.data()) + 4 * i;
        return uint32_t(b[0]) << 24 | uint32_t(b[1]) << 16 | uint32_t(b[2]) << 8 | b[3];
    };
    Screen screen{.width = int(word(4)), .height = int(word(5))};
    const size_t start = word(0) + size_t{12} * word(19), line = word(12);
    for (size_t y = 0; y < size_t(screen.height); ++y)
        for (size_t x = 0; x < size_t(screen.width); ++x) {
            const auto* b = reinterpret_cast<const unsigned char*>(bytes.data()) + start + y * line + 4 * x;
            screen.pixels.emplace_back(b[2], b[1], b[0]);
        }
    return screen;
}

std::string WindowTest::log() const
{
    const std::string file = folder_ + "/trichrome.log";
    return std::filesystem::exists(file) ? readFile(file) : "";
}
