// The compare command, run as a person would; and its page in a real browser.
// Covers ui/report/comparison_page.cpp.

#include "tests/support/trichrome.h"

#include "engine/image/image.h"

#include <cmath>
#include <limits>

namespace
{

constexpr uint32_t WIDTH = 60, HEIGHT = 40;

image::Image waves(float noise, uint32_t width = WIDTH)
{
    image::Image picture{width, HEIGHT, {}};
    for (uint32_t y = 0; y < HEIGHT; ++y)
        for (uint32_t x = 0; x < width; ++x)
            picture.pixels.push_back(glm::vec3(1.2f + std::sin(0.3f * float(x)), 0.5f, 0.2f + 0.01f * float(y)) +
                                     noise * float((x * 7 + y * 13) % 11));
    return picture;
}

class Compare : public Trichrome
{
  protected:
    std::string save(const std::string& name, const image::Image& picture, const image::Metadata& metadata = {}) const
    {
        image::write(directory / name, picture, metadata);
        return directory / name;
    }

    std::string first() const
    {
        return save("first.exr", waves(0), {{"method", "pt"}, {"seed", "1"}, {"frames", "<b>64"}});
    }
    std::string second() const { return save("second.exr", waves(0.02f), {{"method", "rgb-restir"}, {"seed", "1"}}); }
};

} // namespace

TEST_F(Compare, RefusesWrongUsageWithExitCode2)
{
    const std::string a = first(), b = second();
    expectRefusal({"compare"}, 2, "REFERENCE");
    expectRefusal({"compare", a}, 2, "IMAGE");
    expectRefusal({"compare", a, b, "--max-flip", "2"}, 2, "--max-flip");
    expectRefusal({"compare", a, b, "--min-psnr", "loud"}, 2, "--min-psnr");
    expectRefusal({"compare", a, b, "--html", directory / "page.pdf"}, 2, ".html");
}

TEST_F(Compare, RefusesPicturesThatCannotBeCompared)
{
    const std::string a = first(), page = directory / "page.html", json = directory / "c.json";
    expectRefusal({"compare", a, directory / "missing.exr", "--html", page}, 1, "missing.exr");
    expectRefusal({"compare", a, save("wide.exr", waves(0, WIDTH + 1)), "--html", page, "--json", json}, 2,
                  "60x40 pixels and the picture");
    image::Image broken = waves(0);
    broken.at(3, 5).g = std::numeric_limits<float>::quiet_NaN();
    const std::string bad = save("bad.exr", broken);
    expectRefusal({"compare", a, bad, "--json", json}, 1, "The green of pixel (3, 5) of the picture is nan");
    expectRefusal({"compare", bad, a, "--json", json}, 1, "of the reference is nan");
    expectRefusal({"compare", a, bad}, 1, "bad.exr");
    writeFile(directory / "text.png", "no picture");
    expectRefusal({"compare", a, directory / "text.png"}, 1, "text.png");
    expectRefusal({"compare", a, a, "--html", "/nonexistent/page.html"}, 1, "/nonexistent");
    EXPECT_FALSE(std::filesystem::exists(page) || std::filesystem::exists(json));
}

TEST_F(Compare, ValuesBelowZeroCountAndAreSaid)
{
    image::Image negative = waves(0);
    for (glm::vec3& pixel : negative.pixels) pixel *= -1;
    const std::string json = directory / "c.json";
    const Outcome outcome =
        run({"compare", save("black.exr", image::Image{WIDTH, HEIGHT, std::vector<glm::vec3>(size_t{WIDTH} * HEIGHT)}),
             save("negative.exr", negative), "--max-flip", "0", "--json", json});
    EXPECT_EQ(outcome.exitCode, 1);
    EXPECT_NE(outcome.err.find("negative.exr\" has 7200 values below 0"), std::string::npos) << outcome.err;
    EXPECT_EQ(readJson(json)[0]["warnings"].size(), 1u);
    EXPECT_GT(readJson(json)[0]["flip"], 0.1);
}

TEST_F(Compare, WritesTheFiguresOfTheContract)
{
    const std::string a = first(), b = second(), json = directory / "c.json";
    const Outcome outcome = runWell({"compare", a, b, a, "--json", json});
    for (const char* word : {"second.exr", "first.exr", "PSNR dB", "SSIM", "FLIP", "inf"})
        EXPECT_NE(outcome.out.find(word), std::string::npos) << word;

    const nlohmann::json list = readJson(json);
    ASSERT_EQ(list.size(), 2u);
    for (const char* key :
         {"image", "mse", "relmse", "mape", "psnr", "ssim", "flip", "luma_mse", "chroma_mse", "mean_ratio"})
        EXPECT_TRUE(list[0].contains(key)) << key;
    EXPECT_EQ(list[0]["image"], b);
    EXPECT_NEAR(list[0]["mse"], 0.02 * 0.02 * 35, 0.02 * 0.02 * 2); // 35: mean square of 0..10
    EXPECT_EQ(list[0]["mean_ratio"].size(), 3u);
    EXPECT_GT(list[0]["flip"], 0.005);
    EXPECT_EQ(list[1]["mse"], 0);
    EXPECT_EQ(list[1]["flip"], 0);
    EXPECT_TRUE(list[1]["psnr"].is_null()); // infinite
    EXPECT_TRUE(list[1]["gates"].empty());
}

