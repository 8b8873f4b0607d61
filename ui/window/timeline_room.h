#pragma once
// The timeline below the picture, where the scene has animations: play, step, scrub, and which of them.

#include "ui/window/window_state.h"

namespace ui
{

float timelineHeight(const WindowState& state); // 0: there is none
void drawTimeline(WindowState& state);

// They do nothing where nothing can play.
void play(WindowState& state, bool on);         // on from what is shown; off: what is shown rests
void stepScene(WindowState& state, int frames); // it rests there
void stopAtTheEnd(WindowState& state);          // where it plays once

} // namespace ui
