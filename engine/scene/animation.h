#pragma once
// Animations: what they move, and its value at a time (glTF 2.0, 3.11 and appendix C; KHR_animation_pointer).

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace scene
{

enum class Interpolation : uint8_t { Step, Linear, CubicSpline };

enum class Owner : uint8_t { Node, Light, Camera, Material };

enum class Property : uint8_t {
    Translation,
    Rotation,
    Scale,
    Weights,
    Visible,
    LightColor,
    LightIntensity,
    InnerCone,
    OuterCone,
    Yfov,
    Xmag,
    Ymag,
    BaseColor,
    Metallic,
    Roughness,
    EmissiveFactor,
    EmissiveStrength,
};

struct PropertyFacts {
    Property property;
    Owner owner;
    uint32_t width;      // numbers of a value; 0: one for each morph target
    const char* pointer; // KHR_animation_pointer's, with # for the owner's index
    const char* words;   // for people
};
constexpr std::array<PropertyFacts, 17> PROPERTIES = {{
    {Property::Translation, Owner::Node, 3, "/nodes/#/translation", "translation"},
    {Property::Rotation, Owner::Node, 4, "/nodes/#/rotation", "rotation"},
    {Property::Scale, Owner::Node, 3, "/nodes/#/scale", "scale"},
    {Property::Weights, Owner::Node, 0, "/nodes/#/weights", "morph weights"},
    {Property::Visible, Owner::Node, 1, "/nodes/#/extensions/KHR_node_visibility/visible", "visibility"},
    {Property::LightColor, Owner::Light, 3, "/extensions/KHR_lights_punctual/lights/#/color", "light color"},
    {Property::LightIntensity, Owner::Light, 1, "/extensions/KHR_lights_punctual/lights/#/intensity",
     "light intensity"},
    {Property::InnerCone, Owner::Light, 1, "/extensions/KHR_lights_punctual/lights/#/spot/innerConeAngle",
     "inner cone"},
    {Property::OuterCone, Owner::Light, 1, "/extensions/KHR_lights_punctual/lights/#/spot/outerConeAngle",
     "outer cone"},
    {Property::Yfov, Owner::Camera, 1, "/cameras/#/perspective/yfov", "field of view"},
    {Property::Xmag, Owner::Camera, 1, "/cameras/#/orthographic/xmag", "view width"},
    {Property::Ymag, Owner::Camera, 1, "/cameras/#/orthographic/ymag", "view height"},
    {Property::BaseColor, Owner::Material, 4, "/materials/#/pbrMetallicRoughness/baseColorFactor", "base color"},
    {Property::Metallic, Owner::Material, 1, "/materials/#/pbrMetallicRoughness/metallicFactor", "metallic factor"},
    {Property::Roughness, Owner::Material, 1, "/materials/#/pbrMetallicRoughness/roughnessFactor", "roughness"},
    {Property::EmissiveFactor, Owner::Material, 3, "/materials/#/emissiveFactor", "emission"},
    {Property::EmissiveStrength, Owner::Material, 1,
     "/materials/#/extensions/KHR_materials_emissive_strength/emissiveStrength", "emissive strength"},
}};
constexpr const PropertyFacts& factsOf(Property property)
{
    return PROPERTIES[static_cast<size_t>(property)];
}

// Moves one property of one object.
struct Channel {
    Property property = Property::Translation;
    uint32_t object = 0; // of the owner's kind: an index into Motion's list
    Interpolation interpolation = Interpolation::Linear;
    uint32_t width = 0;  // numbers of a value
    uint32_t times = 0;  // the array of Motion::numbers with the keys' times: seconds, increasing
    uint32_t values = 0; // ... with `width` numbers a key; CubicSpline: in-tangent, value, out-tangent of each
};

struct Animation {
    std::string name;              // of the file; empty: none
    std::string fault;             // a sentence: why it cannot be played. Empty: it can
    std::vector<Channel> channels; // no two of the same property of the same object
    double seconds = 0;            // the time of the last key
};

// The value at `seconds`, `value.size()` numbers. Before the first key and after the last it is held. Rotations go the
// shorter way about and come back unit. `times` is not empty.
void interpolate(Interpolation interpolation, bool rotation, std::span<const float> times,
                 std::span<const float> values, double seconds, std::span<double> value);

} // namespace scene
