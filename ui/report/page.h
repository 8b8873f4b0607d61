#pragma once
// A report as one HTML file that needs nothing else: style, plots and pictures are inside, so it works offline. Its
// content security policy keeps it from loading anything.

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "passes/settings.h"

namespace ui
{

// Text as it appears in HTML, also within quotes of an attribute.
std::string escapeHtml(const std::string& text);

// "data:image/png;base64,..." of a PNG file's bytes.
std::string pngAddress(std::span<const std::byte> png);

// Where figures come from, for whoever wants them again.
struct Provenance {
    std::string command; // the line that reproduces them
    std::string scene;   // empty: nothing was rendered
    std::string device, driver;
    std::vector<std::pair<std::string, std::string>> settings; // passes::toText, and what else decides the figures
    bool partial = false;                                      // stopped before the end
};

class Page
{
  public:
    explicit Page(std::string title);

    void heading(const std::string& text);
    void paragraph(const std::string& text);
    void verdict(const std::string& text); // a sentence that stands out
    // Numbers are aligned to the right. Every row has as many cells as the header.
    void table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows);
    void plot(const std::string& svg, const std::string& caption);
    void picture(std::span<const std::byte> png, const std::string& caption);
    void provenance(const Provenance& provenance); // with version and date
    void raw(const std::string& html);             // already escaped

    std::string html() const;

  private:
    std::string title_, body_;
};

// The process's own command line, quoted for a POSIX shell.
std::string commandLine();

} // namespace ui
