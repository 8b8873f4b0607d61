// The window, driven by a real mouse and keyboard in a virtual display, judged by what its frames report.

#include "engine/base/error.h"
#include "engine/base/files.h"
#include "engine/image/image.h"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

namespace
{

using Json = nlohmann::json;
using namespace std::chrono_literals;

int shell(const std::string& command)
{
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

class Window : public testing::Test
{
  protected:
    void SetUp() override
    {
        if (shell("command -v Xvfb >/dev/null && command -v xdotool >/dev/null") != 0)
            GTEST_SKIP() << "SKIPPED: the window is not tested, because Xvfb or xdotool is not installed.";
        char pattern[] = "/tmp/trichrome-window-XXXXXX";
        folder_ = mkdtemp(pattern);
        static int count = 0;
        display_ = fmt::format(":{}", 100 + getpid() % 20000 + 20000 * count++);
        server_ = start({"Xvfb", display_, "-screen", "0", "1280x720x24", "-nolisten", "tcp"});
        for (int i = 0; i < 100 && !std::filesystem::exists("/tmp/.X11-unix/X" + display_.substr(1)); ++i)
            std::this_thread::sleep_for(50ms);
        setenv("DISPLAY", display_.c_str(), 1);
    }
    void TearDown() override
    {
        for (const pid_t process : {window_, server_}) {
            if (process <= 0) continue;
            kill(process, process == server_ ? SIGTERM : SIGKILL);
            waitpid(process, nullptr, 0);
        }
        if (!folder_.empty()) std::filesystem::remove_all(folder_);
    }

    pid_t start(const std::vector<std::string>& words) const
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

    void view(const std::vector<std::string>& more)
    {
        std::vector<std::string> words = {TRICHROME, "view", "cornell", "--report", folder_ + "/report.json"};
        words.insert(words.end(), more.begin(), more.end());
        window_ = start(words);
    }

    Json report() const
    {
        try {
            const std::vector<std::byte> bytes = files::read(folder_ + "/report.json", 1 << 20);
            const char* text = reinterpret_cast<const char*>(bytes.data());
            return Json::parse(text, text + bytes.size());
        } catch (const Error&) {
            return {};
        }
    }

    testing::AssertionResult comes(const std::function<bool(const Json&)>& condition) const
    {
        Json last;
        for (int i = 0; i < 600; ++i, std::this_thread::sleep_for(50ms)) {
            last = report();
            if (last.contains("settings") && condition(last)) return testing::AssertionSuccess();
        }
        return testing::AssertionFailure() << "the last report: " << last.dump(1);
    }
    static std::function<bool(const Json&)> runs(const std::string& setting, const Json& value)
    {
        return [=](const Json& json) { return json["settings"][setting] == value && json["frames"] > 0; };
    }

    // A busy machine may miss a click: as a person would, this one tries again until what was asked for is reported.
    testing::AssertionResult until(const std::function<bool(const Json&)>& condition,
                                   const std::function<void()>& act) const
    {
        for (int attempt = 0; attempt < 6; ++attempt) {
            act();
            for (int i = 0; i < 120; ++i, std::this_thread::sleep_for(50ms)) {
                const Json json = report();
                if (json.contains("settings") && condition(json)) return testing::AssertionSuccess();
            }
        }
        return testing::AssertionFailure() << "six tries, and the last report is " << report().dump(1);
    }

    testing::AssertionResult dragUntilMoved() const
    {
        return until([](const Json& json) { return json["camera_moved"] == true && json["moving"] == false; },
                     [] {
                         shell("xdotool mousemove 900 300 sleep 0.3 mousedown 1 sleep 0.3 mousemove 930 310 sleep 0.3 "
                               "mousemove 960 320 "
                               "sleep 0.3 mouseup 1");
                     });
    }

    void click(const std::string& widget) const
    {
        const Json place = report()["places"][widget];
        ASSERT_TRUE(place.is_array()) << widget;
        shell(fmt::format("xdotool mousemove {} {} sleep 0.2 click 1", place[0].get<int>(), place[1].get<int>()));
    }
    static void key(const std::string& name)
    {
        shell("xdotool mousemove 900 400 sleep 0.1 search --name Trichrome windowfocus sleep 0.1 key " + name);
    }

    int close()
    {
        kill(window_, SIGTERM);
        int status = 0;
        waitpid(window_, &status, 0);
        window_ = 0;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

    std::string folder_, display_;
    pid_t server_ = 0, window_ = 0;
};

} // namespace

TEST_F(Window, TogglesChangeWhatRunsAndItClosesCleanly)
{
    view({"--size", "64x36", "--max-bounces", "2"});
    ASSERT_TRUE(comes(runs("method", "pt")));
    ASSERT_TRUE(until(runs("method", "rgb-restir"), [&] { click("method.2"); }));
    EXPECT_EQ(report()["variant"]["RESERVOIR_COUNT"], "3");
    ASSERT_TRUE(until(runs("method", "restir-pt"), [&] { click("method.1"); }));
    EXPECT_EQ(report()["variant"]["RESERVOIR_COUNT"], "1");
    ASSERT_TRUE(until(runs("shift", "replay"), [&] { click("shift.0"); }));
    const Json place = report()["places"]["max-confidence"];
    EXPECT_TRUE(until(runs("max-confidence", 1048576), [&] {
        shell(
            fmt::format("xdotool search --name Trichrome windowfocus sleep 0.2 mousemove {} {} sleep 0.3 keydown ctrl "
                        "sleep 0.3 mousedown 1 sleep 0.3 "
                        "mouseup 1 sleep 0.3 keyup ctrl sleep 0.3 key ctrl+a sleep 0.3 type --delay 150 1048576",
                        place[0].get<int>(), place[1].get<int>()));
        shell("xdotool sleep 0.2 key Return");
    }));
    EXPECT_TRUE(dragUntilMoved());
    EXPECT_EQ(close(), 0);
}

TEST_F(Window, TheLineOfAScreenshotGivesTheSamePixels)
{
    view({"--size", "64x36", "--max-bounces", "2", "--method", "rgb-restir"});
    ASSERT_TRUE(comes(runs("method", "rgb-restir")));
    ASSERT_TRUE(dragUntilMoved());
    ASSERT_TRUE(comes([](const Json& json) { return json["frames"] > 2; }));
    click("pause");
    key("F12");
    ASSERT_TRUE(comes([](const Json& json) { return json["line"] != ""; })) << "no line";
    std::string line = report()["line"];
    ASSERT_EQ(close(), 0);
    ASSERT_EQ(line.substr(0, 10), "trichrome ");
    line.replace(0, 9, TRICHROME);
    ASSERT_EQ(shell("cd " + folder_ + " && " + line), 0) << line;
    const image::Image kept = image::read(folder_ + "/trichrome-1.exr").image;
    const image::Image again = image::read(folder_ + "/trichrome-1-again.exr").image;
    EXPECT_EQ(kept.width, 64u);
    EXPECT_TRUE(kept.pixels == again.pixels);
}

TEST_F(Window, ASceneThatFailsLeavesTheWindowOpen)
{
    window_ = start({TRICHROME, "view", "missing.glb", "--report", folder_ + "/report.json"});
    bool said = false;
    for (int i = 0; i < 200 && !said; ++i, std::this_thread::sleep_for(50ms)) {
        const Json json = report();
        said = json.contains("message") && json["message"].get<std::string>().find("missing.glb") != std::string::npos;
    }
    EXPECT_TRUE(said);
    EXPECT_EQ(close(), 0);
}
