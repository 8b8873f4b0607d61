#pragma once
// The pictures that frames leave behind: a row each. One more is a buffer of FrameBuffers, a row here, and a line of
// the shader that fills it.

#include "passes/settings.h"

namespace passes
{

struct Output {
    const char* name;     // as options and the layers of files call it
    const char* channels; // of a pixel, a letter each
    const char* buffer;   // that holds it (frame_buffers.h)
    bool light;           // read in the scene's units of radiance
    bool sums;            // there: over all frames, with what rounding gave the sum too much; else of the last frame
    const char* doc;
};
constexpr Output MEAN = {"mean", "RGB", "Film", true, true, "the color, of all frames"};
constexpr Output LAST_FRAME = {"frame", "RGB", "Color", true, false, "the color, of the last frame alone"};
constexpr const Output* OUTPUTS[] = {&MEAN, &LAST_FRAME};

// The one that is written when nothing else is asked for.
constexpr const Output& colorOf(const Settings& settings)
{
    return settings.average ? MEAN : LAST_FRAME;
}

} // namespace passes
