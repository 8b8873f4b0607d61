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
    const std::string html = ui::fillPage(R"({{> head.html}}{{> verdicts.html}}
{{#table}}{{> table.html}}{{/table}}<figure>{{{svg}}}</figure><img alt="{{quoted}}">
{{#empty}}never{{/empty}}{{> provenance.html}}{{> foot.html}})",
                                          {{"title", "a <b> & \"c\""},
                                           {"verdicts", std::vector<std::string>{"<script>", "x < y"}},
                                           {"table", ui::tableData({"name", "value"}, {{"<i>", "1.5"}, {"", "none"}})},
                                           {"svg", ui::inlineSvg("<?xml version=\"1.0\"?>\n<svg></svg>")},
                                           {"quoted", "it's"},
                                           {"empty", ""},
                                           {"provenance", ui::provenanceData({.command = "trichrome 'a b' && rm",
                                                                              .scene = "<scene>",
                                                                              .device = "d",
                                                                              .driver = "e",
                                                                              .settings = {{"method", "pt"}},
                                                                              .partial = true})}});
    for (const char* none : {"<script>", "<?xml", "http:", "https:", "src=\"/", "{{", "never", "&amp;lt;"})
        EXPECT_EQ(html.find(none), std::string::npos) << none;
    for (const char* part : {"<h1>a &lt;b&gt; &amp; &quot;c&quot;</h1>", "font-variant-numeric",
                             "<p class=\"verdict\">x &lt; y</p>", "<tr><th>name</th><th>value</th></tr>",
                             "<td>&lt;i&gt;</td>", "<td class=\"number\">1.5</td>", "<td></td><td>none</td>",
                             "<svg></svg>", "alt=\"it&apos;s\"", "<pre>trichrome &apos;a b&apos; &amp;&amp; rm</pre>",
                             "<b>&lt;scene&gt;</b> on d (e)", "Partial", "<td>method</td><td>pt</td>"})
        EXPECT_NE(html.find(part), std::string::npos) << part << " in\n" << html;
}

TEST(Page, KnowsTheCommandLine)
{
    const std::string line = ui::commandLine(); // of this test: ctest gives it --gtest_filter=Page.Knows...
    EXPECT_NE(line.find("test_ui_report"), std::string::npos) << line;
    EXPECT_EQ(line.find('\0'), std::string::npos);
}
