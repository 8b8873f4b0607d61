#include "ui/cli/sequence_output.h"

#include "engine/base/error.h"
#include "engine/base/shown.h"
#include "ui/cli/number_range.h"
#include "ui/cli/usage_error.h"

#include <charconv>
#include <limits>
#include <optional>
#include <regex>

#include <fmt/format.h>

namespace ui
{

namespace
{

constexpr int64_t MOST = 1'000'000;          // of frames, and of their numbers
constexpr uint64_t MOST_RENDERED = 1u << 30; // as --frames

// %d, or %04d: at least four digits.
const std::regex NUMBER("%(0([1-9]))?d");

std::optional<int64_t> numberIn(std::string_view text)
{
    int64_t number = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (problem != std::errc() || end != text.data() + text.size() || number < 0 || number > MOST) return {};
    return number;
}

} // namespace

void SequenceOutput::addTo(CLI::App& app)
{
    CLI::Option* sequence = app.add_option("--sequence", range_,
                                           "Writes every frame from FIRST up to, not including, END as a file, as soon "
                                           "as it is finished; --output has %d, or "
                                           "%04d for four digits and more, where its number goes. With --fps the scene "
                                           "plays, with --orbit or --camera-path the "
                                           "camera moves.");
    sequence->option_text("FIRST:END")->group("Animation");
    app.add_option("--warm-up", warmUp_,
                   "Frames that are rendered before the first of --sequence, and not written, so that it has history; "
                   "with --restart, before each first one. Methods without history leave them out.")
        ->option_text("0 to 10000 (0)")
        ->check(within(0u, 10000u))
        ->needs(sequence)
        ->group("Animation");
    app.add_option("--restart", restart_,
                   "Forgets all history after every so many frames. So they fall into chains that know nothing of each "
                   "other, which the processes of trichrome-mpi share; the result is the same however many there are. "
                   "Unbiased; costs noise after each restart, or --warm-up frames. 0: never.")
        ->option_text("0 to 1000000 frames (0)")
        ->check(within(0u, uint32_t(MOST)))
        ->group("Animation");
}

void SequenceOutput::adjust(passes::Settings& settings, const SettingsOptions& options, const std::string& pattern)
{
    if (given())
        readRange(settings, options, pattern);
    else
        chains_.end = settings.seconds > 0 ? std::numeric_limits<int64_t>::max() : int64_t(settings.frames);
    const bool reuses = passes::reusesFrames(settings);
    chains_.length = !reuses ? 1 : restart_ > 0 ? int64_t(restart_) : chains_.end - chains_.first;
    chains_.warmUp = reuses ? warmUp_ : 0;
    if (!given()) return;
    if (chains_.places() > MOST_RENDERED)
        throw UsageError("--warm-up {} before every {} frames of --sequence makes {} frames, more than {}.", warmUp_,
                         chains_.length, chains_.places(), MOST_RENDERED);
    settings.frames = uint32_t(chains_.places());
}

void SequenceOutput::readRange(passes::Settings& settings, const SettingsOptions& options, const std::string& pattern)
{
    const size_t colon = range_.find(':');
    const auto first = numberIn(std::string_view(range_).substr(0, colon));
    const auto end = colon == std::string::npos ? std::nullopt : numberIn(std::string_view(range_).substr(colon + 1));
    if (!first || !end || *first >= *end)
        throw UsageError(
            "--sequence \"{}\" is no range of frames: write FIRST:END, two numbers from 0 to {}, the second one "
            "larger, as in 0:120.",
            shown(range_), MOST);
    std::smatch number;
    if (!std::regex_search(pattern, number, NUMBER) || std::regex_search(number.suffix().first, pattern.end(), NUMBER))
        throw UsageError(
            "--sequence writes a file a frame, and --output \"{}\" must say once where its number goes, as in "
            "frames/%04d.png.",
            shown(pattern));
    for (const char* name : {"frames", "seconds"})
        if (options.given(name))
            throw UsageError("--{} cannot be combined with --sequence, which says how many frames there are.", name);
    if (options.given("average") && settings.average)
        throw UsageError("--average on cannot be combined with --sequence: each file is one frame.");
    chains_.first = *first;
    chains_.end = *end;
    pattern_ = pattern;
    settings.seconds = 0;
    settings.average = false;
}

std::filesystem::path SequenceOutput::fileOf(uint64_t place) const
{
    const FrameChains::Frame frame = chains_.at(place);
    if (!given() || !frame.wanted) return {};
    std::smatch number;
    std::regex_search(pattern_, number, NUMBER);
    const int width = number[2].matched ? std::stoi(number[2]) : 1;
    return number.prefix().str() + fmt::format("{:0{}}", frame.number, width) + number.suffix().str();
}

std::vector<std::pair<std::string, std::string>> SequenceOutput::toText() const
{
    std::vector<std::pair<std::string, std::string>> text;
    if (given()) text.emplace_back("first-frame", std::to_string(chains_.at(0).number));
    if (restart_ > 0) text.emplace_back("restart", std::to_string(restart_));
    if (restart_ > 0 && given()) text.emplace_back("warm-up", std::to_string(warmUp_));
    return text;
}

} // namespace ui
