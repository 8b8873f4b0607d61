#include "passes/settings.h"

#include "engine/base/error.h"
#include "engine/base/fingerprint.h"
#include "engine/base/json.h"
#include "engine/base/shown.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <concepts>
#include <optional>
#include <type_traits>

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace passes
{

namespace
{

using Json = nlohmann::ordered_json;

template <class T>
concept Choice = std::is_enum_v<T> || std::same_as<T, bool>;
template <class T>
concept Number = std::is_arithmetic_v<T> && !std::same_as<T, bool>;

// ---- value to text ----
template <Choice T>
std::string textOf(const T& value)
{
    return WORDS_OF<T>[static_cast<size_t>(value)];
}
template <Number T>
std::string textOf(const T& value)
{
    return fmt::format("{}", value); // shortest text that reads back as the same number
}
std::string textOf(const std::string& value)
{
    return value;
}
template <class T>
std::string textOf(const SizeField<T>& size)
{
    return fmt::format("{}x{}", size.width, size.height);
}

// ---- what may be given ----
std::string unitOf(const Knob& knob)
{
    return *knob.unit ? fmt::format(" {}", knob.unit) : std::string();
}

template <Choice T>
std::string valuesOf(const Knob&, const T&)
{
    return fmt::format("{}", fmt::join(WORDS_OF<T>, "|"));
}
template <Number T>
std::string valuesOf(const Knob& knob, const T&)
{
    if constexpr (std::same_as<T, uint64_t>) return "whole number below 2^64";
    const char* kind = std::is_integral_v<T> ? "whole number, " : "";
    return fmt::format("{}{} to {}{}", kind, knob.low, knob.high, unitOf(knob));
}
std::string valuesOf(const Knob&, const std::string&)
{
    return "text";
}
template <class T>
std::string valuesOf(const Knob& knob, const SizeField<T>&)
{
    return fmt::format("WxH, each {} to {}{}", knob.low, knob.high, unitOf(knob));
}

template <class T>
Error wrong(const Knob& knob, const T& field, std::string_view given)
{
    return Error("Setting \"{}\" cannot be {}; it takes: {}.", knob.name, given, valuesOf(knob, field));
}

// ---- text to value; empty when the text is not exactly one value of the type ----
template <Number T>
std::optional<T> parsed(std::string_view text)
{
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return value;
}

template <Number T>
bool inRange(const Knob& knob, T value)
{
    if constexpr (std::is_floating_point_v<T>) {
        return std::isfinite(value) && value >= static_cast<T>(knob.low) && value <= static_cast<T>(knob.high);
    } else {
        return static_cast<double>(value) >= knob.low && static_cast<double>(value) <= knob.high;
    }
}

template <Choice T>
void fromText(const Knob& knob, T& field, std::string_view text)
{
    const auto found = std::ranges::find(WORDS_OF<T>, text);
    if (found == WORDS_OF<T>.end()) throw wrong(knob, field, fmt::format("\"{}\"", text));
    field = static_cast<T>(found - WORDS_OF<T>.begin());
}
template <Number T>
void fromText(const Knob& knob, T& field, std::string_view text)
{
    const std::optional<T> value = parsed<T>(text);
    if (!value || !inRange(knob, *value)) throw wrong(knob, field, fmt::format("\"{}\"", text));
    field = *value;
}
void fromText(const Knob& knob, std::string& field, std::string_view text)
{
    if (text.find('\0') != std::string_view::npos) throw wrong(knob, field, "a text with a zero byte");
    field = text;
}
void fromText(const Knob& knob, SizeField<uint32_t>&& size, std::string_view text)
{
    const size_t cross = text.find('x');
    if (cross == std::string_view::npos) throw wrong(knob, size, fmt::format("\"{}\"", text));
    const std::optional<uint32_t> width = parsed<uint32_t>(text.substr(0, cross));
    const std::optional<uint32_t> height = parsed<uint32_t>(text.substr(cross + 1));
    if (!width || !height || !inRange(knob, *width) || !inRange(knob, *height))
        throw wrong(knob, size, fmt::format("\"{}\"", text));
    if (uint64_t{*width} * *height > MAX_PIXELS)
        throw Error("Setting \"size\" cannot be \"{}\": that is {} pixels, and {} is the most.", text,
                    uint64_t{*width} * *height, MAX_PIXELS);
    size.width = *width;
    size.height = *height;
}

// ---- value to JSON and back ----
template <class T>
Json jsonOf(const T& value)
{
    if constexpr (std::same_as<T, float>) {
        return *parsed<double>(textOf(value)); // 0.1, not 0.10000000149: reads back as the same float
    } else if constexpr (std::is_arithmetic_v<T>) {
        return value;
    } else {
        return textOf(value);
    }
}

template <class T>
void fromJson(const Knob& knob, T&& field, const Json& json)
{
    using Value = std::remove_cvref_t<T>;
    const std::string given = shown(jsonText(json));
    if constexpr (std::same_as<Value, bool>) {
        if (!json.is_boolean()) throw Error("Setting \"{}\" cannot be {}; it takes true or false.", knob.name, given);
        field = json.get<bool>();
    } else if constexpr (std::is_integral_v<Value>) {
        // Negative integers are no unsigned ones; 5.0 is a float to JSON.
        if (!json.is_number_unsigned() || json.get<uint64_t>() > std::numeric_limits<Value>::max() ||
            !inRange(knob, json.get<Value>()))
            throw wrong(knob, field, given);
        field = json.get<Value>();
    } else if constexpr (std::is_floating_point_v<Value>) {
        if (!json.is_number() || !inRange(knob, json.get<Value>())) throw wrong(knob, field, given);
        field = json.get<Value>();
    } else {
        if (!json.is_string()) throw wrong(knob, field, given);
        fromText(knob, std::forward<T>(field), json.get_ref<const std::string&>());
    }
}

Error unknown(std::string_view name)
{
    std::vector<const char*> names;
    visitSettings(static_cast<const Settings&>(Settings{}),
                  [&](const Knob& knob, auto&&) { names.push_back(knob.name); });
    return Error("There is no setting \"{}\"; there are: {}.", name, fmt::join(names, ", "));
}

} // namespace

std::vector<KnobText> describeSettings(const Settings& initial)
{
    std::vector<KnobText> texts;
    visitSettings(initial, [&](const Knob& knob, auto&& field) {
        texts.push_back({knob.name, valuesOf(knob, field), textOf(field), knob.doc});
    });
    return texts;
}

void set(Settings& settings, std::string_view name, std::string_view text)
{
    bool found = false;
    visitSettings(settings, [&]<class T>(const Knob& knob, T&& field) {
        if (name != knob.name) return;
        found = true;
        fromText(knob, std::forward<T>(field), text);
    });
    if (!found) throw unknown(name);
}

std::vector<std::pair<std::string, std::string>> toText(const Settings& settings,
                                                        const std::function<bool(const Knob&)>& wanted)
{
    std::vector<std::pair<std::string, std::string>> texts;
    visitSettings(settings, [&](const Knob& knob, auto&& field) {
        if (wanted(knob)) texts.emplace_back(knob.name, textOf(field));
    });
    return texts;
}

std::vector<Difference> differences(const Settings& a, const Settings& b)
{
    std::vector<Difference> list;
    visitSettings(a, [&](const Knob& knob, auto&& field) { list.push_back({knob, textOf(field), {}}); });
    size_t i = 0;
    visitSettings(b, [&](const Knob&, auto&& field) { list[i++].b = textOf(field); });
    std::erase_if(list, [](const Difference& one) { return one.a == one.b; });
    return list;
}

Change changeBetween(const Settings& a, const Settings& b)
{
    Change most = Change::Nothing;
    for (const Difference& one : differences(a, b)) most = std::max(most, one.knob.change);
    return most;
}

void copy(Settings& to, const Settings& from, std::initializer_list<Role> roles)
{
    for (const Difference& one : differences(to, from))
        if (std::ranges::find(roles, one.knob.role) != roles.end()) set(to, one.knob.name, one.b);
}

nlohmann::ordered_json toJson(const Settings& settings)
{
    Json json = Json::object();
    visitSettings(settings, [&](const Knob& knob, auto&& field) { json[knob.name] = jsonOf(field); });
    return json;
}

void apply(Settings& settings, const nlohmann::ordered_json& preset)
{
    if (!preset.is_object()) throw Error("A preset is an object {{\"name\": value, ...}}, not {}.", preset.type_name());
    for (const auto& item : preset.items()) { // clang 14 captures no structured bindings
        bool found = false;
        visitSettings(settings, [&]<class T>(const Knob& knob, T&& field) {
            if (item.key() != knob.name) return;
            found = true;
            fromJson(knob, std::forward<T>(field), item.value());
        });
        if (!found) throw unknown(item.key());
    }
}

std::string hash(const Settings& settings)
{
    uint64_t state = 0;
    for (const auto& [name, value] : toText(settings))
        state = fingerprint(std::string_view(value), fingerprint(std::string_view(name), state));
    return fmt::format("{:016x}", state);
}

} // namespace passes
