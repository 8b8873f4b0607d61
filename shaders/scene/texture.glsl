// Material textures: texels in 2x2 blocks, RGBA8 of one uvec4, RGBA16 of two (a row of the block each), fetched and filtered here (no images, no bindless).
#ifndef SHADERS_SCENE_TEXTURE_GLSL
#define SHADERS_SCENE_TEXTURE_GLSL

#include "lib/srgb.glsl"
#include "scene/bindings.glsl"

int wrapTexel(int i, int size, uint mode)
{
    if (mode == 1u) return clamp(i, 0, size - 1);  // scene::Wrap::Clamp
    int period = mode == 2u ? 2 * size : size;     // Mirror, Repeat
    int j = i - period * int(floor(float(i) / float(period)));
    j = j < 0 ? j + period : (j >= period ? j - period : j); // the division may round across a border
    return j < size ? j : 2 * size - 1 - j;
}

vec4 fetchTexel(uint firstBlock, int width, ivec2 p, uint flags)
{
    uint block = uint((p.y >> 1) * ((width + 1) >> 1) + (p.x >> 1));
    bool right = (p.x & 1) != 0;
    vec4 texel;
    if (HAS_DEEP_TEXTURE && (flags & TEXTURE_DEEP) != 0u) {
        uvec4 row = FETCH(Texels, firstBlock + 2u * block + uint(p.y & 1));
        uvec2 pair = right ? row.zw : row.xy;
        texel = vec4(unpackUnorm2x16(pair.x), unpackUnorm2x16(pair.y));
    } else {
        uvec4 quad = FETCH(Texels, firstBlock + block);
        uvec2 pair = (p.y & 1) == 0 ? quad.xy : quad.zw;
        texel = unpackUnorm4x8(right ? pair.y : pair.x);
    }
    bool srgb = (flags & TEXTURE_SRGB) != 0u;
    return srgb ? vec4(linearFromSrgb(texel.rgb), texel.a) : texel;
}

// The texture that row `use` of SceneData describes, at a surface point's coordinates; white when there is none.
vec4 sampleTexture(uint use, vec2 uv0, vec2 uv1)
{
    uvec4 head = FETCH(SceneData, use);
    if (head.x == NO_INDEX) return vec4(1.0);
    vec2 uv = HAS_SECOND_UV && (head.z & TEXTURE_SECOND_UV) != 0u ? uv1 : uv0;
    if (HAS_TEXTURE_TRANSFORM) {
        vec3 row0 = uintBitsToFloat(FETCH(SceneData, use + 1u).xyz);
        vec3 row1 = uintBitsToFloat(FETCH(SceneData, use + 2u).xyz);
        uv = vec2(dot(row0, vec3(uv, 1.0)), dot(row1, vec3(uv, 1.0)));
    }
    ivec2 size = ivec2(head.y & 0xffffu, head.y >> 16u);
    uint wrapU = (head.z >> TEXTURE_WRAP_U_SHIFT) & 3u;
    uint wrapV = (head.z >> TEXTURE_WRAP_V_SHIFT) & 3u;
    bool nearest = (head.z & TEXTURE_NEAREST) != 0u;

    // Whole double tiles first (a mirrored texture repeats after two), so that large coordinates keep their fraction.
    vec2 tile = uv - 2.0 * floor(0.5 * uv);
    if (wrapU == 1u) tile.x = within(uv.x, -1.0, 2.0);
    if (wrapV == 1u) tile.y = within(uv.y, -1.0, 2.0);
    vec2 p = tile * vec2(size) - (nearest ? 0.0 : 0.5);
    vec2 corner = floor(p);
    vec2 f = nearest ? vec2(0.0) : p - corner;
    int x0 = wrapTexel(int(corner.x), size.x, wrapU);
    int y0 = wrapTexel(int(corner.y), size.y, wrapV);
    int x1 = wrapTexel(int(corner.x) + 1, size.x, wrapU);
    int y1 = wrapTexel(int(corner.y) + 1, size.y, wrapV);
    vec4 t00 = fetchTexel(head.x, size.x, ivec2(x0, y0), head.z);
    vec4 t10 = fetchTexel(head.x, size.x, ivec2(x1, y0), head.z);
    vec4 t01 = fetchTexel(head.x, size.x, ivec2(x0, y1), head.z);
    vec4 t11 = fetchTexel(head.x, size.x, ivec2(x1, y1), head.z);
    return mix(mix(t00, t10, f.x), mix(t01, t11, f.x), f.y);
}

#endif
