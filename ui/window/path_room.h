#pragma once
// The camera path, recorded as keyframes along the timeline, and the film of what plays.

#include "ui/window/window_state.h"

namespace ui
{

// What is seen becomes the keyframe of the frame that is shown. In a scene at rest the timeline goes on by a second, so
// that the next one has a place.
void addKeyframe(WindowState& state);

void drawPath(WindowState& state); // in the panel

} // namespace ui
