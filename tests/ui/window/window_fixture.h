#pragma once
// The window in a virtual display of its own, driven by a real mouse and keyboard, judged by what its frames report and
// by what is on the screen.

#include <array>
#include <functional>
#include <string>
#include <vector>

#include <glm/glm.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/types.h>

int shell(const std::string& command); // its exit code

class WindowTest : public testing::Test
{
  protected:
    using Json = nlohmann::json;
    using Condition = std::function<bool(const Json&)>;

    void SetUp() override;
    void TearDown() override;

    // Opens the window on a small picture of the Cornell box, quick on any device; the words come after.
    void view(const std::vector<std::string>& more = {}, const std::string& scene = "cornell");
    int close();      // SIGTERM; the exit code
    int waitForEnd(); // of itself; likewise
    bool alive() const;

    Json report() const;
    // Waits until what is reported fits.
    testing::AssertionResult comes(const Condition& condition) const;
    // A busy machine may miss a click: as a person would, this one tries again until it sees that it was taken. What
    // goes to and fro must be seen at once (asks), not when it runs.
    testing::AssertionResult until(const Condition& condition, const std::function<void()>& act) const;
    static Condition runs(const std::string& setting, const Json& value);
    static Condition asks(const std::string& what,
                          const Json& value); // what hands have set, a setting or another thing

    void click(const std::string& widget) const;
    void key(const std::string& name) const; // as xdotool calls it; the mouse is over the picture
    void dragAcross(int fromX, int toX, int y) const;
    testing::AssertionResult dragUntilMoved() const; // in the picture, right of its middle
    std::array<int, 2>
    inPicture(double x, double y) const; // on the screen; (0, 0) is the upper left corner, (1, 1) the lower right

    std::string screenshot(int number) const;               // F12 for the `number`th time: the line that it gives
    void expectTheLineGivesTheSamePixels(int number) const; // likewise
    int runLine(const std::string& line) const;             // where the window runs; the exit code

    struct Screen {
        int width = 0, height = 0;
        std::vector<glm::u8vec3> pixels;
        glm::u8vec3 at(int x, int y) const { return pixels[size_t(y) * size_t(width) + size_t(x)]; }
    };
    Screen screen() const; // what is on it now

    std::string log() const; // what the window has printed
    std::string folder_, display_;
    std::vector<std::string> serverWords_ = {"-screen", "0", "1280x720x24"};
    pid_t server_ = 0, window_ = 0;

  private:
    pid_t start(const std::vector<std::string>& words) const;
};