TEST_F(Compare, IsAGateThatNamesImageFigureAndLimit)
{
    const std::string a = first(), b = second(), json = directory / "c.json";
    runWell({"compare", a, b, "--max-flip", "1", "--min-psnr", "1"});
    runWell({"compare", a, a, "--max-flip", "0", "--min-psnr", "1000"});

    const Outcome outcome = run({"compare", a, a, b, "--max-flip", "0.001", "--min-psnr", "90", "--json", json});
    EXPECT_EQ(outcome.exitCode, 1);
    EXPECT_NE(outcome.out.find("second.exr"), std::string::npos); // the figures are there all the same
    for (const char* part :
         {"second.exr\": its FLIP of 0.", "above the limit of 0.001", "its PSNR of ", "below the limit of 90 dB"})
        EXPECT_NE(outcome.err.find(part), std::string::npos) << part << " in " << outcome.err;
    EXPECT_EQ(outcome.err.find("first.exr"), std::string::npos);
    const nlohmann::json list = readJson(json);
    EXPECT_EQ(list[0]["gates"][0]["passed"], true);
    EXPECT_EQ(list[1]["gates"][0]["figure"], "flip");
    EXPECT_EQ(list[1]["gates"][0]["passed"], false);
    EXPECT_EQ(list[1]["gates"][1]["limit"], 90);
}

TEST_F(Compare, ThePageShowsThePicturesAndListsTheSettingsThatDiffer)
{
    const std::string page = directory / "page.html";
    runWell({"compare", first(), second(), "--html", page});
    const std::string html = readFile(page);
    EXPECT_NE(html.find("<td>method</td><td>pt</td><td>rgb-restir</td>"), std::string::npos);
    EXPECT_NE(html.find("<td>frames</td><td>&lt;b&gt;64</td><td></td>"), std::string::npos);
    EXPECT_EQ(html.find("<td>seed</td>"), std::string::npos);
    EXPECT_NE(html.find("first.exr, the reference</figcaption>"), std::string::npos);
    EXPECT_NE(html.find("second.exr: PSNR "), std::string::npos);
    EXPECT_EQ(html.find("http:"), std::string::npos);
    EXPECT_EQ(html.find("https:"), std::string::npos);
}

// What a person does, as events; what the viewer then shows, as text that --dump-dom prints.
constexpr const char* PERSON = R"(<pre id="seen"></pre><script>
addEventListener('load', async () => {
  const viewer = document.getElementById('viewer'), canvas = viewer.querySelector('canvas');
  while (!viewer.dataset.state) await new Promise(resolve => setTimeout(resolve, 10));
  const seen = {};
  const look = name => {
    const data = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
    let sum = 0;
    data.forEach((value, i) => { sum = (sum * 31 + value) % 1000000007; });
    seen[name] = sum;
  };
  const press = key => viewer.dispatchEvent(new KeyboardEvent('keydown', {key, bubbles: true, cancelable: true}));
  const point = (type, u) => {
    const box = canvas.getBoundingClientRect();
    canvas.dispatchEvent(new PointerEvent(type, {clientX: box.left + u * box.width, clientY: box.top + 1, pointerId: 1, bubbles: true}));
  };
  look('picture');
  press(' '); look('reference');
  press('1'); look('picture again');
  press('0'); look('reference again');
  press('s'); look('split');
  point('pointerdown', 0.5); point('pointermove', 0.25); point('pointerup', 0.25); look('split at a quarter');
  press('d'); look('difference');
  press('g'); look('difference times 16');
  press('f'); press(']'); look('brighter');
  press('['); look('reference at last');
  const before = canvas.getBoundingClientRect().width;
  press('+');
  seen.zoom = canvas.getBoundingClientRect().width / before;
  viewer.querySelector('button[data-key=s] kbd').click();
  seen.mode = viewer.dataset.mode;
  document.getElementById('seen').textContent = JSON.stringify(seen);
});
</script></body>)";

TEST_F(Compare, TheViewerAnswersToKeysAndTheMouseInABrowser)
{
    const std::filesystem::path browser = "/usr/bin/chromium";
    if (!std::filesystem::exists(browser))
        GTEST_SKIP() << "SKIPPED, VIEWER NOT TESTED: chromium is not installed (Debian package chromium)";
    const std::string page = directory / "page.html";
    runWell({"compare", first(), second(), "--html", page});
    std::string html = readFile(page);
    html.replace(html.rfind("</body>"), 7, PERSON);
    writeFile(page, html);

    const Outcome outcome =
        runProgram(browser, {.arguments = {"--headless", "--no-sandbox", "--disable-gpu", "--enable-logging=stderr",
                                           "--user-data-dir=" + directory / "profile", "--virtual-time-budget=20000",
                                           "--dump-dom", "file://" + page}});
    EXPECT_EQ(outcome.err.find("CONSOLE"), std::string::npos) << outcome.err; // errors, and what the policy refused
    const size_t start = outcome.out.find("<pre id=\"seen\">{");
    ASSERT_NE(start, std::string::npos) << outcome.out.substr(0, 2000) << outcome.err;
    const size_t from = start + 15, to = outcome.out.find("</pre>", from);
    const nlohmann::json seen = nlohmann::json::parse(outcome.out.substr(from, to - from));

    EXPECT_NE(seen["picture"], seen["reference"]);
    EXPECT_EQ(seen["picture"], seen["picture again"]);
    EXPECT_EQ(seen["reference"], seen["reference again"]);
    EXPECT_EQ(seen["reference"], seen["reference at last"]);
    for (const char* view : {"split", "split at a quarter", "difference", "difference times 16", "brighter"})
        for (const auto& [other, sum] : seen.items()) EXPECT_TRUE(other == view || seen[view] != sum) << view << other;
    EXPECT_EQ(seen["zoom"], 2);
    EXPECT_EQ(seen["mode"], "split");
}
