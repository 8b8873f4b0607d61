// Two settings beside each other, the reference, and what is on the screen.
// Covers ui/window/compare_room.cpp, ui/window/axes.cpp, ui/window/plots.cpp,
// ui/window/studies.cpp, ui/window/study_kinds.cpp.

#include "engine/image/image.h"
#include "tests/ui/window/window_fixture.h"
#include "tests/ui/window/x_client.h"

#include <cstdlib>
#include <limits>

namespace
{

class CompareWindow : public WindowTest
{
  protected:
    // Mean brightness of a box of the screen, 0 to 255.
    double brightness(int x0, int x1, int y0, int y1) const
    {
        const Screen picture = screen();
        double sum = 0;
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x) sum += picture.at(x, y).r + picture.at(x, y).g + picture.at(x, y).b;
        return sum / (3.0 * (x1 - x0) * (y1 - y0));
    }
    bool becomes(const std::function<bool()>& condition) const
    {
        for (int i = 0; i < 100; ++i, shell("sleep 0.1"))
            if (condition()) return true;
        return false;
    }
};

} // namespace

// B shows emitters only: dark beside A. The picture lies in x 400 to 1280, y 112 to 607; its middle is at 840.
TEST_F(CompareWindow, SplitFlipAndDifferenceShowTwoSettings)
{
    view();
    ASSERT_TRUE(comes(runs("method", "pt")));
    ASSERT_TRUE(until(asks("comparing", true), [&] { key("c"); }));
    ASSERT_TRUE(comes([](const Json& json) { return json.contains("b") && json["b"]["frames"] > 0; }));
    EXPECT_EQ(report()["b"]["settings"]["method"], "rgb-restir");
    EXPECT_EQ(report()["settings"]["method"], "pt");
    ASSERT_TRUE(until([](const Json& json) { return json["b"]["settings"]["method"] == "pt"; },
                      [&] { click("method.0"); })); // B is the one being edited
    const Json place = report()["places"]["max-bounces"];
    ASSERT_TRUE(until([](const Json& json) { return json["b"]["settings"]["max-bounces"] == 0; },
                      [&] { dragAcross(place[0], 12, place[1]); }));
    EXPECT_EQ(report()["settings"]["max-bounces"], 2);

    EXPECT_TRUE(becomes([&] { return brightness(650, 800, 450, 580) > 20 && brightness(880, 1050, 450, 580) < 5; }))
        << brightness(650, 800, 450, 580) << " | " << brightness(880, 1050, 450, 580);
    ASSERT_TRUE(until([](const Json& json) { return json["view"]["wipe"] < 0.3; },
                      [&] {
                          const Json wipe = report()["places"]["wipe"];
                          dragAcross(wipe[0], 580, wipe[1]);
                      }));
    EXPECT_EQ(report()["camera_moved"], false);
    EXPECT_TRUE(becomes([&] { return brightness(650, 800, 450, 580) < 5; }));
    ASSERT_TRUE(until([](const Json& json) { return json["view"]["layout"] == 0; }, [&] { click("layout.0"); }));
    EXPECT_TRUE(becomes([&] { return brightness(650, 800, 450, 580) > 20; })); // A alone
    ASSERT_TRUE(until([](const Json& json) { return json["view"]["flipped"] == true; }, [&] { key("Tab"); }));
    EXPECT_TRUE(becomes([&] { return brightness(650, 800, 450, 580) < 5; })); // B alone
    ASSERT_TRUE(until([](const Json& json) { return json["view"]["layout"] == 2; }, [&] { click("layout.2"); }));
    EXPECT_TRUE(becomes([&] { return brightness(650, 800, 450, 580) > 20; })); // their difference
    // In a smaller window the same hands move the camera; the line has a place of its own.
    ASSERT_TRUE(until([](const Json& json) { return json["view"]["layout"] == 1; }, [&] { click("layout.1"); }));
    ASSERT_EQ(shell("xdotool search --name Trichrome windowsize 900 500"), 0);
    ASSERT_TRUE(comes([](const Json& json) { return json["picture"] == Json({400, 109, 500, 281}); }));
    EXPECT_TRUE(dragUntilMoved());
    EXPECT_LT(report()["view"]["wipe"], 0.3);
    ASSERT_TRUE(until(asks("comparing", false), [&] { key("c"); }));
    EXPECT_TRUE(comes([](const Json& json) { return !json.contains("b"); }));
    EXPECT_EQ(close(), 0);
}

// Such a file once ended the window.
TEST_F(CompareWindow, AReferenceThatIsNotFiniteIsShownAndSaid)
{
    constexpr float NONE = std::numeric_limits<float>::quiet_NaN(), INFINITE = std::numeric_limits<float>::infinity();
    image::Image odd{.width = 64, .height = 36, .pixels = std::vector<glm::vec3>(size_t{64} * 36, glm::vec3(NONE))};
    for (uint32_t y = 0; y < 36; ++y)
        for (uint32_t x = 32; x < 64; ++x) odd.at(x, y) = {INFINITE, -INFINITE, 0};
    image::write(folder_ + "/odd.exr", odd, {});
    view({"--reference", folder_ + "/odd.exr"});
    ASSERT_TRUE(comes([](const Json& json) { return json["reference"] == "odd.exr" && json["frames"] > 0; }));
    ASSERT_TRUE(until([](const Json& json) { return json["view"]["flipped"] == true; }, [&] { key("Tab"); }));
    const auto at = [&](double x) {
        const auto [column, row] = inPicture(x, 0.25);
        return screen().at(column, row);
    };
    EXPECT_TRUE(becomes([&] { return at(0.2) == glm::u8vec3(255, 0, 255) && at(0.8) == glm::u8vec3(255, 0, 0); }));
    EXPECT_EQ(close(), 0);
}

// The reference is a black picture from a file, so the error of a picture is known from the picture.
TEST_F(CompareWindow, ErrorsAreMeasuredAgainstAFileAndAFrozenPicture)
{
    image::Image black{.width = 64, .height = 36, .pixels = std::vector<glm::vec3>(size_t{64} * 36)};
    image::write(folder_ + "/black.exr", black, {});
    view({"--reference", folder_ + "/black.exr"});
    ASSERT_TRUE(comes([](const Json& json) { return json["errors"]["a"]["points"] > 3; }));
    EXPECT_EQ(report()["reference"], "black.exr");
    ASSERT_TRUE(until(asks("paused", true), [&] { click("pause"); }));
    ASSERT_TRUE(comes([](const Json& json) { return json["paused"] == true; }));
    ASSERT_TRUE(until([](const Json& json) { return json["line"] != ""; }, [&] { key("F12"); }));
    double mse = 0;
    const image::Image picture = image::read(folder_ + "/trichrome-1.exr").image;
    for (const glm::vec3& p : picture.pixels) mse += double(dot(p, p)) / (3.0 * double(picture.pixels.size()));
    const double measured = report()["errors"]["a"]["mse"];
    EXPECT_NEAR(measured, mse, 0.05 * mse); // of a film up to 6% younger

    ASSERT_TRUE(until([](const Json& json) { return json["reference"] != "black.exr"; }, [&] { key("f"); }));
    ASSERT_TRUE(comes([](const Json& json) { return json["errors"]["a"].value("mse", 1.0) == 0; }));
    ASSERT_TRUE(dropFile("Trichrome", folder_ + "/black.exr"));
    EXPECT_TRUE(comes([](const Json& json) { return json["reference"] == "black.exr"; }));
    EXPECT_EQ(close(), 0);
}
