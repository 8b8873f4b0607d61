#include "engine/scene/gltf_animations.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <span>

#include "engine/base/error.h"
#include "engine/scene/gltf_accessor.h"
#include "engine/scene/gltf_document.h"
#include "engine/scene/gltf_json_checks.h"

namespace scene::gltf
{

namespace
{

constexpr uint64_t MAX_NUMBERS = uint64_t{1} << 28; // of all keys: 1 GiB
constexpr const char* POINTER = "KHR_animation_pointer";

// The index that `pointer` has where `pattern` has its #; none: they differ elsewhere.
std::optional<uint32_t> indexIn(const std::string& pointer, std::string_view pattern)
{
    const size_t at = pattern.find('#');
    const std::string_view tail = pattern.substr(at + 1);
    if (!pointer.starts_with(pattern.substr(0, at)) || !pointer.ends_with(tail)) return std::nullopt;
    if (pointer.size() <= at + tail.size()) return std::nullopt;
    uint32_t index = 0;
    const char* end = pointer.data() + pointer.size() - tail.size();
    const auto [rest, problem] = std::from_chars(pointer.data() + at, end, index);
    if (problem != std::errc() || rest != end) return std::nullopt;
    return index;
}

size_t countOf(const Object& document, Owner owner)
{
    switch (owner) {
    case Owner::Node: return document.arraySize("nodes");
    case Owner::Camera: return document.arraySize("cameras");
    case Owner::Material: return document.arraySize("materials");
    case Owner::Light: break;
    }
    return lightCount(document);
}

class ChannelReader
{
  public:
    ChannelReader(const Object& document, AnimationSources& sources, Warnings& warnings)
        : document_(document), sources_(sources), warnings_(warnings)
    {
    }

    AnimationSource read(const Object& animation);

  private:
    using Target = std::pair<Property, uint32_t>; // and the object

    void readChannel(const Object& animation, const Object& channel, AnimationSource& result);
    std::optional<Target> targetOf(const Object& channel);
    std::optional<Target> pointedTo(const Object& target);
    void checkTarget(const Object& channel, const Target& target) const;
    void readSampler(const Object& sampler, ChannelSource& source) const;

