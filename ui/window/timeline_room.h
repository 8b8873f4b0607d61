#pragma once
// The timeline below the picture, where the scene has animations or the camera a path: play, step, scrub, and which
// animations. It counts frames. Frame 0 shows the scene at state.start, each later one 1/fps seconds (times the speed)
// further, and the camera where the path has it.

#include "ui/window/window_state.h"

namespace ui
{

float timelineHeight(const WindowState& state); // 0: there is none
void drawTimeline(WindowState& state);

// They do nothing where nothing can play.
void play(WindowState& state, bool on);         // on from what is shown; off: what is shown rests
void stepScene(WindowState& state, int frames); // it rests there
void stopAtTheEnd(WindowState& state);          // where it plays once; a path that plays again begins again

uint64_t frameNow(const WindowState& state); // that is shown
void goToFrame(WindowState& state, uint64_t frame);
// How many frames it takes to show all: up to the last keyframe; without a path, each of the scene's once. 0: nothing
// moves.
uint64_t framesOfAll(const WindowState& state);
double startOfScene(const WindowState& state); // seconds, in frame 0
bool sceneMoves(const WindowState& state);     // with the timeline: it is not at rest

} // namespace ui
