#pragma once
// Animations of a file (glTF 2.0, 3.11; KHR_animation_pointer): what they move is read from the JSON, their keys from
// the buffers. One that breaks a rule is not played, with a warning; what breaks the structure (gltf_json_checks.h) is
// refused.

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "engine/scene/animation.h"
#include "engine/scene/gltf_json.h"
#include "engine/scene/warnings.h"

namespace scene::gltf
{

struct Document;

// A channel before its keys are read.
struct ChannelSource {
    Channel channel;     // `object` counts nodes, lights, cameras or materials of the file; `times` and `values` are
                         // accessors; of Weights, `width` is not known yet
    std::string sampler; // where: animations[0].samplers[1]
};

struct AnimationSource {
    std::string name;
    std::string fault; // as of Animation
    std::vector<ChannelSource> channels;
};

// The factors of a material's emission.
struct EmissionSource {
    glm::dvec3 factor = {0, 0, 0};
    double strength = 1;
};

struct AnimationSources {
    std::vector<AnimationSource> animations;
    std::map<uint32_t, EmissionSource> emissions;  // of the materials that are animated
    std::set<std::pair<Property, uint32_t>> moved; // by any of them; the object as above
};

// Channels without a target, or with one that this program does not follow, are left out with a warning. Throws Error
// for nothing but a broken structure.
AnimationSources listAnimations(const Object& document, Warnings& warnings);

// Reads the keys: fills `numbers`, to which `times` and `values` of the channels then refer. Accessors that several
// channels share are read and checked once.
std::vector<Animation> readAnimations(const Document& document, std::vector<std::vector<float>>& numbers,
                                      Warnings& warnings);

} // namespace scene::gltf
