// Counter-based random numbers: a pure function of (frame, pixel, block, key), so that any number of any path can be had again.
// pcg4d: Jarzynski and Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020.
#ifndef SHADERS_LIB_RANDOM_GLSL
#define SHADERS_LIB_RANDOM_GLSL

uvec4 pcg4d(uvec4 v)
{
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v ^= v >> 16u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

// Seed of a path: the frame and pixel where it was first traced.
struct PathSeed {
    uint frame;
    uint pixel; // y * width + x
};

uvec4 randomBlock(PathSeed seed, uint block, uvec2 key) { return pcg4d(uvec4(seed.frame ^ key.y, seed.pixel, block, key.x)); }

// [0, 1), never 1: 24 bits.
float unitFloat(uint bits) { return float(bits >> 8u) * 5.9604644775390625e-8; }

// [0, 1) with 24 significant bits however small: for decisions of small probability. (The largest 129 values round to 1:
// they are one step below it.)
float decisionFloat(uint bits) { return min(float(bits) * 2.3283064365386963e-10, 0.99999994); }

// An index below `count`, and what is left over, uniform in [0, 1]: whole part and fraction of count times a number in [0, 1) of
// 64 bits. With 32 the indices of a million had probabilities that differ by 2e-4, and those of 2^25 by 0.8%.
uint pick(uvec2 bits, uint count, out float rest)
{
    uint whole, fraction, carried, low, carry;
    umulExtended(bits.x, count, whole, fraction);
    umulExtended(bits.y, count, carried, low);
    fraction = uaddCarry(fraction, carried, carry);
    rest = float(fraction) * 2.3283064365386963e-10 + float(low) * 5.421010862427522e-20;
    return whole + carry;
}

#endif
