// What a frame leaves in reservoirs, for people to look at (the stages inspect*.comp).
#ifndef SHADERS_SHARED_INSPECTION_H
#define SHADERS_SHARED_INSPECTION_H

#include "shared/types.h"

SHARED_BEGIN

// inspect.comp
struct Inspection {
    uint seedFrame; // the sample: which walk drew it, frame and pixel,
    uint seedPixel;
    uint pathIdAndReconnection; // which path of that walk (low half); reconnection index r (high half; 0: replayed)
    uint lengthAndShifts; // scattering events (low half); spatial shifts to and from here: tried (8 bits), failed (8
                          // bits)
    float weightSum;      // S
    float target;         // p_hat of the sample
    float weight;         // W = S / p_hat; 0 without a sample
    uint confidence;      // frames; of the pixel
};

// inspect_path.comp: a vertex as the camera sees it. Its picture point is (x, y) / depth, in [-1, 1]^2 with y up, where
// depth > 0; else it is behind the camera.
struct PathPoint {
    float x;
    float y;
    float depth; // scaled lengths; 1 for parallel rays
    uint kind;   // POINT_*
};
SHARED_CONST uint POINT_NONE = 0u;
SHARED_CONST uint POINT_SURFACE = 1u; // scatters here
SHARED_CONST uint POINT_LIGHT = 2u;   // ends here
SHARED_CONST uint POINT_FAR = 3u;     // ends at infinity: a point on the way there
struct PathRequest {
    uint pixel;
    uint plain; // not what reservoirs hold, but the whole walk that this frame's seed of the pixel draws
    uint padding0;
    uint padding1;
};

SHARED_END

#endif
