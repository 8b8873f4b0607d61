#include "ui/window/studies.h"

#include "passes/camera_choice.h"
#include "passes/experiments/autocovariance.h"
#include "passes/experiments/reference.h"

namespace ui
{

namespace
{

Side sideOf(int kind, int kindOfA)
{
    return kind == kindOfA ? A : B;
}

} // namespace

bool Studies::wanted(const Order& order, Kind kind)
{
    const StudyOrder& studies = order.studies;
    switch (kind) {
    case Reference: return studies.reference;
    case CorrelationA: return studies.correlation;
    case CorrelationB: return studies.correlation && order.rival;
    case FloorA: return studies.floor;
    case FloorB: return studies.floor && order.rival;
    case Saved: return studies.savings > 0;
    case KINDS: break;
    }
    return false;
}

bool Studies::sameSubject(const Order& a, const Order& b, Kind kind)
{
    if (a.pose != b.pose || sourceOf(a) != sourceOf(b) || a.restarts != b.restarts) return false;
    const Side side = kind == CorrelationB || kind == FloorB ? B : A;
    passes::Settings one = settingsOf(a, side), other = settingsOf(b, side);
    if (kind == Reference) one = passes::referenceSettings(one), other = passes::referenceSettings(other);
    return one == other && (kind != Saved || a.studies.savings == b.studies.savings);
}

void Studies::forget(Kind kind)
{
    switch (kind) {
    case Reference: findings_.reference.reset(); break;
    case CorrelationA:
    case CorrelationB: findings_.curves[sideOf(kind, CorrelationA)].reset(); break;
    case FloorA:
    case FloorB: findings_.floors[sideOf(kind, FloorA)].reset(); break;
    case Saved: findings_.savings.reset(); break;
    case KINDS: break;
    }
}

void Studies::clear()
{
    for (int kind = 0; kind < KINDS; ++kind) {
        entries_[kind] = {};
        forget(Kind(kind));
    }
}

Studies::Stages Studies::stagesFor(const Order& order, const passes::Renderer& like)
{
    Stages stages;
    const auto add = [&](const passes::Settings& settings) {
        for (auto& stage : passes::stagesOf(like.scene(), settings)) stages.push_back(std::move(stage));
    };
    passes::Settings plain = settingsOf(order, A);
    plain.method = passes::Method::Pt;
    if (order.studies.reference || order.studies.correlation || order.studies.floor) add(plain);
    if (order.studies.correlation || order.studies.floor) add(passes::emissionSettings(plain));
    for (const Side side : {A, B}) {
        passes::Settings settings = settingsOf(order, side);
        if (settings.method == passes::Method::Pt || (side == B && !order.rival)) continue;
        if (order.studies.correlation) add(settings);
        if (order.studies.correlation || order.studies.floor) add(passes::lawSettings(settings));
    }
    if (order.studies.savings > 0) {
        for (const auto& [name, needed] : passes::stagesOf(like.scene(), settingsOf(order, A), true))
            stages.emplace_back(name, passes::withAllFeatures(needed));
    }
    return stages;
}

bool Studies::follow(const Order& order, passes::Renderer& like, const scene::Scene& scene)
{
    bool changed = false;
    for (int i = 0; i < KINDS; ++i) {
        const Kind kind = Kind(i);
        Entry& entry = entries_[kind];
        const bool want = wanted(order, kind);
        if (entry.ordered && want && sameSubject(entry.of, order, kind)) continue;
        if (!entry.ordered && !want) continue;
        entry = {};
        forget(kind);
        changed = true;
        if (!want) continue;
        const Side side = kind == CorrelationB || kind == FloorB ? B : A;
        const scene::Camera& base = scene.cameras[passes::chooseCamera(scene, order.settings.camera)];
        const Subject subject{.like = like,
                              .scene = scene,
                              .camera = order.pose ? cameraOf(*order.pose, base, scene.origin) : base,
                              .settings = settingsOf(order, side),
                              .side = side};
        entry.ordered = true;
        entry.of = order;
        switch (kind) {
        case Reference: entry.study = makeReferenceStudy(subject); break;
        case CorrelationA:
        case CorrelationB: entry.study = makeCorrelationStudy(subject); break;
        case FloorA:
        case FloorB: entry.study = makeFloorStudy(subject); break;
        case Saved: entry.study = makeSavingsStudy(subject); break;
        case KINDS: break;
        }
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
    for (int tried = 0; tried < KINDS; ++tried) {
        turn_ = (turn_ + 1) % KINDS;
        const Entry& entry = entries_[turn_];
        if (entry.study && !entry.study->done()) return entry.study->step(findings_);
    }
    return false;
}

} // namespace ui