    const Object& document_;
    AnimationSources& sources_;
    Warnings& warnings_;
    std::set<Target> targets_; // of the animation that is being read
};

std::optional<ChannelReader::Target> ChannelReader::pointedTo(const Object& target)
{
    const std::string* pointer = nullptr;
    std::optional<Target> result;
    target.extension(POINTER, [&](const Object& extension) { pointer = extension.string("pointer"); });
    if (!pointer) throw Error("{} lacks the \"pointer\" of {}.", target.path(), POINTER);
    for (const PropertyFacts& facts : PROPERTIES) {
        const auto index = indexIn(*pointer, facts.pointer);
        if (!index) continue;
        if (*index >= countOf(document_, facts.owner))
            throw Error("{} points to \"{}\", but the file has {} of these.", target.path(), shown(*pointer),
                        countOf(document_, facts.owner));
        result = {facts.property, *index};
    }
    if (!result) warnings_.add(fmt::format("Left out an animation of \"{}\", which is not followed.", shown(*pointer)));
    return result;
}

std::optional<ChannelReader::Target> ChannelReader::targetOf(const Object& channel)
{
    std::optional<Target> result;
    channel.object("target", [&](const Object& target) {
        const std::string* path = target.string("path");
        if (!path) throw Error("{} lacks \"path\".", target.path());
        if (*path == "pointer") {
            result = pointedTo(target);
            return;
        }
        const auto node = target.index("node", "nodes");
        constexpr std::array<std::pair<std::string_view, Property>, 4> PATHS = {{{"translation", Property::Translation},
                                                                                 {"rotation", Property::Rotation},
                                                                                 {"scale", Property::Scale},
                                                                                 {"weights", Property::Weights}}};
        const auto* known = std::ranges::find(PATHS, *path, [](const auto& entry) { return entry.first; });
        if (known == PATHS.end())
            warnings_.add(fmt::format("Left out an animation of the unknown path \"{}\".", shown(*path)));
        else if (!node) // 3.11: to be ignored
            warnings_.add("Left out an animation without a node.");
        else
            result = {known->second, *node};
    });
    return result;
}

void ChannelReader::checkTarget(const Object& channel, const Target& target) const
{
    const auto& [property, object] = target;
    const bool transform =
        property == Property::Translation || property == Property::Rotation || property == Property::Scale;
    if (transform && document_.at("nodes", object).has("matrix"))
        throw Error("{} moves nodes[{}], which has a matrix: only translation, rotation and scale can be animated.",
                    channel.path(), object);
    if (property == Property::Weights && !document_.at("nodes", object).has("mesh"))
        throw Error("{} moves the weights of nodes[{}], which has no mesh.", channel.path(), object);
}

void ChannelReader::readSampler(const Object& sampler, ChannelSource& source) const
{
    const PropertyFacts& facts = factsOf(source.channel.property);
    source.sampler = sampler.path();
    source.channel.width = facts.width;
    source.channel.times = sampler.required("input", sampler.index("input", "accessors"));
    source.channel.values = sampler.required("output", sampler.index("output", "accessors"));
    const std::string* mode = sampler.string("interpolation");
    if (mode && *mode != "STEP" && *mode != "LINEAR" && *mode != "CUBICSPLINE")
        throw Error("{} is \"{}\", not STEP, LINEAR or CUBICSPLINE.", sampler.path("interpolation"), shown(*mode));
    source.channel.interpolation = !mode || *mode == "LINEAR" ? Interpolation::Linear
                                   : *mode == "STEP"          ? Interpolation::Step
                                                              : Interpolation::CubicSpline;
    if (facts.property == Property::Visible && source.channel.interpolation != Interpolation::Step)
        throw Error("{} makes a node visible by degrees: its interpolation must be STEP.", sampler.path());

    constexpr uint64_t FLOAT = 5126;
    const auto check = [&](const char* key, uint32_t index, const char* type, bool integers) {
        const Object accessor = document_.at("accessors", index);
        const bool normalized = accessor.boolean("normalized").value_or(false);
        const bool number = accessor.integer("componentType", 0, 0xffff) == FLOAT ||
                            (integers && (normalized || facts.property == Property::Visible));
        if (*accessor.string("type") != type || !number)
            throw Error("{} refers to an accessor of {} {}, but {} needs {} {}.", sampler.path(key),
                        *accessor.string("type"), accessor.json()["componentType"].dump(),
                        key == std::string_view("input") ? "a time" : facts.words, type,
                        integers ? "of floats or normalized integers" : "of floats");
        if (!accessor.has("bufferView"))
            throw Error("{} refers to an accessor without a buffer view.", sampler.path(key));
    };
    check("input", source.channel.times, "SCALAR", false);
    const bool integers = facts.property != Property::Translation && facts.property != Property::Scale;
    check("output", source.channel.values, facts.width == 4 ? "VEC4" : facts.width == 3 ? "VEC3" : "SCALAR", integers);
}

void ChannelReader::readChannel(const Object& animation, const Object& channel, AnimationSource& result)
{
    const auto target = targetOf(channel);
    if (!target) return;
    checkTarget(channel, *target);
    const auto& [property, object] = *target;
    if (!targets_.insert(*target).second)
        throw Error("{} moves the {} of the same object as another channel of this animation.", channel.path(),
                    factsOf(property).words);
    ChannelSource source{.channel = {.property = property, .object = object}};
    const size_t samplers = animation.arraySize("samplers");
    readSampler(animation.at("samplers", channel.required("sampler", channel.index("sampler", samplers, "samplers"))),
                source);
    result.channels.push_back(std::move(source));
    sources_.moved.insert(*target);
    if (property != Property::EmissiveFactor && property != Property::EmissiveStrength) return;
    EmissionSource& emission = sources_.emissions[object];
    const Object material = document_.at("materials", object);
    emission.factor = material.vector<3>("emissiveFactor").value_or(glm::dvec3(0));
    material.extension("KHR_materials_emissive_strength", [&](const Object& extension) {
        emission.strength = extension.number("emissiveStrength").value_or(1);
    });
}

AnimationSource ChannelReader::read(const Object& animation)
{
    AnimationSource result;
    if (const std::string* name = animation.string("name")) result.name = shown(*name);
    targets_.clear();
    try {
        animation.eachObject("channels",
                             [&](const Object& channel, size_t) { readChannel(animation, channel, result); });
    } catch (const Error& error) {
        result.fault = error.what();
        result.channels.clear();
    }
    return result;
}

// Reads and checks each accessor once, however many channels share it.
class KeyReader
{
  public:
    KeyReader(const Document& document, std::vector<std::vector<float>>& numbers)
        : document_(document), numbers_(numbers)
    {
    }

    Channel read(const ChannelSource& source);

  private:
    enum class Meaning { Times, Values, Rotations, RotationSpline };

    uint32_t open(uint32_t accessor, Meaning meaning, const std::string& path);
    static std::string faultOf(const std::vector<float>& numbers, uint32_t width, Meaning meaning);

