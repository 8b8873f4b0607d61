// How many rows (uvec4) a pixel takes in the tables of a frame: what shaders index by, and the host allocates.
#ifndef SHADERS_SHARED_ROWS_H
#define SHADERS_SHARED_ROWS_H

#include "shared/types.h"

SHARED_BEGIN

SHARED_CONST uint SURFACE_ROWS = 2u; // triangle, barycentrics, 0; of two frames, each a half of the table
SHARED_CONST uint COLOR_ROWS = 1u;
SHARED_CONST uint FILM_ROWS = 2u; // sum, carry

// Of a set of `count` reservoirs (restir/reservoir_store.glsl): a row each; then f and carry, a row each, or, where a
// contribution is one number, a row of f and one of carries for all; and where mutations ask, a row of all densities.
SHARED_FUNCTION uint headRows(uint count, bool oneChannel, bool densities)
{
    return (oneChannel ? count + 2u : 2u * count) + (densities ? 1u : 0u);
}
// What a reservoir knows of its path from the reconnection vertex on.
SHARED_FUNCTION uint pathRows(bool oneChannel)
{
    return oneChannel ? 2u : 3u;
}
// Of a slot: f of each reservoir's sample in the neighbor's domain, and the neighbor in a word that is left; then,
// where mutations ask, a row of their densities there.
SHARED_FUNCTION uint slotRows(uint count, bool oneChannel, bool densities)
{
    return (oneChannel ? count / 4u + 1u : count) + (densities ? 1u : 0u);
}

SHARED_END

#endif
