#include "ui/report/page.h"

#include "engine/base/check.h"
#include "ui/cli/run_report.h"

#include <chrono>
#include <fstream>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <kainjow/mustache.hpp>

#include <generated_pages.h>

namespace ui
{

namespace
{

using Json = nlohmann::json;
using kainjow::mustache::data;

data dataOf(const Json& json)
{
    if (json.is_object()) {
        data object;
        for (const auto& [name, value] : json.items()) object[name] = dataOf(value);
        return object;
    }
    if (json.is_array()) {
        kainjow::mustache::list list;
        for (const Json& value : json) list.push_back(dataOf(value));
        return list;
    }
    if (json.is_boolean()) return json.get<bool>();
    const std::string& text = json.get_ref<const std::string&>();
    return text.empty() ? data(false) : data(text);
}

bool isNumber(const std::string& text)
{
    return !text.empty() && text.find_first_not_of("0123456789+-.,eE%x× ±<>≤≥infa") == std::string::npos &&
           text.find_first_of("0123456789") != std::string::npos;
}

} // namespace

std::string fillPage(const std::string& html, const Json& values)
{
    data all = dataOf(values);
    for (const auto& [name, text] : EMBEDDED_PAGES) all[name] = text;
    kainjow::mustache::mustache page(html);
    std::string filled = page.render(all);
    CHECK_EQ(page.error_message(), "");
    return filled;
}

Json tableData(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows)
{
    Json table = {{"header", header}, {"rows", Json::array()}};
    for (const std::vector<std::string>& row : rows) {
        CHECK_EQ(row.size(), header.size());
        Json& cells = table["rows"].emplace_back(Json::array());
        for (const std::string& cell : row) cells.push_back({{"text", cell}, {"number", isNumber(cell)}});
    }
    return table;
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

std::string inlineSvg(const std::string& svg)
{
    return svg.substr(std::min(svg.find("<svg"), svg.size()));
}

Json provenanceData(const Provenance& provenance)
{
    std::vector<std::vector<std::string>> rows;
    for (const auto& [name, value] : provenance.settings) rows.push_back({name, value});
    const auto now = fmt::gmtime(std::chrono::system_clock::now());
    return {{"partial", provenance.partial},
            {"scene", provenance.scene},
            {"device", provenance.device},
            {"driver", provenance.driver},
            {"version", version()},
            {"date", fmt::format("{:%Y-%m-%d %H:%M}", now)},
            {"command", provenance.command},
            {"settings", rows.empty() ? Json(false) : tableData({"setting", "value"}, rows)}};
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
