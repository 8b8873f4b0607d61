#pragma once
// One case, tried: first all regions of the picture, then what is suspicious again and again.

#include <cstdint>
#include <string>
#include <vector>

#include "tests/hunt/stand.h"
#include "tests/hunt/verdict.h"

namespace hunt
{

enum class Fault { None, Undecided, Different, Light, NotFinite, NotRepeatable, Validation, Failed };
constexpr const char* FAULT_NAMES[] = {
    "none",       "undecided",      "different",          "light where there is none",
    "not finite", "not repeatable", "validation message", "failed"};

struct Finding {
    Fault fault = Fault::None;
    int stages = 0; // that looked for it
    std::string where;
    double tried = 0, truth = 0, standardError = 0, p = 1; // radiance
    bool found() const { return fault > Fault::Undecided; }
    std::string describe() const;
};

struct Effort {
    double factor = 1;    // of samples
    int stages = 3;       // 1: suspicions only
    bool repeats = false; // are equal seeds equal pixels?
    double firstLevel = LEVELS[0];
};

// A device that says no is a finding, too.
Finding examine(gpu::Device& device, const std::shared_ptr<passes::PipelinePool>& pipelines, const Case& c,
                uint64_t seed, const Effort& effort = {});

} // namespace hunt
