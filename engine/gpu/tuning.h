#pragma once
// What is chosen by the class of a device, and can be overridden by name. No choice changes what is computed, but for
// rounding.

#include <cstdint>
#include <string>
#include <vector>

namespace gpu
{

struct Tuning {
    enum class Tables : uint32_t { Texel, Storage };             // Usage::Table: texel buffers or storage buffers
    enum class Loops : uint32_t { End, Start };                  // where loops test (shaders/lib/lanes.glsl)
    enum class Stack : uint32_t { Registers, Array };            // of traversal (shaders/scene/intersect.glsl)
    enum class Counters : uint32_t { Each, Subgroup, Off };      // how they add (shaders/lib/frame.glsl)
    enum class Contraction : uint32_t { Allowed, Forbidden };    // of a product and a sum into one operation
    enum class Shaders : uint32_t { Plain, Pruned, Simplified }; // as drivers get them
    Tables tables{};
    Loops loops{};
    Stack stack{};
    Counters counters{};
    Contraction contraction{};
    Shaders shaders{};
    bool operator==(const Tuning&) const = default;
};

// What the choices depend on.
struct DeviceClass {
    bool cpu = false;
    bool texelTables = false;  // its limits let texel buffers hold the tables
    bool subgroupSums = false; // subgroup arithmetic in compute shaders
    bool operator==(const DeviceClass&) const = default;
};
Tuning tuningFor(const DeviceClass& device);

// "NAME=VALUE,..." over what was chosen; empty: nothing. Throws Error: unknown names and values, a name twice.
void applyOverrides(Tuning& tuning, const std::string& list);
// Throws Error that names `deviceName`: it cannot do what is asked for.
void requirePossible(const Tuning& tuning, const DeviceClass& device, const std::string& deviceName);

// One choice in words, as overrides name it.
struct TuningText {
    std::string name;
    std::string value;
    std::vector<std::string> values; // all that there are
    std::string meaning;
};
std::vector<TuningText> describe(const Tuning& tuning);
std::string toText(const Tuning& tuning); // "NAME=VALUE,...", all of them

} // namespace gpu
