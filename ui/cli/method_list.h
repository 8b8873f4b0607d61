#pragma once
// --methods: several methods in one command, each with settings of its own.

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "passes/experiments/named_method.h"

namespace ui
{

// "pt,restir-pt:replay,rgb-restir:spatial=0:max-confidence=64,preset.json": each entry is a method or a preset, then a
// shift or NAME=VALUE as often as needed, on top of `base`; "all": every method with every way of reading color. Throws
// UsageError: anything else, an entry twice, settings that change what is seen (size, camera, bounces, filter,
// environment) or how long it is rendered.
std::vector<passes::NamedMethod> readMethods(const std::string& list, const passes::Settings& base);

// --methods into `list`, which must live until it is read.
void addMethodsOption(CLI::App& app, std::string& list, const std::string& initial);

} // namespace ui
