#pragma once
// What is tried: a scene, settings, and what the picture must be equal to.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "engine/scene/scene.h"
#include "passes/settings.h"
#include "tests/hunt/moves.h"
#include "tests/hunt/palette.h"

namespace hunt
{

enum class Kind : uint32_t {
    Panes,  // parallel panes close together before a wall: blended, masked, glass, mirrors
    Sky,    // small bright spots in skies of 4 to 4096 rows
    Scales, // things of meters and millimeters within domes, planes and triangles of kilometers
    Sealed, // closed bodies seen from inside, lit from outside: black
    Edges,  // pixel centers look exactly at edges, corners and diagonals
    Lights, // emitters, points, spots and suns of extreme sizes and powers
    Things, // anything
    Colors, // anything whose color changes from pixel to pixel
    Moving  // rooms full of indirect light, and scenes of the others but Sealed: they move while they are seen
};
constexpr const char* KIND_NAMES[] = {"panes",  "sky",    "scales", "sealed", "edges",
                                      "lights", "things", "colors", "moving"};
constexpr uint32_t KINDS = uint32_t(std::size(KIND_NAMES));

// What the mean of many runs is compared with.
enum class Truth : uint32_t {
    Black,      // nothing: no pixel may be brighter than 0
    PathTracer, // --method pt, which another comparison tests
    Reference   // the float64 tracer of tests/support
};
constexpr const char* TRUTH_NAMES[] = {"black", "pt", "reference"};

struct Case {
    uint64_t number = 0;
    Kind kind = Kind::Things;
    Truth truth = Truth::PathTracer;
    scene::Scene scene;
    passes::Settings settings; // of the method on trial
    double orbit = 0;          // degrees a frame; 0: the camera rests
    std::vector<Move> moves;   // of the scene, which is stated at rest

    bool stores = false; // the trial has meshes stored once, the truth has not

    scene::Scene sceneIn(uint32_t frame) const; // of settings.frames
    scene::Scene onTrial() const;               // the same world, as the trial is shown it
    std::string describe() const;
};

// Which of all cases somebody wants.
struct Wanted {
    std::string kind, truth;                                   // by name; empty: any
    std::vector<std::pair<std::string, std::string>> settings; // knobs and their values, as on the command line
    bool onItself = false; // the path tracer is compared with itself: whatever is found is a false alarm
};

// What the cases of a session share: all that is compiled into stages.
constexpr uint64_t SESSION_CASES = 12;
class Session
{
  public:
    // Throws Error: no such kind, truth, setting or value.
    Session(uint64_t seed, uint64_t index, Wanted wanted = {});
    Case draw(uint64_t place) const; // one of SESSION_CASES
    Kind kind() const { return kind_; }

  private:
    void insist(passes::Settings& settings) const; // on what is wanted

    uint64_t seed_, index_;
    Wanted wanted_;
    Kind kind_, scenes_; // the latter: whose scenes they are
    Truth truth_;
    Palette palette_;
    passes::Settings settings_;
    bool orthographic_ = false, paints_ = false, stores_ = false;
};

// One kind's scenes, with a camera; complete() does the rest.
scene::Scene drawScene(Kind kind, Truth truth, const Palette& palette, Draw& draw);

} // namespace hunt
