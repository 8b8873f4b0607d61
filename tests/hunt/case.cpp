#include "tests/hunt/case.h"
#include "tests/support/stored_meshes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "engine/base/check.h"
#include "engine/base/error.h"

namespace hunt
{

namespace
{

constexpr double WEIGHTS[KINDS] = {3, 3, 3, 2, 2, 2, 5, 3, 6};

Kind drawKind(Draw& draw, const std::string& only)
{
    double total = 0;
    for (uint32_t kind = 0; kind < KINDS; ++kind) {
        if (only == KIND_NAMES[kind]) return Kind(kind);
        total += WEIGHTS[kind];
    }
    if (!only.empty()) throw Error("There is no kind \"{}\"; there are: {}.", only, fmt::join(KIND_NAMES, ", "));
    double at = draw.uniform() * total;
    uint32_t kind = 0;
    while (kind + 1 < KINDS && at >= WEIGHTS[kind]) at -= WEIGHTS[kind++];
    return Kind(kind);
}

Truth drawTruth(Draw& draw, Kind kind, const std::string& only)
{
    if (kind == Kind::Sealed) return Truth::Black;
    if (kind == Kind::Moving) return Truth::PathTracer; // which shows what is tried there: temporal reuse
    if (only == TRUTH_NAMES[size_t(Truth::PathTracer)]) return Truth::PathTracer;
    if (only == TRUTH_NAMES[size_t(Truth::Reference)]) return Truth::Reference;
    if (!only.empty()) throw Error("There is no truth \"{}\" to choose; there are: pt, reference.", only);
    const double reference = kind == Kind::Panes ? 0.2 : kind == Kind::Edges ? 0.7 : 0.5;
    return draw.chance(reference) ? Truth::Reference : Truth::PathTracer;
}

// Each setting that is a choice among words, those of the future too.
void drawChoices(passes::Settings& settings, Draw& draw)
{
    for (const passes::KnobText& knob : passes::describeSettings()) {
        if (knob.name == "method" || knob.name == "average" || knob.values.find('|') == std::string::npos) continue;
        std::vector<std::string> words = {""};
        for (const char c : knob.values) {
            if (c == '|')
                words.emplace_back();
            else
                words.back() += c;
        }
        passes::set(settings, knob.name, words[draw.below(uint32_t(words.size()))]);
    }
}

Palette drawPalette(Draw& draw, Kind kind, Truth truth)
{
    Palette p;
    p.smooth = truth != Truth::Reference;
    const auto take = [&](double chance, std::initializer_list<Stuff> choices) {
        if (draw.chance(chance)) p.stuff.push_back(draw.of(choices));
    };
    using enum Stuff;
    switch (kind) {
    case Kind::Panes:
        take(0.85, {Blend});
        take(p.stuff.size() == 1 ? 1 : 0.3, {Mask, ThinClear, ThinRough, SolidClear, Mirror});
        take(0.3, {Glossy, RoughMetal});
        break;
    case Kind::Sky:
    case Kind::Lights: take(0.5, {Glossy, RoughMetal, Mirror}); break;
    case Kind::Scales:
        take(0.4, {Glossy, RoughMetal});
        take(0.3, {ThinClear, SolidClear, Blend, Mirror});
        break;
    case Kind::Sealed: take(0.5, {Glossy, RoughMetal, Mirror}); break;
    case Kind::Edges:
        take(0.6, {Blend});
        take(0.4, {Glossy, Mirror, ThinClear, SolidClear, Mask});
        break;
    case Kind::Things:
        take(0.6, {Glossy, RoughMetal});
        take(0.4, {Mirror, ThinClear, ThinRough, SolidClear, SolidRough});
        take(0.3, {Mirror, ThinClear, ThinRough, SolidClear, SolidRough});
        take(0.3, {Blend, Mask});
        take(0.15, {Unlit});
        if (draw.chance(0.5)) p.addRandomTextures(draw);
        break;
    case Kind::Colors:
        take(0.5, {Glossy, RoughMetal});
        take(0.3, {Mirror, ThinClear, ThinRough, SolidClear, SolidRough, Blend});
        p.addRandomTextures(draw);
        p.baseColorTexture = true;
        break;
    case Kind::Moving: take(0.5, {Glossy, RoughMetal, Mirror, ThinRough, SolidClear}); break;
    }
    p.sky = draw.chance(kind == Kind::Panes ? 0.7 : kind == Kind::Sealed ? 0.6 : 0.4);
    p.emitters = draw.chance(kind == Kind::Edges ? 0.7 : 0.5);
    p.punctual = draw.chance(kind == Kind::Lights ? 0.6 : 0.2);
    p.directional = draw.chance(kind == Kind::Lights ? 0.4 : 0.1);
    if (kind == Kind::Sky)
        p.sky = true, p.emitters = p.emitters && draw.chance(0.3), p.punctual = p.directional = false;
    // Light from all around is picked by the area of the scene, which is all but always where it spans kilometers.
    if (kind == Kind::Scales) p.directional = false, p.sky = p.sky && !p.emitters && !p.punctual;
    if (!(p.sky || p.emitters || p.punctual || p.directional)) p.emitters = true;
    return p;
}

} // namespace

Session::Session(uint64_t seed, uint64_t index, Wanted wanted) : seed_(seed), index_(index), wanted_(std::move(wanted))
{
    Draw draw{seed, index};
    kind_ = drawKind(draw, wanted_.kind);
    scenes_ = kind_;
    if (kind_ == Kind::Moving) {
        using enum Kind;
        scenes_ = draw.of({Moving, Moving, Moving, Panes, Sky, Scales, Edges, Lights, Things, Things, Things, Colors});
        paints_ = draw.chance(0.4);
    }
    truth_ = drawTruth(draw, kind_, wanted_.truth);
    palette_ = drawPalette(draw, scenes_, truth_);
    palette_.emitters |= paints_ || scenes_ == Kind::Moving;
    drawChoices(settings_, draw);
    using enum passes::Method;
    settings_.method = truth_ == Truth::Reference ? Pt
                       : kind_ == Kind::Sealed && draw.chance(0.4)
                           ? Pt
                           : draw.of({RestirPt, RgbRestir, RgbRestir, GroupedRestir});
    settings_.pixelFilter = draw.chance(0.75) ? passes::PixelFilter::Center : passes::PixelFilter::Box;
    const bool shallow = scenes_ == Kind::Sky || scenes_ == Kind::Panes || scenes_ == Kind::Lights;
    settings_.maxBounces = draw.chance(0.03) ? 0 : draw.from(1, shallow ? 3 : draw.chance(0.2) ? 8 : 4);
    if (kind_ == Kind::Moving) settings_.maxBounces = std::max(settings_.maxBounces, 2u); // what is behind x_r
    settings_.average = false;
    orthographic_ = draw.chance(0.12);
    insist(settings_);
    const bool stores = kind_ != Kind::Moving && draw.chance(0.25);
    stores_ = stores && kind_ != Kind::Edges; // where surfaces lie in one plane, and the order of triangles decides
    if (!wanted_.onItself) return;
    truth_ = Truth::PathTracer;
    settings_.method = Pt;
}

void Session::insist(passes::Settings& settings) const
{
    for (const auto& [knob, value] : wanted_.settings) passes::set(settings, knob, value);
}

Case Session::draw(uint64_t place) const
{
    CHECK(place < SESSION_CASES);
    Draw draw{seed_, index_, place + 1};
    Case c{.number = index_ * SESSION_CASES + place, .kind = kind_, .truth = truth_, .settings = settings_};
    c.scene = drawScene(scenes_, truth_, palette_, draw);
    palette_.complete(c.scene, draw);
    c.stores = stores_;
    scene::Camera& camera = c.scene.cameras.at(0);
    if (orthographic_) {
        camera.orthographic = true;
        camera.ymag = std::tan(camera.yfov / 2) * glm::length(camera.target - camera.position);
    }
    passes::Settings& s = c.settings;
    s.width = s.height = draw.chance(0.1) ? 16 : 8;
    if (draw.chance(0.05)) s.width = draw.from(3, 12);
    s.frames = 1;
    if (s.method == passes::Method::Pt) return c;
    s.temporal = draw.chance(0.8) || kind_ == Kind::Moving;
    s.spatial = draw.chance(0.4) ? 0 : draw.chance(0.8) ? draw.from(1, 3) : draw.from(4, 8);
    s.spatialRadius = draw.chance(0.5) ? 0 : float(draw.between(1, 6));
    s.maxConfidence = draw.chance(0.3) ? 20 : uint32_t(std::exp2(draw.between(0, 20.001)));
    insist(s); // before the choices that depend on it
    s.frames = !s.temporal ? 1 : draw.chance(0.1) ? draw.from(8, 16) : draw.from(2, 5);
    if (s.temporal && draw.chance(0.5)) c.orbit = draw.chance(0.5) ? draw.logBetween(1e-3, 3) : draw.between(-3, 3);
    insist(s);
    if (kind_ == Kind::Moving && s.temporal) c.moves = drawMoves(draw, c.scene, s.frames, paints_);
    return c;
}

scene::Scene Case::sceneIn(uint32_t frame) const
{
    CHECK_LT(frame, settings.frames);
    return posed(scene, moves, settings.frames - 1 - frame);
}

// Every other material that does not emit, in spaces that are turned by quarters, mirrored and halved: exactly, so that
// neighbors still meet.
scene::Scene Case::onTrial() const
{
    scene::Scene trial = moves.empty() ? scene : withMotion(scene, moves);
    for (uint32_t m = 0; stores && m < scene.materials.size(); ++m) {
        const bool used = std::ranges::find(trial.triangles, m, &scene::Triangle::material) != trial.triangles.end();
        if (m % 3 == 2 || !used || scene.materials[m].emission != glm::vec3(0)) continue;
        glm::dmat4 place(0);
        for (uint32_t axis = 0; axis < 3; ++axis) place[int(axis)][int((axis + m) % 3)] = (m + axis) % 2 ? -0.5 : 0.5;
        place[3][3] = 1;
        trial = support::storedInPlace(std::move(trial), m, place);
    }
    return trial;
}

std::string Case::describe() const
{
    std::string text = fmt::format("case {} ({}, against {}): {} triangles, {} lights, sky of {} rows", number,
                                   KIND_NAMES[size_t(kind)], TRUTH_NAMES[size_t(truth)], scene.triangles.size(),
                                   scene.lights.size(), scene.environment.height);
    const auto usual = passes::toText(passes::Settings{});
    const auto mine = passes::toText(settings);
    for (size_t i = 0; i < mine.size(); ++i)
        if (mine[i] != usual[i] && mine[i].first != "average")
            text += fmt::format(" --{} {}", mine[i].first, mine[i].second);
    if (orbit != 0) text += fmt::format(" --orbit {}", orbit);
    if (stores) text += ", meshes stored once";
    for (const Move& move : moves)
        text += fmt::format(", {} {} {}", WHAT_NAMES[size_t(move.what)], move.target, WHEN_NAMES[size_t(move.when)]);
    return text;
}

} // namespace hunt
