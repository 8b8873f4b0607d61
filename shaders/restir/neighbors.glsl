// Which pixels lend their reservoirs. Chosen by numbers and geometry, never by what the reservoirs hold: anything else
// would bias the result.
//
// Neighbors come in pairs: in each slot two pixels choose each other or neither does, so that what one shifts to the other
// serves both. The picture is cut into tiles, anew in each frame, whose diagonal is the radius; within a tile all are mirrored
// at a random point, its edges wrapping around.
#ifndef SHADERS_RESTIR_NEIGHBORS_GLSL
#define SHADERS_RESTIR_NEIGHBORS_GLSL

const uint NEIGHBOR_ATTEMPTS = 2u;

bool mutuallyAlike(Domain a, Domain b) { return alike(a, b) && alike(b, a); }

// The pixel that this attempt pairs with `at`, of the same run and within frame.neighborRadius; NO_NEIGHBOR: there is none.
// The partner's partner is `at`.
uint partnerOf(uvec2 at, uint slot, uint attempt)
{
    uint side = 2u * uint(ceil(0.35355339 * frame.neighborRadius));
    uint stream = STREAM_NEIGHBORS + slot * NEIGHBOR_ATTEMPTS + attempt;
    uint run = at.y / frame.runHeight;
    uvec2 inRun = uvec2(at.x, at.y - run * frame.runHeight);
    uvec2 origin = decisionRandom(0xffffffffu, stream).xy % side;
    uvec2 tile = (inRun + origin) / side;
    uvec2 tiles = uvec2(frame.width, frame.runHeight) / side + 2u;
    uvec2 mirror = decisionRandom((run * tiles.y + tile.y) * tiles.x + tile.x, stream).xy % side;
    if (((mirror.x | mirror.y) & 1u) == 0u) ++mirror.x; // else four pixels would be their own partners
    uvec2 inTile = inRun + origin - tile * side;
    ivec2 p = ivec2(tile * side + (mirror + side - inTile) % side) - ivec2(origin);
    vec2 d = vec2(p - ivec2(inRun));
    bool inside = p.x >= 0 && p.y >= 0 && p.x < int(frame.width) && p.y < int(frame.runHeight);
    if (!inside || dot(d, d) > frame.neighborRadius * frame.neighborRadius) return NO_NEIGHBOR;
    return (run * frame.runHeight + uint(p.y)) * frame.width + uint(p.x);
}

// A pixel that sees a like surface and chooses this one in the same slot; NO_NEIGHBOR when the attempts find none.
uint chooseNeighbor(uvec2 at, uint slot, Domain here)
{
    uint first = partnerOf(at, slot, 0u);
    if (first != NO_NEIGHBOR && mutuallyAlike(here, makeDomain(first, false))) return first;
    uint second = partnerOf(at, slot, 1u);
    if (second == NO_NEIGHBOR) return NO_NEIGHBOR;
    Domain there = makeDomain(second, false);
    if (!mutuallyAlike(here, there)) return NO_NEIGHBOR;
    uint rival = partnerOf(uvec2(second % frame.width, second / frame.width), slot, 0u);
    bool taken = rival != NO_NEIGHBOR && mutuallyAlike(there, makeDomain(rival, false));
    return taken ? NO_NEIGHBOR : second;
}

#endif
