#include "passes/variant.h"

#include "passes/estimator.h"

#include <type_traits>

namespace passes
{

namespace
{

template <class T>
std::string text(T value)
{
    if constexpr (std::is_same_v<T, bool>)
        return value ? "on" : "off";
    else
        return std::to_string(value);
}

} // namespace

static_assert(uint32_t(Shift::Replay) == shared::SHIFT_REPLAY &&
              uint32_t(Shift::Reconnection) == shared::SHIFT_RECONNECTION &&
              uint32_t(Shift::Hybrid) == shared::SHIFT_HYBRID);

static_assert(uint32_t(Color::Chosen) == shared::COLOR_CHOSEN && uint32_t(Color::Weighted) == shared::COLOR_WEIGHTED &&
              uint32_t(Color::Variate) == shared::COLOR_VARIATE);

static_assert(uint32_t(Mutate::Off) == shared::MUTATION_OFF && uint32_t(Mutate::Free) == shared::MUTATION_FREE);

Variant makeVariant(const scene::SceneFeatures& features, const Settings& settings, bool orthographic,
                    const scene::TraversalStack& stack, bool moves)
{
    Variant v;
    v.MAX_BOUNCES = settings.maxBounces;
    v.BOX_FILTER = settings.pixelFilter == PixelFilter::Box;
    v.ORTHOGRAPHIC = orthographic;
    v.TWO_WORLDS = moves;
    v.STACK_SIZE = stack.entries;
    v.STACK_IN_REGISTERS = stack.inRegisters;
    if (settings.method != Method::Pt) {
        v.RESERVOIR_COUNT = uint32_t(estimatorOf(settings.method).target.size());
        v.SHIFT_MAP = uint32_t(settings.shift);
        v.COLOR_READING = uint32_t(colorReading(settings));
        v.MUTATION = uint32_t(settings.mutate);
        v.ONE_CHANNEL = oneHot(estimatorOf(settings.method));
    }
#define COPY_FEATURE(ID, TYPE, NAME, DEFAULT, WHAT) v.NAME = features.NAME;
    SCENE_FEATURES(COPY_FEATURE)
#undef COPY_FEATURE
    return v;
}

Variant withAllFeatures(Variant variant)
{
#define ADD_FEATURE(ID, TYPE, NAME, DEFAULT, WHAT) variant.NAME = true;
    SCENE_FEATURES(ADD_FEATURE)
#undef ADD_FEATURE
    return variant;
}

std::vector<gpu::Constant> constants(const Variant& variant)
{
    std::vector<gpu::Constant> list;
#define ADD_CONSTANT(ID, TYPE, NAME, DEFAULT, WHAT) list.push_back({#NAME, uint32_t(variant.NAME)});
    VARIANT_CONSTANTS(ADD_CONSTANT)
#undef ADD_CONSTANT
    return list;
}

std::map<std::string, std::string> describe(const Variant& variant)
{
    std::map<std::string, std::string> words;
#define ADD_WORDS(ID, TYPE, NAME, DEFAULT, WHAT) words[#NAME] = text(variant.NAME);
    VARIANT_CONSTANTS(ADD_WORDS)
#undef ADD_WORDS
    return words;
}

std::map<std::string, std::string> variantMeanings()
{
    std::map<std::string, std::string> words;
#define ADD_MEANING(ID, TYPE, NAME, DEFAULT, WHAT) words[#NAME] = WHAT;
    VARIANT_CONSTANTS(ADD_MEANING)
#undef ADD_MEANING
    return words;
}

} // namespace passes
