// How reservoirs lie in tables, RESERVOIR_COUNT a pixel, and pixel by pixel, since neighbors are read one by one. A set of
// them is two tables: heads (which path, f, S), and, for shift maps that reconnect, what is kept of the path from x_r on. The
// confidence (frames; 32 bits, so that it never wraps) is a word a pixel, since all reservoirs share it. What spatial_trace
// hands to spatial_gather lies in the same order, slot by slot. Rows are counted in shared/rows.h.
#ifndef SHADERS_RESTIR_RESERVOIR_STORE_GLSL
#define SHADERS_RESTIR_RESERVOIR_STORE_GLSL

#include "lib/frame.glsl"
#include "restir/reservoir.glsl"
#include "shared/rows.h"

// Densities are all 1 where paths are replayed whole.
const bool KEEPS_DENSITIES = MUTATION != MUTATION_OFF && SHIFT_MAP != SHIFT_REPLAY;

uint pixelCount() { return frame.width * frame.height; }
uint headRow(uint pixel, uint row) { return pixel * headRows(RESERVOIR_COUNT, ONE_CHANNEL, KEEPS_DENSITIES) + row; }
uint densityRow(uint pixel) { return headRow(pixel + 1u, 0u) - 1u; }
uint pathRow(uint pixel, uint c, uint row) { return (pixel * RESERVOIR_COUNT + c) * pathRows(ONE_CHANNEL) + row; }
uint slotRow(uint pixel, uint slot, uint row)
{
    return (pixel * frame.neighborCount + slot) * slotRows(RESERVOIR_COUNT, ONE_CHANNEL, KEEPS_DENSITIES) + row;
}
uint slotDensityRow(uint pixel, uint slot) { return slotRow(pixel, slot + 1u, 0u) - 1u; }

// ONE_CHANNEL: each target is one channel alone. Nobody asks for the others of what a reservoir holds, and they are not kept.
float onlyChannel(uint c, vec3 v)
{
    vec3 target = frame.target[c].xyz;
    return target.x > 0.0 ? v.x : target.y > 0.0 ? v.y : v.z;
}
vec3 inChannel(uint c, float x)
{
    bvec3 own = greaterThan(frame.target[c].xyz, vec3(0.0));
    return vec3(own.x ? x : 0.0, own.y ? x : 0.0, own.z ? x : 0.0);
}

// LOAD_RESERVOIRS defines, over a set's two tables: load<SET>Head and load<SET>Path, one reservoir without and its path;
// load<SET>, all of a pixel's. STORE_RESERVOIRS: store<SET>. Arrays have MAX_RESERVOIRS elements, of which RESERVOIR_COUNT are
// used (lib/lanes.glsl).
#define LOAD_RESERVOIRS(SET, HEADS, PATHS)                                                                             \
    Reservoir load##SET##Head(uint pixel, uint c)                                                                      \
    {                                                                                                                  \
        Reservoir r = EMPTY;                                                                                           \
        uvec4 a = FETCH(HEADS, headRow(pixel, c));                                                                     \
        r.chosen.seed = PathSeed(a.x, a.y);                                                                            \
        r.chosen.pathId = a.z & 0xffffu;                                                                               \
        r.chosen.reconnectionIndex = a.z >> 16u;                                                                       \
        r.weightSum = uintBitsToFloat(a.w);                                                                            \
        if (KEEPS_DENSITIES) r.chosen.density = uintBitsToFloat(FETCH(HEADS, densityRow(pixel))[c]);                   \
        if (ONE_CHANNEL) {                                                                                             \
            r.f = inChannel(c, uintBitsToFloat(FETCH(HEADS, headRow(pixel, RESERVOIR_COUNT))[c]));                     \
            r.carry = uintBitsToFloat(FETCH(HEADS, headRow(pixel, RESERVOIR_COUNT + 1u))[c]);                          \
        } else {                                                                                                       \
            vec4 b = uintBitsToFloat(FETCH(HEADS, headRow(pixel, RESERVOIR_COUNT + c)));                               \
            r.f = b.xyz;                                                                                               \
            r.carry = b.w;                                                                                             \
        }                                                                                                              \
        return r;                                                                                                      \
    }                                                                                                                  \
    Reconnection load##SET##Path(uint pixel, uint c)                                                                   \
    {                                                                                                                  \
        if (SHIFT_MAP == SHIFT_REPLAY) return NO_SAMPLE.reconnection;                                                  \
        uvec4 vertex = FETCH(PATHS, pathRow(pixel, c, 0u));                                                            \
        vec4 onward = uintBitsToFloat(FETCH(PATHS, pathRow(pixel, c, 1u)));                                            \
        vec3 suffix;                                                                                                   \
        if (ONE_CHANNEL) suffix = inChannel(c, onward.w);                                                              \
        else suffix = uintBitsToFloat(FETCH(PATHS, pathRow(pixel, c, 2u)).xyz);                                        \
        return Reconnection(vertex.x, uintBitsToFloat(vertex.yz), uintBitsToFloat(vertex.w), onward.xyz, suffix);      \
    }                                                                                                                  \
    void load##SET(uint pixel, out Reservoir r[MAX_RESERVOIRS])                                                        \
    {                                                                                                                  \
        for (uint c = 0u; c < RESERVOIR_COUNT; ++c) {                                                                  \
            r[c] = load##SET##Head(pixel, c);                                                                          \
            r[c].chosen.reconnection = load##SET##Path(pixel, c);                                                      \
        }                                                                                                              \
    }

