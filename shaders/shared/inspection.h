// What a reservoir holds after a frame, for people to look at (inspect.comp).
#ifndef SHADERS_SHARED_INSPECTION_H
#define SHADERS_SHARED_INSPECTION_H

#include "shared/types.h"

SHARED_BEGIN

struct Inspection {
    uint seedFrame; // the sample: which walk drew it, frame and pixel,
    uint seedPixel;
    uint leafAndJoint;    // which path of that walk (low half), where it is reconnected (high half; 0: replayed)
    uint lengthAndShifts; // scattering events (low half); spatial shifts to and from here: tried (8 bits), failed (8
                          // bits)
    float weightSum;      // S
    float target;         // p_hat of the sample
    float weight;         // W = S / p_hat; 0 without a sample
    uint confidence;      // frames; of the pixel
};

SHARED_END

#endif
