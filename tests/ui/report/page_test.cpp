#include "ui/report/page.h"

#include <gtest/gtest.h>

namespace
{

std::vector<std::byte> bytesOf(const std::string& text)
{
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

} // namespace

TEST(Page, EncodesPicturesAsTheRfcDoes)
{
    const std::string prefix = "data:image/png;base64,";
    // RFC 4648, section 10.
    EXPECT_EQ(ui::pngAddress(bytesOf("")), prefix);
    EXPECT_EQ(ui::pngAddress(bytesOf("f")), prefix + "Zg==");
    EXPECT_EQ(ui::pngAddress(bytesOf("fo")), prefix + "Zm8=");
    EXPECT_EQ(ui::pngAddress(bytesOf("foo")), prefix + "Zm9v");
    EXPECT_EQ(ui::pngAddress(bytesOf("foobar")), prefix + "Zm9vYmFy");
}

TEST(Page, IsSelfContainedAndEscapesWhatItIsTold)
{
    ui::Page page("a <b> & \"c\"");
    page.heading("<script>");
    page.paragraph("x < y");
    page.table({"name", "value"}, {{"<i>", "1.5"}});
    page.plot("<?xml version=\"1.0\"?>\n<svg></svg>", "plot");
    page.picture(bytesOf("foo"), "it's");
    page.provenance({.command = "trichrome 'a b' && rm",
                     .scene = "<scene>",
                     .device = "d",
                     .driver = "e",
                     .settings = {{"method", "pt"}},
                     .partial = true});
    const std::string html = page.html();
    EXPECT_EQ(html.find("<script>"), std::string::npos);
    EXPECT_EQ(html.find("<?xml"), std::string::npos);
    for (const char* loading : {"http:", "https:", "src=\"/"}) EXPECT_EQ(html.find(loading), std::string::npos);
    for (const char* part :
         {"a &lt;b&gt; &amp; &quot;c&quot;", "x &lt; y", "<td>&lt;i&gt;</td>", "<td class=\"number\">1.5</td>",
          "<svg></svg>", "Zm9v", "it&#39;s", "trichrome &#39;a b&#39; &amp;&amp; rm", "&lt;scene&gt;", "Partial"})
        EXPECT_NE(html.find(part), std::string::npos) << part;
}

TEST(Page, KnowsTheCommandLine)
{
    const std::string line = ui::commandLine(); // of this test: ctest gives it --gtest_filter=Page.Knows...
    EXPECT_NE(line.find("test_ui_report"), std::string::npos) << line;
    EXPECT_EQ(line.find('\0'), std::string::npos);
}
