#include "ui/report/page.h"

#include "engine/base/check.h"
#include "ui/cli/run_report.h"

#include <chrono>
#include <fstream>

#include <fmt/chrono.h>
#include <fmt/format.h>

namespace ui
{

namespace
{

constexpr const char* STYLE = R"(
body { font: 16px/1.5 system-ui, sans-serif; max-width: 72rem; margin: 2rem auto; padding: 0 1rem; color: #1d2330; background: #fff; }
h1 { font-size: 1.7rem; } h2 { font-size: 1.25rem; margin-top: 2.2rem; border-bottom: 1px solid #d5dae3; }
table { border-collapse: collapse; margin: 1rem 0; display: block; overflow-x: auto; }
th, td { padding: .25rem .8rem; border-bottom: 1px solid #e4e8ef; text-align: left; white-space: nowrap; }
th { background: #f3f5f9; } td.number { text-align: right; font-variant-numeric: tabular-nums; }
figure { margin: 1rem 0; } figure img, figure svg { max-width: 100%; height: auto; } figcaption { color: #566074; font-size: .9rem; }
.verdict { background: #eef4ff; border-left: 4px solid #3a6fd8; padding: .5rem 1rem; }
.partial { background: #fff3e0; border-left: 4px solid #d98200; padding: .5rem 1rem; }
code, pre { font: .85rem/1.4 ui-monospace, monospace; background: #f3f5f9; }
pre { padding: .6rem .8rem; overflow-x: auto; white-space: pre-wrap; word-break: break-all; }
details { margin: .5rem 0; } summary { cursor: pointer; }
)";

bool isNumber(const std::string& text)
{
    return !text.empty() && text.find_first_not_of("0123456789+-.,eE%x× ±<>≤≥infa") == std::string::npos &&
           text.find_first_of("0123456789") != std::string::npos;
}

std::string shellQuoted(const std::string& argument)
{
    const std::string plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%";
    if (!argument.empty() && argument.find_first_not_of(plain) == std::string::npos) return argument;
    std::string result = "'";
    for (const char c : argument) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return result + "'";
}

} // namespace

std::string escapeHtml(const std::string& text)
{
    std::string result;
    for (const char c : text) {
        switch (c) {
        case '&': result += "&amp;"; break;
        case '<': result += "&lt;"; break;
        case '>': result += "&gt;"; break;
        case '"': result += "&quot;"; break;
        case '\'': result += "&#39;"; break;
        default: result += c;
        }
    }
    return result;
}

std::string pngAddress(std::span<const std::byte> png)
{
    constexpr const char* DIGITS = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/"; // RFC 4648
    std::string result = "data:image/png;base64,";
    result.reserve(result.size() + (png.size() + 2) / 3 * 4);
    for (size_t i = 0; i < png.size(); i += 3) {
        const auto byte = [&](size_t k) { return i + k < png.size() ? std::to_integer<uint32_t>(png[i + k]) : 0u; };
        const uint32_t word = byte(0) << 16 | byte(1) << 8 | byte(2);
        for (size_t k = 0; k < 4; ++k)
            result += k == 0 || i + k - 1 < png.size() ? DIGITS[word >> (18 - 6 * k) & 63] : '=';
    }
    return result;
}

Page::Page(std::string title) : title_(std::move(title)) {}

void Page::heading(const std::string& text)
{
    body_ += "<h2>" + escapeHtml(text) + "</h2>\n";
}

void Page::paragraph(const std::string& text)
{
    body_ += "<p>" + escapeHtml(text) + "</p>\n";
}

void Page::verdict(const std::string& text)
{
    body_ += "<p class=\"verdict\">" + escapeHtml(text) + "</p>\n";
}

void Page::table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows)
{
    body_ += "<table>\n<tr>";
    for (const std::string& cell : header) body_ += "<th>" + escapeHtml(cell) + "</th>";
    body_ += "</tr>\n";
    for (const std::vector<std::string>& row : rows) {
        CHECK_EQ(row.size(), header.size());
        body_ += "<tr>";
        for (const std::string& cell : row)
            body_ += (isNumber(cell) ? "<td class=\"number\">" : "<td>") + escapeHtml(cell) + "</td>";
        body_ += "</tr>\n";
    }
    body_ += "</table>\n";
}

void Page::plot(const std::string& svg, const std::string& caption)
{
    body_ += "<figure>" + svg.substr(std::min(svg.find("<svg"), svg.size())) + "<figcaption>" + escapeHtml(caption) +
             "</figcaption></figure>\n";
}

void Page::picture(std::span<const std::byte> png, const std::string& caption)
{
    body_ += "<figure><img src=\"" + pngAddress(png) + "\" alt=\"" + escapeHtml(caption) + "\"><figcaption>" +
             escapeHtml(caption) + "</figcaption></figure>\n";
}

void Page::provenance(const Provenance& provenance)
{
    if (provenance.partial)
        body_ +=
            "<p class=\"partial\">Partial: the run was stopped before its end; the figures are of what it did.</p>\n";
    const auto now = fmt::gmtime(std::chrono::system_clock::now());
    const std::string where = provenance.scene.empty()
                                  ? ""
                                  : fmt::format("Scene <b>{}</b> on {} ({}); ", escapeHtml(provenance.scene),
                                                escapeHtml(provenance.device), escapeHtml(provenance.driver));
    body_ += fmt::format("<p>{}Trichrome {}, {:%Y-%m-%d %H:%M} UTC.</p>\n<pre>{}</pre>\n", where, version(), now,
                         escapeHtml(provenance.command));
    if (provenance.settings.empty()) return;
    body_ += "<details><summary>All settings</summary>\n";
    std::vector<std::vector<std::string>> rows;
    for (const auto& [name, value] : provenance.settings) rows.push_back({name, value});
    table({"setting", "value"}, rows);
    body_ += "</details>\n";
}

void Page::raw(const std::string& html)
{
    body_ += html;
}

std::string Page::html() const
{
    return fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width\">\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
        "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n<title>{0}</title>\n<style>{1}</style>\n"
        "</head>\n<body>\n<h1>{0}</h1>\n{2}</body>\n</html>\n",
        escapeHtml(title_), STYLE, body_);
}

std::string commandLine()
{
    std::ifstream file("/proc/self/cmdline", std::ios::binary);
    std::string line;
    for (std::string argument; std::getline(file, argument, '\0');)
        line += (line.empty() ? "" : " ") + shellQuoted(argument);
    return line;
}

} // namespace ui
