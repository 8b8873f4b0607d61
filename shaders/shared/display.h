// How display.comp takes radiance to the screen.
#ifndef SHADERS_SHARED_DISPLAY_H
#define SHADERS_SHARED_DISPLAY_H

#include "shared/types.h"

SHARED_BEGIN

SHARED_CONST uint CURVE_REINHARD = 0u; // c/(c+1), as PNG files
SHARED_CONST uint CURVE_ACES = 1u;     // a fit of the ACES film curve
SHARED_CONST uint CURVE_NONE = 2u;     // cut at 1

SHARED_END

#endif