    const Document& document_;
    std::vector<std::vector<float>>& numbers_;
    std::map<uint32_t, uint32_t> opened_;                        // of numbers_, by accessor
    std::map<std::pair<uint32_t, Meaning>, std::string> faults_; // by accessor
    uint64_t total_ = 0;
};

// What is wrong with an accessor, as the end of a sentence; empty: nothing.
std::string KeyReader::faultOf(const std::vector<float>& numbers, uint32_t width, Meaning meaning)
{
    for (size_t i = 0; i < numbers.size(); ++i) {
        if (!std::isfinite(numbers[i]))
            return fmt::format("has {} at element {}, which is not finite", numbers[i], i / width);
        if (meaning == Meaning::Times && i > 0 && !(numbers[i] > numbers[i - 1]))
            return fmt::format(
                "has the time {} s at key {} after {} s, but times must increase: remove one of the keys", numbers[i],
                i, numbers[i - 1]);
    }
    const size_t perKey = meaning == Meaning::RotationSpline ? 3 : 1;
    for (size_t key = 0; meaning >= Meaning::Rotations && key < numbers.size() / (4 * perKey); ++key) {
        const std::span rotation = std::span(numbers).subspan(4 * (key * perKey + perKey / 3), 4);
        if (std::ranges::all_of(rotation, [](float x) { return x == 0; }))
            return fmt::format("has a rotation of length 0 at key {}: a rotation is a quaternion of length 1", key);
    }
    return "";
}

// The index of its numbers.
uint32_t KeyReader::open(uint32_t index, Meaning meaning, const std::string& path)
{
    const tinygltf::Accessor& facts = document_.model.accessors[index];
    const auto width = static_cast<uint32_t>(tinygltf::GetNumComponentsInType(static_cast<uint32_t>(facts.type)));
    if (!opened_.contains(index)) {
        const Accessor accessor(document_, static_cast<int>(index));
        std::vector<float> numbers;
        total_ += uint64_t{accessor.count()} * width;
        if (total_ <= MAX_NUMBERS) {
            numbers.reserve(accessor.count() * width);
            for (size_t i = 0; i < accessor.count(); ++i) {
                for (uint32_t c = 0; c < width; ++c) numbers.push_back(static_cast<float>(accessor.number(i, c)));
            }
        }
        opened_.emplace(index, static_cast<uint32_t>(numbers_.size()));
        numbers_.push_back(std::move(numbers));
    }
    const uint32_t opened = opened_.at(index);
    const auto [fault, unknown] = faults_.try_emplace({index, meaning});
    if (unknown)
        fault->second = numbers_[opened].empty()
                            ? fmt::format("brings the keys of all animations to more than {} numbers: use fewer, or "
                                          "leave animations out",
                                          MAX_NUMBERS)
                            : faultOf(numbers_[opened], width, meaning);
    if (!fault->second.empty()) throw Error("{} {}.", path, fault->second);
    return opened;
}

Channel KeyReader::read(const ChannelSource& source)
{
    Channel channel = source.channel;
    if (channel.property == Property::Weights) {
        const tinygltf::Node& node = document_.model.nodes[channel.object];
        const auto& primitives = document_.model.meshes[static_cast<size_t>(node.mesh)].primitives;
        for (const tinygltf::Primitive& primitive : primitives)
            channel.width = std::max(channel.width, static_cast<uint32_t>(primitive.targets.size()));
        if (channel.width == 0)
            throw Error("{} moves the weights of nodes[{}], whose meshes[{}] has no morph targets.", source.sampler,
                        channel.object, node.mesh);
    }
    const size_t keys = document_.model.accessors[channel.times].count;
    const size_t outputs = document_.model.accessors[channel.values].count;
    const size_t perKey = size_t{channel.interpolation == Interpolation::CubicSpline ? 3u : 1u} *
                          (channel.property == Property::Weights ? channel.width : 1);
    if (outputs != keys * perKey)
        throw Error("{} has {} outputs for {} keys, but needs {} for each.", source.sampler, outputs, keys, perKey);
    const bool cubic = channel.interpolation == Interpolation::CubicSpline;
    const Meaning meaning = channel.property != Property::Rotation ? Meaning::Values
                            : cubic                                ? Meaning::RotationSpline
                                                                   : Meaning::Rotations;
    channel.times = open(channel.times, Meaning::Times, source.sampler + ".input");
    channel.values = open(channel.values, meaning, source.sampler + ".output");
    return channel;
}

} // namespace

AnimationSources listAnimations(const Object& document, Warnings& warnings)
{
    AnimationSources sources;
    ChannelReader reader(document, sources, warnings);
    document.eachObject("animations",
                        [&](const Object& animation, size_t) { sources.animations.push_back(reader.read(animation)); });
    return sources;
}

std::vector<Animation> readAnimations(const Document& document, std::vector<std::vector<float>>& numbers,
                                      Warnings& warnings)
{
    KeyReader reader(document, numbers);
    std::vector<Animation> animations;
    for (const AnimationSource& source : document.animations.animations) {
        Animation& animation = animations.emplace_back();
        animation.name = source.name;
        animation.fault = source.fault;
        try {
            for (const ChannelSource& channel : source.channels) animation.channels.push_back(reader.read(channel));
        } catch (const Error& error) {
            animation.fault = error.what();
            animation.channels.clear();
        }
        for (const Channel& channel : animation.channels)
            animation.seconds = std::max(animation.seconds, double(numbers[channel.times].back()));
        if (!animation.fault.empty()) warnings.add(fmt::format("An animation cannot be played: {}", animation.fault));
    }
    return animations;
}

} // namespace scene::gltf
