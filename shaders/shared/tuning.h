// What shaders and the device layer agree on (engine/gpu/tuning.h). The numbers of the constants that it sets whatever
// the stage are 64 and above, apart from variant.h's and those of tests.
#ifndef SHADERS_SHARED_TUNING_H
#define SHADERS_SHARED_TUNING_H

#include "shared/types.h"

SHARED_BEGIN

// How counters add.
SHARED_CONST uint COUNTERS_EACH = 0u;     // every invocation
SHARED_CONST uint COUNTERS_SUBGROUP = 1u; // one invocation, the sum of its subgroup
SHARED_CONST uint COUNTERS_OFF = 2u;      // nobody, but for values that are not finite

// Of a table that is written, where tables are texel buffers: its binding as a storage buffer lies so far behind its
// own.
SHARED_CONST uint STORES_BINDING = 16u;

SHARED_END

#endif
