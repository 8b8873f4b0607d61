#include "engine/gpu/tuning.h"

#include "engine/base/error.h"
#include "shaders/shared/tuning.h"

#include <algorithm>
#include <set>

#include <fmt/ranges.h>

namespace gpu
{

namespace
{

static_assert(uint32_t(Tuning::Counters::Each) == shared::COUNTERS_EACH &&
              uint32_t(Tuning::Counters::Subgroup) == shared::COUNTERS_SUBGROUP &&
              uint32_t(Tuning::Counters::Off) == shared::COUNTERS_OFF);

using Names = std::vector<std::string>;

// visit(name, choice, names of its values in their order, meaning)
template <class AnyTuning, class Visit>
void visitTuning(AnyTuning& tuning, Visit&& visit)
{
    visit("tables", tuning.tables, Names{"texel", "storage"}, "scene data in texel buffers or in storage buffers");
    visit("loops", tuning.loops, Names{"end", "start"}, "where loops over nodes and paths test");
    visit("stack", tuning.stack, Names{"registers", "array"},
          "traversal stack in registers, where 16 of them hold it, or in an indexed array");
    visit("counters", tuning.counters, Names{"each", "subgroup", "off"},
          "rays and shifts are counted by each invocation, as sums of a subgroup, or not at all");
    visit("contraction", tuning.contraction, Names{"allowed", "forbidden"},
          "may drivers make one operation of a product and a sum, with other last bits in each pipeline");
    visit("shaders", tuning.shaders, Names{"plain", "pruned", "simplified"},
          "drivers get shaders as they are, without what constants rule out, or with functions and variables resolved, "
          "too");
}

void applyOverride(Tuning& tuning, const std::string& name, const std::string& value)
{
    Names all;
    bool known = false;
    visitTuning(tuning, [&](const char* own, auto& choice, const Names& values, const char*) {
        all.emplace_back(own);
        if (name != own) return;
        known = true;
        const auto found = std::ranges::find(values, value);
        if (found == values.end())
            throw Error("\"{}\" is no value of the device tuning \"{}\"; there are: {}.", value, name,
                        fmt::join(values, ", "));
        choice = std::remove_reference_t<decltype(choice)>(found - values.begin());
    });
    if (!known) throw Error("There is no device tuning \"{}\"; there are: {}.", name, fmt::join(all, ", "));
}

} // namespace

Tuning tuningFor(const DeviceClass& device)
{
    // Without subgroup arithmetic a driver must not even see it; simplified shaders have lost what the constants rule
    // out.
    const Tuning::Shaders shaders = device.subgroupSums ? Tuning::Shaders::Plain : Tuning::Shaders::Simplified;
    if (!device.cpu) // as such devices are understood to work: not measured on any
        return {.tables = Tuning::Tables::Storage,
                .loops = Tuning::Loops::Start,
                .stack = Tuning::Stack::Array,
                .counters = device.subgroupSums ? Tuning::Counters::Subgroup : Tuning::Counters::Each,
                .contraction = Tuning::Contraction::Forbidden,
                .shaders = shaders};
    if (device
            .texelTables) // Mesa's lavapipe, which runs 8 lanes under masks; each choice measured (tests/bench/LOG.md)
        return {.tables = Tuning::Tables::Texel,
                .loops = Tuning::Loops::End,
                .stack = Tuning::Stack::Registers,
                .counters = Tuning::Counters::Each,
                .contraction = Tuning::Contraction::Allowed,
                .shaders = device.subgroupSums ? Tuning::Shaders::Pruned : Tuning::Shaders::Simplified};
    // SwiftShader: it compiles nested loops that test at their end wrongly, and keeps all variables of all that it
    // inlines in memory: what it compiles in seconds when simplified takes it more than 24 GB as it is.
    return {.tables = Tuning::Tables::Storage,
            .loops = Tuning::Loops::Start,
            .stack = Tuning::Stack::Array,
            .counters = Tuning::Counters::Each,
            .contraction = Tuning::Contraction::Allowed,
            .shaders = Tuning::Shaders::Simplified};
}

void applyOverrides(Tuning& tuning, const std::string& list)
{
    std::set<std::string> given;
    for (size_t begin = 0; begin < list.size();) {
        const size_t end = std::min(list.find(',', begin), list.size());
        const std::string assignment = list.substr(begin, end - begin);
        const size_t equals = assignment.find('=');
        if (equals == std::string::npos)
            throw Error("\"{}\" is not of the form NAME=VALUE,... of device tunings.", assignment);
        const std::string name = assignment.substr(0, equals);
        if (!given.insert(name).second) throw Error("The device tuning \"{}\" is given twice.", name);
        applyOverride(tuning, name, assignment.substr(equals + 1));
        begin = end + 1;
    }
}

void requirePossible(const Tuning& tuning, const DeviceClass& device, const std::string& deviceName)
{
    if (tuning.tables == Tuning::Tables::Texel && !device.texelTables)
        throw Error("Device tuning tables=texel is beyond \"{}\": its texel buffers are too small or too few.",
                    deviceName);
    if (tuning.counters == Tuning::Counters::Subgroup && !device.subgroupSums)
        throw Error("Device tuning counters=subgroup is beyond \"{}\": it has no subgroup arithmetic.", deviceName);
    if (tuning.shaders == Tuning::Shaders::Plain && !device.subgroupSums)
        throw Error("Device tuning shaders=plain is beyond \"{}\": it has no subgroup arithmetic.", deviceName);
}

std::vector<TuningText> describe(const Tuning& tuning)
{
    std::vector<TuningText> list;
    visitTuning(tuning, [&](const char* name, const auto& choice, const Names& values, const char* meaning) {
        list.push_back({name, values[size_t(choice)], values, meaning});
    });
    return list;
}

std::string toText(const Tuning& tuning)
{
    std::vector<std::string> words;
    for (const TuningText& text : describe(tuning)) words.push_back(text.name + "=" + text.value);
    return fmt::format("{}", fmt::join(words, ","));
}

} // namespace gpu
