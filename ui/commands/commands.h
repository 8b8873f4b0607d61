#pragma once
// The subcommands. Adding one: a file beside this one with its setUp function, and one line in commands.cpp.

#include <functional>
#include <span>

#include <CLI/CLI.hpp>

namespace ui
{

// What runs once the command line is parsed. Returns the exit code; throws Error or UsageError.
using Action = std::function<int()>;

struct Command {
    const char* name;
    const char* summary;            // one line
    Action (*setUp)(CLI::App& app); // adds the command's options
    bool shares = false;            // can spread its work over the processes that mpirun starts
};
std::span<const Command> commands();

Action setUpCompare(CLI::App& app);
Action setUpConverge(CLI::App& app);
Action setUpCorrelate(CLI::App& app);
Action setUpInfo(CLI::App& app);
Action setUpRender(CLI::App& app);
Action setUpView(CLI::App& app);

} // namespace ui
