#pragma once
// How --help looks: each option on a line of its own, its documentation wrapped below.

#include <CLI/CLI.hpp>

namespace ui
{

class HelpFormatter : public CLI::Formatter
{
  public:
    std::string make_option(const CLI::Option* option, bool positional) const override;
    std::string make_subcommand(const CLI::App* command) const override;
};

} // namespace ui
