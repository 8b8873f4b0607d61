#include "ui/window/studies.h"

#include "passes/camera_path.h"
#include "passes/experiments/autocovariance.h"
#include "passes/experiments/reference.h"

namespace ui
{

namespace
{

uint64_t orderedOf(const StudyKind& kind, Side side, const Order& order)
{
    return side == A || (kind.eachSide && order.rival) ? kind.ordered(order.studies) : 0;
}

bool sameSubject(const StudyKind& kind, Side side, const Order& a, const Order& b)
{
    const auto settings = [&](const Order& order) {
        return kind.ofPicture ? passes::referenceSettings(settingsOf(order, side)) : settingsOf(order, side);
    };
    return a.pose == b.pose && a.scene == b.scene && a.restarts == b.restarts &&
           orderedOf(kind, side, a) == orderedOf(kind, side, b) && settings(a) == settings(b);
}

} // namespace

void Studies::clear()
{
    for (Entry& entry : entries_) entry = {};
    findings_ = {};
}

passes::StageList Studies::stagesFor(const Order& order, const passes::Renderer& like)
{
    std::vector<passes::Settings> sides = {settingsOf(order, A)}, list;
    if (order.rival) sides.push_back(settingsOf(order, B));
    passes::Settings plain = sides[A];
    plain.method = passes::Method::Pt;
    if (order.studies.reference || order.studies.correlation || order.studies.floor) list.push_back(plain);
    if (order.studies.correlation || order.studies.floor) list.push_back(passes::emissionSettings(plain));
    for (const passes::Settings& settings : sides) {
        if (settings.method == passes::Method::Pt) continue;
        if (order.studies.correlation) list.push_back(settings);
        if (order.studies.correlation || order.studies.floor) list.push_back(passes::lawSettings(settings));
    }
    passes::StageList stages = passes::stagesOf(like.scene(), list);
    if (order.studies.savings > 0)
        for (const auto& [name, needed] : passes::stagesOf(like.scene(), {&sides[A], 1}, true))
            stages.emplace_back(name, passes::withAllFeatures(needed));
    return stages;
}

bool Studies::follow(const Order& order, passes::Renderer& like, const scene::Scene& scene)
{
    bool changed = false;
    for (size_t i = 0; i < STUDIES; ++i) {
        const StudyKind& kind = STUDY_KINDS[i / SIDES];
        const Side side = Side(i % SIDES);
        Entry& entry = entries_[i];
        const bool want = orderedOf(kind, side, order) > 0;
        if (entry.of ? want && sameSubject(kind, side, *entry.of, order) : !want) continue;
        entry = {};
        kind.forget(findings_, side);
        changed = true;
        if (!want) continue;
        const scene::Camera& base = scene.cameras[passes::chooseCamera(scene, order.settings.camera)];
        entry.of = order;
        entry.study = kind.make({.like = like,
                                 .scene = scene,
                                 .camera = order.pose ? cameraOf(*order.pose, base, scene.origin) : base,
                                 .settings = settingsOf(order, side),
                                 .side = side});
    }
    return changed;
}

bool Studies::busy() const
{
    for (const Entry& entry : entries_)
        if (entry.study && !entry.study->done()) return true;
    return false;
}

bool Studies::step()
{
    for (size_t tried = 0; tried < STUDIES; ++tried) {
        turn_ = (turn_ + 1) % STUDIES;
        const Entry& entry = entries_[turn_];
        if (entry.study && !entry.study->done()) return entry.study->step(findings_);
    }
    return false;
}

} // namespace ui
