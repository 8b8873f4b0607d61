#pragma once
// What a scene and the settings need, as specialisation constants: the fields of Variant are the lines of
// shaders/shared/variant.h. Every pipeline gets the same Variant.

#include <map>
#include <string>
#include <vector>

#include "engine/gpu/gpu.h"
#include "engine/scene/gpu_scene.h"
#include "passes/settings.h"
#include "shaders/shared/variant.h"

namespace passes
{

struct Variant {
    using uint = uint32_t;
#define DECLARE_FIELD(ID, TYPE, NAME, DEFAULT, WHAT) TYPE NAME = DEFAULT;
    VARIANT_CONSTANTS(DECLARE_FIELD)
#undef DECLARE_FIELD

    bool operator==(const Variant&) const = default;
};

Variant makeVariant(const scene::SceneFeatures& features, const Settings& settings, bool orthographic,
                    const scene::TraversalStack& stack, bool moves = false);

Variant withAllFeatures(Variant variant); // with everything that scenes can need compiled in

std::vector<gpu::Constant> constants(const Variant& variant);

// For people: name of the constant -> "5", "on" or "off"; and what each one compiles in.
std::map<std::string, std::string> describe(const Variant& variant);
std::map<std::string, std::string> variantMeanings();

} // namespace passes
