#pragma once
// One of the methods that an experiment compares.

#include <string>

#include "passes/settings.h"

namespace passes
{

struct NamedMethod {
    std::string name; // for people and files, unique in its experiment
    Settings settings;
};

} // namespace passes
