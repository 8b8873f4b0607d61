#pragma once
// What errors are measured against: a picture from a file, or one path traced to a stated precision and kept in a
// cache.

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>

#include "engine/image/mean_picture.h"
#include "passes/renderer.h"
#include "passes/sequence.h"

namespace passes
{

struct Reference {
    image::Image picture;
    image::OwnError error;   // its own; 0 where it is not known (a file)
    uint64_t pathTraced = 0; // frames; 0: from a file
    bool precise = true;     // as precise as asked for
    bool fromCache = false;
};

// How good a path traced reference has to be.
struct Precision {
    double error = 0.02;        // square root of its own relative MSE
    uint64_t maxFrames = 16384; // and what it may cost at most
};

// Of the path tracer that makes the reference of these settings: with other random numbers than any seed near theirs.
Settings referenceSettings(const Settings& settings);

// Path traces a reference, a frame a step: in batches of equal length, with seeds that count down, since the spread of
// the batches says how precise their mean is.
class ReferenceTracer
{
  public:
    explicit ReferenceTracer(std::unique_ptr<Renderer> renderer); // of referenceSettings()
    Renderer& renderer() { return *renderer_; }
    void restart();             // forgets all batches
    bool step(uint64_t length); // renders a frame; true: with it a batch of so many is complete
    const image::MeanPicture& mean() const { return mean_; } // of the batches that are

  private:
    void begin();

    std::unique_ptr<Renderer> renderer_;
    Settings settings_;
    image::MeanPicture mean_;
};

// References of one scene, one for each frame of a sequence, made when first asked for. What was made is found again in
// the cache by the settings, the precision and the pixels of one frame: those change with the scene, the device and the
// program.
class References
{
  public:
    struct Options {
        Precision precision;
        std::filesystem::path cache; // folder; empty: none
        std::function<void(double fraction)> progress = [](double) {};
        std::function<bool()> stop = [] { return false; };
    };
    // Of the scene of `sharing`, path traced.
    References(const Renderer& sharing, const Settings& settings, Sequence sequence, Options options);
    // A picture from a file, where nothing moves. Throws Error: unreadable, of another size, not finite.
    References(const std::filesystem::path& file, const Settings& settings);

    // For the picture after so many frames. Null when stopped before it was made. Throws Error: the cache cannot be
    // written.
    const Reference* after(uint64_t frames);
    const Precision& precision() const { return options_.precision; }
    const std::map<uint64_t, Reference>& made() const { return made_; }    // by frame; 0 where nothing moves
    const std::vector<std::string>& warnings() const { return warnings_; } // about the file, for the person

  private:
    std::optional<Reference> trace(); // of what the renderer sees; nothing when stopped

    Settings settings_;
    Sequence sequence_;
    Options options_;
    std::optional<ReferenceTracer> tracer_; // empty: all are made
    std::map<uint64_t, Reference> made_;
    std::vector<std::string> warnings_;
};

} // namespace passes
