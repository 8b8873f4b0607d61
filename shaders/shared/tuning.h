// How counters add, of the constants that the device layer sets whatever the stage (engine/gpu/tuning.h). The numbers
// of those constants are 64 and above, apart from variant.h's and those of tests.
#ifndef SHADERS_SHARED_TUNING_H
#define SHADERS_SHARED_TUNING_H

#include "shared/types.h"

SHARED_BEGIN

SHARED_CONST uint COUNTERS_EACH = 0u;     // every invocation
SHARED_CONST uint COUNTERS_SUBGROUP = 1u; // one invocation, the sum of its subgroup
SHARED_CONST uint COUNTERS_OFF = 2u;      // nobody, but for values that are not finite

SHARED_END

#endif
