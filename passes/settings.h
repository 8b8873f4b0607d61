#pragma once
// Every knob of the renderer, once. Command line, JSON presets, the panel, image metadata and the settings hash all
// visit the same list, and what a setting decides and what changing it takes stand there too. Adding a setting: one
// field, one line in visitSettings.

#include <array>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace passes
{

enum class Method : uint32_t { Pt, RestirPt, RgbRestir, GroupedRestir };
enum class Shift : uint32_t { Replay, Reconnection, Hybrid };
enum class Color : uint32_t { Chosen, Weighted, Variate };
enum class Mutate : uint32_t { Off, Free };
enum class PixelFilter : uint32_t { Center, Box };

// Their words, and those of what is on or off, on the command line and in presets: WORDS_OF<Shift>[size_t(shift)].
template <class Choice>
inline constexpr auto WORDS_OF = nullptr;
template <>
inline constexpr auto WORDS_OF<bool> = std::array{"off", "on"};
template <>
inline constexpr auto WORDS_OF<Method> = std::array{"pt", "restir-pt", "rgb-restir", "grouped-restir"};
template <>
inline constexpr auto WORDS_OF<Shift> = std::array{"replay", "reconnection", "hybrid"};
template <>
inline constexpr auto WORDS_OF<Color> = std::array{"chosen", "weighted", "variate"};
template <>
inline constexpr auto WORDS_OF<Mutate> = std::array{"off", "free"};
template <>
inline constexpr auto WORDS_OF<PixelFilter> = std::array{"center", "box"};

// And on the window's buttons.
template <class Choice>
inline constexpr auto LABELS_OF = WORDS_OF<Choice>;
template <>
inline constexpr auto LABELS_OF<Method> = std::array{"off (pt)", "luminance", "RGB", "grouped"};
static_assert(LABELS_OF<Method>.size() == WORDS_OF<Method>.size());

struct Settings {
    Method method = Method::Pt;
    Shift shift = Shift::Hybrid;
    uint32_t maxConfidence = 20; // M_c
    bool temporal = true;
    uint32_t spatial = 3;    // K
    float spatialRadius = 0; // pixels; 0: by the picture's height
    Color color = Color::Weighted;
    uint32_t colorConfidence = 1048576; // the most that history counts in variate's own estimate
    Mutate mutate = Mutate::Off;
    uint32_t maxBounces = 5; // scattering events
    PixelFilter pixelFilter = PixelFilter::Center;
    uint32_t width = 640;
    uint32_t height = 360;
    std::string camera; // name or index; empty: the first
    uint64_t seed = 0;
    uint32_t frames = 64;
    double seconds = 0; // above 0: stop by time instead of by frames
    bool average = true;
    std::string environment;    // file; empty: the scene's own
    float environmentScale = 1; // multiplies the environment's radiance

    bool operator==(const Settings&) const = default;
};

// Does a frame depend on those before it?
constexpr bool reusesFrames(const Settings& settings)
{
    return settings.method != Method::Pt && settings.temporal;
}

// What a knob decides. Scene, View and Picture together say which picture is right; the others how one gets there.
enum class Role : uint8_t {
    Scene,     // what there is
    View,      // from where it is seen, in how many pixels
    Picture,   // which of its light a pixel shows
    Estimator, // how that is estimated: the mean is the same
    Sampling,  // with which random numbers
    Stopping,  // when a command ends
    Output     // which of the finished pictures is written
};

// What a renderer does when a knob changes, each more than the one before.
enum class Change : uint8_t {
    Nothing,
    Tune,    // from the next frame on; history and film stay
    Reset,   // starts over
    Compile, // stages and buffers anew; starts over
    Reload   // the scene anew, by whoever has loaded it
};

// What is to be known about a knob. The range is closed; choices, texts and sizes ignore it.
struct Knob {
    const char* name; // of the option, the preset's key, the metadata
    Role role;        // neither has a default: a knob without them does not compile
    Change change;
    double low = 0;
    double high = 0;
    const char* unit; // "" when a number has none
    const char* doc;  // what it does; cost; whether it biases the image
};

// The size is one knob over two fields.
template <class Integer>
struct SizeField {
    Integer& width;
    Integer& height;
};
template <class Integer>
SizeField(Integer&, Integer&) -> SizeField<Integer>;

constexpr uint32_t MAX_SIZE = 32768;      // pixels, each side
constexpr uint64_t MAX_PIXELS = 1u << 28; // as image::read

// Calls visit(Knob, field&) for every setting, in the order in which people see them. `s` is Settings or const
// Settings.
template <class AnySettings, class Visitor>
void visitSettings(AnySettings& s, Visitor&& visit)
{
    // clang-format off
    visit(Knob{"method", Role::Estimator, Change::Compile, 0, 0, "", "How light is computed. pt: plain path tracing; restir-pt: ReSTIR PT, one reservoir, luminance target; rgb-restir: one reservoir per channel; grouped-restir: one for red and green, one for blue. All unbiased."}, s.method);
    visit(Knob{"shift", Role::Estimator, Change::Compile, 0, 0, "", "ReSTIR's shift map: how a path moves to another pixel. Unbiased; replay costs the most rays."}, s.shift);
    visit(Knob{"max-confidence", Role::Estimator, Change::Tune, 1, 1048576, "frames", "M_c of ReSTIR: the most that history may count against a new frame. Larger: less noise, more correlation between frames. Unbiased, free."}, s.maxConfidence);
    visit(Knob{"temporal", Role::Estimator, Change::Tune, 0, 0, "", "ReSTIR's reuse of the previous frame. Unbiased; costs one or two shifts per pixel and reservoir."}, s.temporal);
    visit(Knob{"spatial", Role::Estimator, Change::Compile, 0, 8, "neighbors", "ReSTIR's spatial reuse; 0 turns it off. Unbiased; cost grows with each neighbor."}, s.spatial);
    visit(Knob{"spatial-radius", Role::Estimator, Change::Tune, 0, 1000, "pixels", "How far away ReSTIR's spatial neighbors may be; 0: an 18th of the picture's height, at least 2. Too far, and neighbors see other light: noisier. Unbiased, free."}, s.spatialRadius);
    visit(Knob{"color", Role::Estimator, Change::Compile, 0, 0, "", "How ReSTIR's color is read off the reservoirs. chosen: the color of the samples that were chosen, as in the paper; weighted: that of all samples merged last, by their weights: less color noise in this frame, the same reservoirs; variate: an estimate of each pixel's color is kept beside the reservoirs, reused as they are, and corrected by their samples where pixels see different light: color noise falls with history as rgb-restir's does, at luminance's price; values may fall below 0. For rgb-restir, whose samples have one color, all are one picture. Unbiased; weighted costs 16 bytes a pixel, variate 32."}, s.color);
    visit(Knob{"color-confidence", Role::Estimator, Change::Tune, 1, 1048576, "frames", "Of --color variate: the most that history may count against a new frame in its own estimate, beyond what M_c allows. Smaller: it follows light that changes, and is noisier where it does not. Unbiased, free."}, s.colorConfidence);
    visit(Knob{"mutate", Role::Estimator, Change::Compile, 0, 0, "", "What is done to the samples that ReSTIR's history holds, which else stay for as long as nothing better comes. off: nothing, as in the paper; free: a Metropolis-Hastings step: a new path takes a sample's place with the probability that leaves the mean as it is. Successive frames are less alike, and their mean goes on converging; with neighbors and a large M_c single frames are less noisy, too. Unbiased; a resting camera pays no ray, a moving one up to a walk per pixel; 32 bytes a pixel and 16 a neighbor, none for replay."}, s.mutate);
    visit(Knob{"max-bounces", Role::Picture, Change::Compile, 0, 256, "scattering events", "Longest path: 0 shows emitters only, 1 adds direct light, and so on. Leaves out all light that scatters more often (biased by that); cost grows with it."}, s.maxBounces);
    visit(Knob{"pixel-filter", Role::Picture, Change::Compile, 0, 0, "", "center: rays through the pixel's center, as in the paper, edges stay jagged; box: uniform over the pixel. Each is unbiased for its own picture; free."}, s.pixelFilter);
    visit(Knob{"size", Role::View, Change::Compile, 1, MAX_SIZE, "pixels", "Width x height of the picture. Cost grows with their product. Unbiased."}, SizeField{s.width, s.height});
    visit(Knob{"camera", Role::View, Change::Compile, 0, 0, "", "Name or index of one of the scene's cameras; empty: the first."}, s.camera);
    visit(Knob{"seed", Role::Sampling, Change::Reset, 0, 18446744073709551615.0, "", "Of all random numbers: equal settings, seed and device give equal pixels. Unbiased, free."}, s.seed);
    visit(Knob{"frames", Role::Stopping, Change::Nothing, 1, 1073741824, "frames", "How many frames to render, each one sample per pixel. Cost grows with it. Unbiased."}, s.frames);
    visit(Knob{"seconds", Role::Stopping, Change::Nothing, 0, 1e7, "s", "Stop after this time of rendering instead of after a number of frames; 0: by frames. Unbiased."}, s.seconds);
    visit(Knob{"average", Role::Output, Change::Nothing, 0, 0, "", "on: write the mean of all frames; off: write the last frame. Both unbiased; free."}, s.average);
    visit(Knob{"environment", Role::Scene, Change::Reload, 0, 0, "", "Equirectangular picture (.exr or .hdr) that surrounds the scene: its middle lies towards +x, to the right of that +z, its left and right edges towards -x, its top row above (+y); a camera that is not turned looks along -z, a quarter from the left. Empty: the scene's own."}, s.environment);
    visit(Knob{"environment-scale", Role::Scene, Change::Reload, 0, 1e6, "", "Multiplies the radiance of the environment. Changes the scene, not the estimate; free."}, s.environmentScale);
    // clang-format on
}

// One knob as text, for --help and messages.
struct KnobText {
    std::string name;
    std::string values;  // "pt|restir-pt|rgb-restir", "1 to 1048576 frames", "on|off", "WxH, ...", "text"
    std::string initial; // the default
    std::string doc;
};
std::vector<KnobText> describeSettings(const Settings& initial = {});

// Sets one knob from text as on the command line. Throws Error: unknown name, wrong type, out of range.
void set(Settings& settings, std::string_view name, std::string_view text);

// Name and value of every knob that is wanted, in order; set() reads each value back exactly.
std::vector<std::pair<std::string, std::string>> toText(
    const Settings& settings, const std::function<bool(const Knob&)>& wanted = [](const Knob&) { return true; });

// The knobs in which two settings differ, and their values as text.
struct Difference {
    Knob knob;
    std::string a, b;
};
std::vector<Difference> differences(const Settings& a, const Settings& b);

// All that a renderer must do to get from one to the other.
Change changeBetween(const Settings& a, const Settings& b);

// Sets the knobs of these roles as they are in `from`.
void copy(Settings& to, const Settings& from, std::initializer_list<Role> roles);

// An object with the knobs' names: numbers, true or false, texts. apply() takes any subset of them and throws Error
// naming the key: unknown, wrong type, out of range.
nlohmann::ordered_json toJson(const Settings& settings);
void apply(Settings& settings, const nlohmann::ordered_json& preset);

// 16 hexadecimal digits; equal exactly when (up to collision) all settings are.
std::string hash(const Settings& settings);

} // namespace passes
