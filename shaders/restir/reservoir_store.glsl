// A set of reservoirs in two buffers, RESERVOIR_COUNT a pixel, and pixel by pixel, since neighbors are read one by one. The words
// of every reservoir: seed, leaf and joint, S | f, carry; after them one word a pixel, the confidence, which all reservoirs
// of a pixel share (frames; 32 bits, so that it never wraps). The paths of reconnecting shift maps: 3 rows a reservoir, left out
// when paths are replayed. What spatial_trace hands to spatial_gather lies in the same order, slot by slot.
#ifndef SHADERS_RESTIR_RESERVOIR_STORE_GLSL
#define SHADERS_RESTIR_RESERVOIR_STORE_GLSL

#include "lib/frame.glsl"
#include "lib/table.glsl"
#include "restir/reservoir.glsl"

const uint WORD_ROWS = 2u;
const uint PATH_ROWS = 3u;

uint pixelCount() { return frame.width * frame.height; }
uint wordRow(uint pixel, uint c, uint row) { return (pixel * RESERVOIR_COUNT + c) * WORD_ROWS + row; }
uint pathRow(uint pixel, uint c, uint row) { return (pixel * RESERVOIR_COUNT + c) * PATH_ROWS + row; }
uint slotRow(uint pixel, uint slot) { return pixel * frame.neighborCount + slot; }
uint shiftedRow(uint pixel, uint slot, uint c) { return slotRow(pixel, slot) * RESERVOIR_COUNT + c; }
uint confidenceRow(uint pixel) { return WORD_ROWS * RESERVOIR_COUNT * pixelCount() + (pixel >> 2u); }

#define ELEMENT(BUFFER, INDEX) BUFFER[INDEX]

// LOAD_RESERVOIRS defines, over what READ(WORDS, row) and READ(PATHS, row) read (FETCH: tables; ELEMENT: buffers): load<SET>Head and load<SET>Path, one reservoir without and its
// path; load<SET>, all of a pixel's; load<SET>Confidence. STORE_RESERVOIRS: store<SET> and store<SET>Confidence. Arrays have
// MAX_RESERVOIRS elements, of which RESERVOIR_COUNT are used: glslang 12 can neither copy nor initialize arrays sized by a
// specialisation constant.
#define LOAD_RESERVOIRS(SET, READ, WORDS, PATHS)                                                                       \
    Reservoir load##SET##Head(uint pixel, uint c)                                                                      \
    {                                                                                                                  \
        Reservoir r = EMPTY;                                                                                           \
        uvec4 a = READ(WORDS, wordRow(pixel, c, 0u));                                                                  \
        uvec4 b = READ(WORDS, wordRow(pixel, c, 1u));                                                                  \
        r.chosen.seed = PathSeed(a.x, a.y);                                                                            \
        r.chosen.leaf = a.z & 0xffffu;                                                                                 \
        r.chosen.joint = a.z >> 16u;                                                                                   \
        r.weightSum = uintBitsToFloat(a.w);                                                                            \
        r.f = uintBitsToFloat(b.xyz);                                                                                  \
        r.carry = uintBitsToFloat(b.w);                                                                                \
        return r;                                                                                                      \
    }                                                                                                                  \
    Reconnection load##SET##Path(uint pixel, uint c)                                                                   \
    {                                                                                                                  \
        if (SHIFT_MAP == SHIFT_REPLAY) return NO_SAMPLE.reconnection;                                                  \
        uvec4 vertex = READ(PATHS, pathRow(pixel, c, 0u));                                                             \
        return Reconnection(vertex.x, uintBitsToFloat(vertex.yz), uintBitsToFloat(vertex.w),                           \
                            uintBitsToFloat(READ(PATHS, pathRow(pixel, c, 2u)).xyz),                                   \
                            uintBitsToFloat(READ(PATHS, pathRow(pixel, c, 1u)).xyz));                                  \
    }                                                                                                                  \
    void load##SET(uint pixel, out Reservoir r[MAX_RESERVOIRS])                                                        \
    {                                                                                                                  \
        for (uint c = 0u; c < RESERVOIR_COUNT; ++c) {                                                                  \
            r[c] = load##SET##Head(pixel, c);                                                                          \
            r[c].chosen.reconnection = load##SET##Path(pixel, c);                                                      \
        }                                                                                                              \
    }                                                                                                                  \
    uint load##SET##Confidence(uint pixel) { return READ(WORDS, confidenceRow(pixel))[pixel & 3u]; }

#define STORE_RESERVOIRS(SET, WORDS, PATHS)                                                                            \
    void store##SET(uint pixel, Reservoir r[MAX_RESERVOIRS])                                                           \
    {                                                                                                                  \
        for (uint c = 0u; c < RESERVOIR_COUNT; ++c) {                                                                  \
            PathSample y = r[c].chosen;                                                                                \
            WORDS[wordRow(pixel, c, 0u)] =                                                                             \
                uvec4(y.seed.frame, y.seed.pixel, y.leaf | y.joint << 16u, floatBitsToUint(r[c].weightSum));           \
            WORDS[wordRow(pixel, c, 1u)] = uvec4(floatBitsToUint(r[c].f), floatBitsToUint(r[c].carry));                \
            if (SHIFT_MAP != SHIFT_REPLAY) {                                                                           \
                Reconnection k = y.reconnection;                                                                       \
                PATHS[pathRow(pixel, c, 0u)] =                                                                         \
                    uvec4(k.triangle, floatBitsToUint(k.barycentric), floatBitsToUint(k.lightPdf));                    \
                PATHS[pathRow(pixel, c, 1u)] = uvec4(floatBitsToUint(k.suffix), 0u);                                   \
                PATHS[pathRow(pixel, c, 2u)] = uvec4(floatBitsToUint(k.direction), 0u);                                \
            }                                                                                                          \
        }                                                                                                              \
    }                                                                                                                  \
    void store##SET##Confidence(uint pixel, uint confidence) { WORDS[confidenceRow(pixel)][pixel & 3u] = confidence; }

#endif
