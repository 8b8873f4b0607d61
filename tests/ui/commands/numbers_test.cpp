// Every option of every command that takes a number refuses what is none: nan passes each comparison that asks whether
// a value is too small or too large. The options are asked of the command line itself, so none can be forgotten.

#include "passes/settings.h"
#include "ui/commands/commands.h"

#include <gtest/gtest.h>

#include <regex>
#include <set>

namespace
{

// Why a command does not take a value for an option; empty when it does. That other options are missing is no reason:
// values are looked at first.
std::string complaint(const ui::Command& command, const std::string& option, const std::string& value)
{
    CLI::App app;
    const ui::Action action = command.setUp(app); // holds what the options write to
    try {
        app.parse(std::vector<std::string>{option + "=" + value});
    } catch (const CLI::ValidationError& error) {
        return error.what();
    } catch (const CLI::ConversionError& error) {
        return error.what();
    } catch (const CLI::RequiredError&) {
    } catch (const CLI::RequiresError&) { // another option, which this one goes with
    }
    return "";
}

// Of those that take values, with their dashes.
std::vector<std::string> optionsOf(const ui::Command& command)
{
    CLI::App app;
    const ui::Action action = command.setUp(app);
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options())
        if (option->get_expected_max() > 0 && !option->get_positional()) names.push_back(option->get_name());
    return names;
}

const char* const NO_NUMBERS[] = {"nan", "NaN", "-nan", "nan(1)", "inf", "-inf", "Infinity", "1e999", "-1e999", "1x"};

void expectRefusal(const std::string& said, const std::string& option, const std::string& value)
{
    EXPECT_NE(said, "") << option << " takes " << value;
    EXPECT_NE(said.find(option), std::string::npos) << said;
    EXPECT_NE(said.find("\"" + value + "\""), std::string::npos) << said;
}

} // namespace

TEST(Numbers, EveryOptionOfEveryCommandRefusesWhatIsNone)
{
    for (const ui::Command& command : ui::commands()) {
        size_t numbers = 0;
        for (const std::string& option : optionsOf(command)) {
            SCOPED_TRACE(std::string(command.name) + " " + option);
            if (option == "--set" || complaint(command, option, "word").empty()) continue; // a name, a file, a list
            for (const char* value : NO_NUMBERS) expectRefusal(complaint(command, option, value), option, value);
            const auto takes = [&](const char* value) { return complaint(command, option, value).empty(); };
            if (!takes("1") && !takes("10") && !takes("100")) continue; // words
            ++numbers;
            const std::regex range("[0-9] to [0-9]|below 2\\^64");
            const std::string said = complaint(command, option, "nan");
            EXPECT_TRUE(std::regex_search(said, range)) << said;
        }
        EXPECT_GE(numbers, 2u) << command.name; // of compare: --max-flip, --min-psnr
    }
}

TEST(Numbers, SetByNameTooRefusesWhatIsNone)
{
    const std::set<std::string> texts = {"camera", "environment"};
    for (const ui::Command& command : ui::commands()) {
        if (std::string(command.name) == "compare") continue; // has no settings
        for (const passes::KnobText& knob : passes::describeSettings())
            for (const char* value : NO_NUMBERS) {
                if (texts.contains(knob.name)) continue;
                const std::string said = complaint(command, "--set", knob.name + "=" + value);
                EXPECT_NE(said.find("\"" + knob.name + "\""), std::string::npos) << knob.name << value << said;
                EXPECT_NE(said.find("\"" + std::string(value) + "\""), std::string::npos) << said;
            }
    }
}
