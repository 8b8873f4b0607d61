#include "ui/cli/help.h"

#include <fmt/format.h>

#include <sstream>

namespace ui
{

namespace
{

constexpr size_t WIDTH = 100; // columns
constexpr const char* INDENT = "      ";

std::string wrapped(const std::string& text)
{
    std::string lines, line;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        if (!line.empty() && line.size() + 1 + word.size() > WIDTH) {
            lines += INDENT + line + "\n";
            line.clear();
        }
        line += (line.empty() ? "" : " ") + word;
    }
    return lines + INDENT + line + "\n";
}

} // namespace

std::string HelpFormatter::make_option(const CLI::Option* option, bool positional) const
{
    const std::string values = make_option_opts(option);
    return fmt::format("  {}{}{}\n{}", make_option_name(option, positional), values.empty() ? "" : " ", values,
                       wrapped(make_option_desc(option)));
}

std::string HelpFormatter::make_subcommand(const CLI::App* command) const
{
    return fmt::format("  {:<10} {}\n", command->get_name(), command->get_description());
}

} // namespace ui
