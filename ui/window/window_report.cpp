#include "ui/window/window_report.h"

#include "engine/base/memory.h"
#include "ui/cli/run_report.h"
#include "ui/window/false_color.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

namespace ui
{

namespace
{

using Json = nlohmann::ordered_json;

Json reportOf(const Shot& shot)
{
    return {{"scene", shot.order.scene.name},
            {"settings", toJson(shot.order.settings, poseText(shot))},
            {"frames", shot.frames},
            {"seconds", shot.seconds},
            {"moving", shot.order.moving},
            {"playing", shot.order.playing},
            {"frame", shot.order.playing ? shot.firstFrame + std::max<uint64_t>(shot.frames, 1) - 1 : shot.order.frame},
            {"scene_seconds", shot.sceneSeconds ? Json(*shot.sceneSeconds) : Json(nullptr)},
            {"camera_moved", shot.order.pose.has_value()},
            {"paused", shot.order.paused},
            {"reservoirs", reservoirCount(shot)},
            {"shifts_read", shot.shifts.size()},
            {"memory_bytes", shot.stats.memoryBytes},
            {"variant", shot.stats.variant},
            {"nonfinite", shot.stats.nonFinite}};
}

Json reportOf(const View& view)
{
    return {{"first", int(view.first)}, {"second", int(view.second)},          {"layout", int(view.layout)},
            {"wipe", view.wipe},        {"false_color", int(view.falseColor)}, {"flipped", view.flipped}};
}

Json reportOf(const Findings& findings)
{
    Json json = Json::object();
    if (findings.reference) {
        const Reference& reference = *findings.reference;
        json["reference"] = {{"name", reference.name}, {"own_mse", reference.error.mse}};
    }
    for (const Side side : {A, B}) {
        const char* name = side == A ? "a" : "b";
        if (findings.curves[side])
            for (const passes::CurvePoint& point : findings.curves[side]->curve.points)
                json["correlation"][name].push_back({{"frame", point.frame},
                                                     {"measured", point.autocovariance.mean},
                                                     {"standard_error", std::sqrt(point.autocovariance.varianceOfMean)},
                                                     {"predicted", point.law ? Json(point.law->mean) : Json(nullptr)}});
        if (findings.floors[side]) json["floor"][name] = {{"frames", findings.floors[side]->frames}};
    }
    if (const std::optional<Savings>& savings = findings.savings)
        json["savings"] = {{"frames", savings->frames},
                           {"needed_ms", savings->neededMilliseconds},
                           {"everything_ms", savings->everythingMilliseconds},
                           {"needed_bytes", savings->neededBytes},
                           {"everything_bytes", savings->everythingBytes}};
    return json;
}

} // namespace

Json reportOf(const WindowState& state, const ErrorMeter& meter)
{
    const ShotPointer& a = state.pictures.sides[A];
    Json json = reportOf(a ? *a : Shot()); // at the top; before the first picture one without frames
    if (state.pictures.sides[B]) json["b"] = reportOf(*state.pictures.sides[B]);
    json["asked"] = {
        {"settings", passes::toJson(state.order.settings)}, // what hands have set, whether it runs yet or not
        {"comparing", state.order.rival.has_value()},
        {"paused", state.order.paused},
        {"playing", state.order.playing},
        {"time", state.order.scene.time ? Json(*state.order.scene.time) : Json(nullptr)},
        {"moved", state.order.pose.has_value()},
        {"frame", state.order.frame},
        {"keyframes", framesOf(state.order.path)},
        {"pixel", state.pixel},
        {"converging", state.order.studies.reference},
        {"correlation", state.order.studies.correlation}};
    json["activity"] = state.activity;
    json["ahead"] = state.ahead;
    json["message"] = state.message;
    json["view"] = reportOf(state.view);
    json["recent"] = state.recent;
    json["reference"] = state.pictures.reference ? state.pictures.reference->name : "";
    for (const Side side : {A, B}) {
        const ErrorCurve curve = meter.curve(side);
        Json errors = {{"points", curve.size()}};
        if (!curve.empty()) errors.update({{"relmse", curve.back().metrics.relmse}, {"mse", curve.back().metrics.mse}});
        json["errors"][side == A ? "a" : "b"] = errors;
    }
    json["findings"] = reportOf(*state.findings);
    json["picture"] = state.area;
    if (const ShotPointer& shot = state.pictures.sides[A]; shot && state.inspected && state.pixel) {
        json["hovered"] = *state.inspected;
        for (const auto& path : shot->paths) json["path_points"].push_back(path.size());
        const size_t pixel = size_t{(*state.inspected)[1]} * shot->picture.width + (*state.inspected)[0];
        for (int c = 0; c < reservoirCount(*shot) && pixel < shot->picture.pixels.size(); ++c)
            json["inspected"].push_back(shot->reservoirs[size_t(c) * shot->picture.pixels.size() + pixel].confidence);
    }
    json["scale"] = state.scale;
    json["heap_bytes"] = memory::heapBytes();
    json["places"] = state.places;
    return json;
}

} // namespace ui
