// Command line to command; the one place that catches Error. Exit codes: 0 done, 1 the world is wrong, 2 wrong usage,
// 130 interrupted by Ctrl-C, 143 by SIGTERM.

#include "engine/base/error.h"
#include "ui/cli/help.h"
#include "ui/cli/ranks.h"
#include "ui/cli/run_report.h"
#include "ui/cli/usage_error.h"
#include "ui/commands/commands.h"

#include <iostream>
#include <new>
#include <system_error>

namespace
{

constexpr int EXIT_WORLD = 1, EXIT_USAGE = 2;

ui::Ending trichrome(int argc, char** argv)
{
    CLI::App app("Trichrome renders glTF scenes by path tracing, ReSTIR PT and RGB ReSTIR on any Vulkan device.");
    app.name("trichrome");
    app.set_version_flag("--version", ui::version());
    app.require_subcommand(1);
    app.formatter(std::make_shared<ui::HelpFormatter>()); // inherited by the commands

    std::string names;
    bool known = argc < 2 || argv[1][0] == '-';
    ui::Action chosen;
    bool shares = false;
    for (const ui::Command& command : ui::commands()) {
        CLI::App& subcommand = *app.add_subcommand(command.name, command.summary);
        names += (names.empty() ? "" : ", ") + std::string(command.name);
        known = known || std::string(argv[1]) == command.name;
        subcommand.final_callback([action = command.setUp(subcommand), own = command.shares, &chosen, &shares] {
            chosen = action;
            shares = own;
        });
    }
    if (!known) throw ui::UsageError("There is no command \"{}\"; there are: {}.", argv[1], names);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        std::ostream nowhere(nullptr); // all processes have the same to say
        const bool speaks = ui::ranks().index() == 0;
        const int code = app.exit(error, speaks ? std::cout : nowhere, speaks ? std::cerr : nowhere);
        return {code == 0 ? 0 : EXIT_USAGE, {}}; // 0: --help, --version
    }
    if (!shares && ui::ranks().count() > 1)
        throw ui::UsageError("Only render and correlate share their work over processes; start this command once.");
    return {chosen(), {}};
}

ui::Ending guarded(int argc, char** argv)
{
    try {
        return trichrome(argc, argv);
    } catch (const ui::UsageError& error) {
        return {EXIT_USAGE, error.what()};
    } catch (const Error& error) {
        return {EXIT_WORLD, error.what()};
    } catch (const std::bad_alloc&) {
        return {EXIT_WORLD, "Out of memory."};
    } catch (const std::system_error& error) { // threads, folders
        return {EXIT_WORLD, fmt::format("The system refuses: {}.", error.what())};
    }
}

} // namespace

int main(int argc, char** argv)
{
    return ui::ranks().finish(guarded(argc, argv));
}
