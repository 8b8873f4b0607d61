#include "ui/cli/checkpoint_options.h"

#include "engine/base/error.h"
#include "engine/base/files.h"
#include "engine/base/fingerprint.h"
#include "ui/cli/number_range.h"

#include <cstdio>

namespace ui
{

namespace
{

// When a render ends, and what is written then, does not change its frames.
bool decidesFrames(const passes::Knob& knob)
{
    return knob.role != passes::Role::Stopping && knob.role != passes::Role::Output;
}

std::string hexadecimal(uint64_t value)
{
    return fmt::format("{:016x}", value);
}

passes::Identity identityOf(const passes::Renderer& renderer, const RunReport& report)
{
    passes::Identity identity = {{"version", version()},
                                 {"device", report.adapter.name},
                                 {"driver", report.adapter.driver},
                                 {"device-tuning", gpu::toText(report.adapter.tuning)},
                                 {"scene's contents", hexadecimal(renderer.scene().fingerprint())}};
    for (auto& text : passes::toText(report.settings, decidesFrames)) identity.push_back(std::move(text));
    for (const auto& [name, value] : report.extra) {
        if (name == "camera-path") // wherever it lies
            identity.emplace_back("camera path's contents", hexadecimal(fingerprint(files::read(value))));
        else
            identity.emplace_back(name, value);
    }
    return identity;
}

} // namespace

void CheckpointOptions::addTo(CLI::App& app)
{
    app.add_option("--checkpoint", checkpoint_,
                   "Keeps the unfinished render here: every now and then, on Ctrl-C or SIGTERM and at the end, whole "
                   "or not at all.")
        ->option_text("FILE")
        ->group("Long renders");
    app.add_option("--checkpoint-interval", interval_,
                   "Time between two checkpoints: the most that is lost when the program is killed.")
        ->option_text("0 to 86400 s (300)")
        ->check(within(0.0, 86400.0))
        ->group("Long renders");
    app.add_option(
           "--resume", resume_,
           "Goes on from a checkpoint, to the same bits as without a break. Scene, device, version and settings "
           "must be the same, but for --frames, --seconds and --average: so a finished render can get more.")
        ->option_text("FILE")
        ->group("Long renders");
}

void CheckpointOptions::requireWritable() const
{
    if (!checkpoint_.empty()) ui::requireWritable(checkpoint_);
}

// A render may go on in the file that it goes on from.
void CheckpointOptions::name(NamedFiles& files) const
{
    files.writes("--checkpoint", checkpoint_);
    if (checkpoint_.empty() || !files::areSame(resume_, checkpoint_)) files.reads("--resume", resume_);
}

double CheckpointOptions::start(passes::Renderer& renderer, const RunReport& report,
                                const std::function<void(uint64_t frame)>& bring)
{
    identity_ = identityOf(renderer, report);
    kept_ = Clock::now();
    if (resume_.empty()) return 0;
    const passes::Checkpoint checkpoint = passes::readCheckpoint(resume_);
    passes::requireSame(checkpoint, identity_, resume_);
    const uint64_t frames = checkpoint.state.frames;
    if (report.settings.seconds == 0 && frames > report.settings.frames)
        throw Error("Cannot resume from \"{}\": it has {} frames already, more than the {} of --frames.", resume_,
                    frames, report.settings.frames);
    renderer.restore(checkpoint.state);
    if (frames > 0) bring(frames - 1); // what its history is of
    return checkpoint.seconds;
}

void CheckpointOptions::keep(passes::Renderer& renderer, double seconds)
{
    if (checkpoint_.empty() || secondsSince(kept_) < interval_) return;
    kept_ = Clock::now();
    write(renderer, seconds, "Rendering goes on.");
}

bool CheckpointOptions::finish(passes::Renderer& renderer, double seconds) const
{
    return checkpoint_.empty() || write(renderer, seconds, "There is no checkpoint of the last frames.");
}

bool CheckpointOptions::write(passes::Renderer& renderer, double seconds, const char* consequence) const
{
    const passes::RendererState state = renderer.save();
    try {
        passes::write(checkpoint_, {.identity = identity_, .seconds = seconds, .state = state});
        return true;
    } catch (const Error& error) {
        std::fprintf(stderr, "Warning: %s %s\n", error.what(), consequence);
        return false;
    }
}

} // namespace ui