#define STORE_RESERVOIRS(SET, HEADS, PATHS)                                                                            \
    void store##SET(uint pixel, Reservoir r[MAX_RESERVOIRS])                                                           \
    {                                                                                                                  \
        vec4 f = vec4(0.0);                                                                                            \
        vec4 carry = vec4(0.0);                                                                                        \
        vec4 densities = vec4(0.0);                                                                                    \
        for (uint c = 0u; c < RESERVOIR_COUNT; ++c) {                                                                  \
            PathSample y = r[c].chosen;                                                                                \
            STORE(HEADS, headRow(pixel, c),                                                                            \
                  uvec4(y.seed.frame, y.seed.pixel, y.pathId | y.reconnectionIndex << 16u,                             \
                        floatBitsToUint(r[c].weightSum)));                                                             \
            f[c] = onlyChannel(c, r[c].f);                                                                             \
            carry[c] = r[c].carry;                                                                                     \
            densities[c] = y.density;                                                                                  \
            if (!ONE_CHANNEL)                                                                                          \
                STORE(HEADS, headRow(pixel, RESERVOIR_COUNT + c), floatBitsToUint(vec4(r[c].f, r[c].carry)));          \
            if (SHIFT_MAP == SHIFT_REPLAY) continue;                                                                   \
            Reconnection k = y.reconnection;                                                                           \
            STORE(PATHS, pathRow(pixel, c, 0u),                                                                        \
                  uvec4(k.triangle, floatBitsToUint(k.barycentric), floatBitsToUint(k.lightPdf)));                     \
            STORE(PATHS, pathRow(pixel, c, 1u), floatBitsToUint(vec4(k.direction, onlyChannel(c, k.suffix))));         \
            if (!ONE_CHANNEL) STORE(PATHS, pathRow(pixel, c, 2u), uvec4(floatBitsToUint(k.suffix), 0u));               \
        }                                                                                                              \
        if (ONE_CHANNEL) {                                                                                             \
            STORE(HEADS, headRow(pixel, RESERVOIR_COUNT), floatBitsToUint(f));                                         \
            STORE(HEADS, headRow(pixel, RESERVOIR_COUNT + 1u), floatBitsToUint(carry));                                \
        }                                                                                                              \
        if (KEEPS_DENSITIES) {                                                                                         \
            STORE(HEADS, densityRow(pixel), floatBitsToUint(densities));                                               \
        }                                                                                                              \
    }

// Of a slot: which neighbor the pixel picked, and f and densities of the pixel's samples in the neighbor's domain. Without a
// neighbor only that is stored.
#define LOAD_SHIFTED(TABLE_NAME)                                                                                       \
    uint neighborIn(uint pixel, uint slot)                                                                             \
    {                                                                                                                  \
        uint word = ONE_CHANNEL ? RESERVOIR_COUNT : 3u;                                                                \
        return FETCH(TABLE_NAME, slotRow(pixel, slot, word / 4u))[word % 4u];                                          \
    }                                                                                                                  \
    vec3 shiftedFrom(uint pixel, uint slot, uint c)                                                                    \
    {                                                                                                                  \
        if (ONE_CHANNEL) return inChannel(c, uintBitsToFloat(FETCH(TABLE_NAME, slotRow(pixel, slot, 0u))[c]));         \
        return uintBitsToFloat(FETCH(TABLE_NAME, slotRow(pixel, slot, c)).xyz);                                        \
    }                                                                                                                  \
    float densityFrom(uint pixel, uint slot, uint c)                                                                   \
    {                                                                                                                  \
        if (!KEEPS_DENSITIES) return 1.0;                                                                              \
        return uintBitsToFloat(FETCH(TABLE_NAME, slotDensityRow(pixel, slot))[c]);                                     \
    }

#define STORE_SHIFTED(TABLE_NAME)                                                                                      \
    void storeShifted(uint pixel, uint slot, uint neighbor, vec3 f[MAX_RESERVOIRS], vec4 densities)                    \
    {                                                                                                                  \
        if (KEEPS_DENSITIES) {                                                                                         \
            STORE(TABLE_NAME, slotDensityRow(pixel, slot), floatBitsToUint(densities));                                \
        }                                                                                                              \
        if (ONE_CHANNEL) {                                                                                             \
            uvec4 row = uvec4(neighbor);                                                                               \
            for (uint c = 0u; c < RESERVOIR_COUNT; ++c) row[c] = floatBitsToUint(onlyChannel(c, f[c]));                \
            STORE(TABLE_NAME, slotRow(pixel, slot, 0u), row);                                                          \
            if (RESERVOIR_COUNT == 4u) STORE(TABLE_NAME, slotRow(pixel, slot, 1u), uvec4(neighbor));                   \
        } else {                                                                                                       \
            for (uint c = 0u; c < RESERVOIR_COUNT; ++c)                                                                \
                STORE(TABLE_NAME, slotRow(pixel, slot, c), uvec4(floatBitsToUint(f[c]), neighbor));                    \
        }                                                                                                              \
    }

// How often do the reservoirs of a pixel agree? What they share is shifted once.
void countTrees(Reservoir r[MAX_RESERVOIRS])
{
    if (RESERVOIR_COUNT == 1u) return;
    bool held = true;
    uint trees = 0u;
    for (uint c = 0u; c < RESERVOIR_COUNT; ++c) {
        held = held && r[c].weightSum > 0.0;
        bool isNew = true;
        for (uint before = 0u; before < c; ++before) isNew = isNew && r[before].chosen.seed != r[c].chosen.seed;
        trees += isNew ? 1u : 0u;
    }
    addToCounter(COUNTER_HELD, held ? 1u : 0u);
    addToCounter(COUNTER_TREES, held ? trees : 0u);
}

#endif
