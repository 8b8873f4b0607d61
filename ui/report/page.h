#pragma once
// A report as one HTML file that needs nothing else: style, script, plots and pictures are inside, so it works offline.
// Its content security policy keeps it from loading anything.

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace ui
{

// Fills a template in the language mustache, which may name any file of assets/pages as a partial, with texts (escaped
// where it says {{}}), booleans, lists and objects. An empty text is false.
std::string fillPage(const std::string& html, const nlohmann::json& data);

// For table.html. Numbers are aligned to the right. Every row has as many cells as the header.
nlohmann::json tableData(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows);

// "data:image/png;base64,..." of a PNG file's bytes.
std::string pngAddress(std::span<const std::byte> png);

std::string inlineSvg(const std::string& svg); // without what stands before its element in a file

// Where figures come from, for whoever wants them again.
struct Provenance {
    std::string command; // the line that reproduces them
    std::string scene;   // empty: nothing was rendered
    std::string device, driver;
    std::vector<std::pair<std::string, std::string>> settings; // passes::toText, and what else decides the figures
    bool partial = false;                                      // stopped before the end
};
nlohmann::json provenanceData(const Provenance& provenance); // for provenance.html; with version and date

// The process's own command line, quoted for a POSIX shell.
std::string commandLine();

} // namespace ui
