#pragma once
// Studies of what the sides do, measured beside their pictures: a frame at a time, on the same device, in turns.

#include <memory>
#include <vector>

#include "passes/pipeline_pool.h"
#include "ui/window/findings.h"

namespace ui
{

class Study
{
  public:
    virtual ~Study() = default;
    virtual bool step(Findings& findings) = 0; // renders a frame or two; true: there is something new
    virtual bool done() const { return false; }
};

// What studies are of: a side's settings as they run, seen by a camera. `like` lends scene and device.
struct Subject {
    passes::Renderer& like;
    const scene::Scene& scene;
    scene::Camera camera;
    passes::Settings settings;
    Side side = A;
};
std::unique_ptr<Study> makeReferenceStudy(const Subject& subject);
std::unique_ptr<Study> makeCorrelationStudy(const Subject& subject); // null: it has no history
std::unique_ptr<Study> makeFloorStudy(const Subject& subject);
std::unique_ptr<Study> makeSavingsStudy(const Subject& subject);

class Studies
{
  public:
    using Stages = std::vector<std::pair<std::string, passes::Variant>>;

    // What the order's studies compile.
    static Stages stagesFor(const Order& order, const passes::Renderer& like);

    // Begins what is newly ordered, ends what no longer is, and starts over what is of other settings or another camera
    // now. True: findings() have lost something. Throws Error: memory, the device is lost.
    bool follow(const Order& order, passes::Renderer& like, const scene::Scene& scene);
    bool step(); // of the next study in turn; true: findings() are new
    bool busy() const;
    void clear(); // before the scene or the device goes
    std::shared_ptr<const Findings> findings() const { return std::make_shared<const Findings>(findings_); }

  private:
    enum Kind { Reference, CorrelationA, CorrelationB, FloorA, FloorB, Saved, KINDS };
    struct Entry {
        std::unique_ptr<Study> study;
        bool ordered = false;
        Order of; // that it was begun for
    };
    static bool wanted(const Order& order, Kind kind);
    static bool sameSubject(const Order& a, const Order& b, Kind kind);
    void forget(Kind kind);

    Entry entries_[KINDS];
    Findings findings_;
    int turn_ = 0;
};

} // namespace ui
