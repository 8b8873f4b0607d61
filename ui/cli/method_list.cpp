#include "ui/cli/method_list.h"

#include "engine/base/files.h"
#include "passes/estimator.h"
#include "ui/cli/presets.h"
#include "ui/cli/usage_error.h"

#include <algorithm>

namespace ui
{

namespace
{

std::vector<std::string> split(const std::string& text, char separator)
{
    std::vector<std::string> parts(1);
    for (const char c : text) {
        if (c == separator)
            parts.emplace_back();
        else
            parts.back() += c;
    }
    return parts;
}

void applyWord(passes::Settings& settings, const std::string& word, bool first)
{
    const size_t equals = word.find('=');
    const std::vector<std::string> presets = presetNames();
    if (first && (files::extensionOf(word) == ".json" || std::ranges::find(presets, word) != presets.end()))
        applyPreset(settings, word);
    else if (first)
        passes::set(settings, "method", word);
    else if (equals == std::string::npos)
        passes::set(settings, "shift", word);
    else
        passes::set(settings, word.substr(0, equals), word.substr(equals + 1));
}

// Every method with every way of reading its color that shows another picture, with and without mutations.
std::string allMethods()
{
    std::string list = "pt";
    for (const passes::Estimator& estimator : passes::estimators())
        for (const char* color : passes::WORDS_OF<passes::Color>) {
            const std::string method = estimator.name + (oneHot(estimator) ? "" : std::string(":color=") + color);
            for (const char* mutate : passes::WORDS_OF<passes::Mutate>)
                list += "," + method +
                        (mutate == passes::WORDS_OF<passes::Mutate>.front() ? "" : std::string(":mutate=") + mutate);
            if (oneHot(estimator)) break;
        }
    return list;
}

// What must be the same for all: the picture that they estimate, and what the command itself decides.
void requireComparable(const passes::Settings& settings, const passes::Settings& base, const std::string& entry)
{
    for (const passes::Difference& one : passes::differences(base, settings))
        if (one.knob.role != passes::Role::Estimator)
            throw UsageError("--methods: \"{}\" sets {} to \"{}\", but what is compared must share it; it is \"{}\".",
                             entry, one.knob.name, one.b, one.a);
}

} // namespace

std::vector<passes::NamedMethod> readMethods(const std::string& list, const passes::Settings& base)
{
    std::vector<passes::NamedMethod> methods;
    for (const std::string& entry : split(list == "all" ? allMethods() : list, ',')) {
        passes::NamedMethod method{entry, base};
        const std::vector<std::string> words = split(entry, ':');
        try {
            for (size_t i = 0; i < words.size(); ++i) applyWord(method.settings, words[i], i == 0);
        } catch (const Error& error) {
            throw UsageError("--methods: \"{}\" is no method: {}", entry, error.what());
        }
        requireComparable(method.settings, base, entry);
        if (std::ranges::any_of(methods, [&](const passes::NamedMethod& other) { return other.name == entry; }))
            throw UsageError("--methods: \"{}\" is there twice.", entry);
        methods.push_back(std::move(method));
    }
    return methods;
}

void addMethodsOption(CLI::App& app, std::string& list, const std::string& initial)
{
    list = initial;
    app.add_option(
           "--methods", list,
           "What is compared, separated by commas: METHOD, or a preset or its FILE.json, then :SHIFT or :NAME=VALUE as "
           "often as needed, as in rgb-restir:replay:spatial=0; or all: every method with every way of reading color, "
           "with and "
           "without mutations. "
           "Other settings are common to all.")
        ->option_text("LIST (" + initial + ")");
}

} // namespace ui
