#pragma once
// Studies of what the sides do, measured beside their pictures: a frame at a time, on the same device, in turns.

#include <iterator>
#include <memory>
#include <optional>

#include "passes/frame_plan.h"
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
struct StudyKind {
    bool eachSide;                          // else of A alone
    bool ofPicture;                         // it is the same whatever of the settings does not change the right picture
    uint64_t (*ordered)(const StudyOrder&); // another number asks for another study, 0 for none
    std::unique_ptr<Study> (*make)(const Subject&); // null: there is nothing to study
    void (*forget)(Findings&, Side);
};
extern const StudyKind STUDY_KINDS[4];

class Studies
{
  public:
    // What the order's studies compile.
    static passes::StageList stagesFor(const Order& order, const passes::Renderer& like);

    // Begins what is newly ordered, ends what no longer is, and starts over what is of other settings or another camera
    // now. True: findings() have lost something. Throws Error: memory, the device is lost.
    bool follow(const Order& order, passes::Renderer& like, const scene::Scene& scene);
    bool step(); // of the next study in turn; true: findings() are new
    bool busy() const;
    void clear(); // before the scene or the device goes
    std::shared_ptr<const Findings> findings() const { return std::make_shared<const Findings>(findings_); }

  private:
    static constexpr size_t STUDIES = std::size(STUDY_KINDS) * SIDES;
    struct Entry {
        std::unique_ptr<Study> study;
        std::optional<Order> of; // that it was begun for; empty: it is not ordered
    };
    Entry entries_[STUDIES];
    Findings findings_;
    size_t turn_ = 0;
};

} // namespace ui
