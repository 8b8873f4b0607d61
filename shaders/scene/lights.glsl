// Next-event estimation: one light by power (alias table), one point on it; and the densities of doing so.
#ifndef SHADERS_SCENE_LIGHTS_GLSL
#define SHADERS_SCENE_LIGHTS_GLSL

#include "lib/sampling.glsl"
#include "scene/surface.glsl"

const float SMALLEST_SQUARE = 1.17549435e-38; // of a distance: a light at distance 0 has direction 0 and gives nothing

struct LightSample {
    vec3 direction; // world, unit, from the shaded point
    vec3 target;    // light point; `normal` is its surface normal towards the shaded point
    vec3 normal;
    float offset;   // of the end of a ray to there
    vec3 radiance;  // Le, or for Dirac lights I / d^2, or E; 0 when there is nothing to trace
    float pdf;      // solid angle; pick probability for Dirac lights
    bool dirac;
    bool infinite;  // directional or environment: no target
};

// ---------------------------------------------------------------------------------------------------------- environment
uvec2 environmentTexel(vec3 d)
{
    float phi = atan(d.z, d.x);
    float u = phi / (2.0 * PI);
    u -= floor(u);
    float v = acos(clamp(d.y, -1.0, 1.0)) / PI;
    uvec2 size = uvec2(scene.environmentWidth, scene.environmentHeight);
    return min(uvec2(vec2(u, v) * vec2(size)), size - 1u);
}

// Radiance in xyz; w is the probability that next-event estimation takes this texel over its solid angle (given the environment).
vec4 loadEnvironment(vec3 direction)
{
    if (!HAS_ENVIRONMENT) return vec4(0.0);
    uvec2 texel = environmentTexel(direction);
    return uintBitsToFloat(FETCH(SceneData, scene.environmentOffset + texel.y * scene.environmentWidth + texel.x));
}

vec3 sampleEnvironment(uint pickBits, uint aliasBits, vec2 u)
{
    uint index;
    uint unused;
    umulExtended(pickBits, scene.environmentWidth * scene.environmentHeight, index, unused);
    uvec4 pair = FETCH(SceneData, scene.environmentAliasOffset + (index >> 1u));
    uvec2 alias = (index & 1u) == 0u ? pair.xy : pair.zw;
    if (float(aliasBits) * 2.3283064365386963e-10 >= uintBitsToFloat(alias.x)) index = alias.y;
    uint y = index / scene.environmentWidth;
    uint x = index - y * scene.environmentWidth;
    // Uniform over the texel's solid angle: uniform in phi and in cos theta between the row's edges.
    float phi = 2.0 * PI * (float(x) + u.x) / float(scene.environmentWidth);
    float top = cos(PI * float(y) / float(scene.environmentHeight));
    float bottom = cos(PI * float(y + 1u) / float(scene.environmentHeight));
    float c = mix(top, bottom, u.y);
    float s = sqrt(max(1.0 - c * c, 0.0));
    return normalize(vec3(s * cos(phi), c, s * sin(phi))); // drivers' sin and cos are off by up to 2^-11
}

// --------------------------------------------------------------------------------------------------------------- all lights
// Density, over solid angle at `from`, of sampling the emissive triangle of surface s in direction wi.
float lightPdf(Surface s, vec3 from, vec3 wi)
{
    if (!HAS_EMISSIVE || s.light == NO_INDEX) return 0.0;
    float pick = uintBitsToFloat(FETCH(SceneData, scene.lightOffset + s.light).z);
    vec3 d = s.position - from;
    float c = abs(dot(s.geometricNormal, wi));
    return pick * dot(d, d) / (s.area * c);
}

float environmentPdf(vec4 environment) { return scene.environmentPick * environment.w; }

// As seen from surface s.
LightSample sampleLight(uvec4 random, Surface s)
{
    LightSample l = LightSample(vec3(0.0, 0.0, 1.0), vec3(0.0), vec3(0.0), 0.0, vec3(0.0), 1.0, false, false);
    if (scene.lightCount == 0u) return l;
    uint index;
    uint remainder;
    umulExtended(random.x, scene.lightCount, index, remainder);
    uvec4 light = FETCH(SceneData, scene.lightOffset + index);
    // The alias decision has bits of its own: what the pick leaves over is too coarse for 10^5 lights.
    if (float(random.w) * 2.3283064365386963e-10 >= uintBitsToFloat(light.x)) light = FETCH(SceneData, scene.lightOffset + light.y);
    l.pdf = uintBitsToFloat(light.z);
    uint kind = light.w & 3u;
    uint item = light.w >> 2u;
    vec2 u = vec2(unitFloat(random.y), unitFloat(random.z));

    if (HAS_EMISSIVE && kind == LIGHT_TRIANGLE) {
        vec2 barycentric = sampleTriangle(u);
        TriangleGeometry g = loadTriangle(item);
        l.target = baryMix(g.p0, g.p1, g.p2, barycentric);
        l.offset = offsetOf(g, barycentric);
        vec3 d = l.target - departure(s, l.target - s.position);
        float squared = dot(d, d);
        float twiceArea = length(g.areaNormal);
        l.direction = d * inversesqrt(max(squared, SMALLEST_SQUARE));
        float c = dot(g.areaNormal, l.direction) / twiceArea;
        bool front = c < 0.0;
        l.normal = (front ? g.areaNormal : -g.areaNormal) / twiceArea;
        if (squared > 0.0 && c != 0.0) {
            l.pdf *= squared / (0.5 * twiceArea * abs(c));
            uint row = item * scene.attributeRows;
            uint material = materialRow(g.material);
            Coordinates at = loadCoordinates(row, barycentric);
            l.radiance = loadEmission(material, at, front, vec3(0.0)) * loadCoverage(material, row, barycentric, at);
        }
    }
    if (HAS_PUNCTUAL && kind == LIGHT_PUNCTUAL) {
        uint row = scene.punctualOffset + item * PUNCTUAL_ROWS;
        vec4 head = uintBitsToFloat(FETCH(SceneData, row));
        vec4 intensity = uintBitsToFloat(FETCH(SceneData, row + 1u));
        vec3 axis = uintBitsToFloat(FETCH(SceneData, row + 2u).xyz);
        l.target = head.xyz;
        vec3 d = l.target - departure(s, l.target - s.position);
        float squared = dot(d, d);
        l.direction = d * inversesqrt(max(squared, SMALLEST_SQUARE));
        float x = clamp((dot(-l.direction, axis) - head.w) * intensity.w, 0.0, 1.0);
        float spot = intensity.w > 0.0 ? x * x : 1.0;
        if (squared > 0.0) l.radiance = intensity.rgb * (spot / squared);
        l.dirac = true;
    }
    if (HAS_DIRECTIONAL && kind == LIGHT_DIRECTIONAL) {
        uint row = scene.punctualOffset + item * PUNCTUAL_ROWS;
        l.radiance = uintBitsToFloat(FETCH(SceneData, row + 1u).xyz);
        l.direction = -uintBitsToFloat(FETCH(SceneData, row + 2u).xyz);
        l.dirac = true;
        l.infinite = true;
    }
    if (HAS_ENVIRONMENT && kind == LIGHT_ENVIRONMENT) {
        uvec4 own = pcg4d(random); // more numbers from the same block: texel, alias, and the point in the texel
        l.direction = sampleEnvironment(own.x, own.y, vec2(unitFloat(own.z), unitFloat(own.w)));
        vec4 environment = loadEnvironment(l.direction);
        l.radiance = environment.rgb;
        l.pdf *= environment.w;
        l.infinite = true;
    }
    return l;
}

#endif
