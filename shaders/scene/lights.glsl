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
uvec2 environmentSize() { return uvec2(scene.environmentWidth, scene.environmentHeight); }

// Column and row of texels. Polar angles are measured from the nearer pole, where rows are small.
uvec2 environmentTexel(vec3 d)
{
    uvec2 size = environmentSize();
    vec2 turns = vec2(turnsOf(d.xz), turnsOf(vec2(abs(d.y), length(d.xz))));
    uvec2 texel = min(uvec2(turns * vec2(size.x, 2u * size.y)), size - 1u);
    if (d.y < 0.0) texel.y = size.y - 1u - texel.y;
    return texel;
}

// Sampled directions keep that far, in turns, away from the edges of their texel, so that rounding takes none of them to a
// neighbor: environmentTexel(texelDirection(t, u)) is t, always. Radiance and density are thus functions of the direction alone,
// the same for whoever samples, finds or shifts it, and MIS weights sum to 1 everywhere. What is nearer to an edge moves by 5e-6
// radians at most (in a sky of one row, by 2e-3 at the nadir, once in 10^6); nothing is lost.
const float EDGE_TURNS = 4.76837158e-7; // 2^-21. Both functions' errors add up to 2^-23, or 3.2e-7 with Vulkan's roughest roots

// Uniform over a texel's solid angle: in the azimuth and in the cosine of the polar angle. In terms of sin^2 of half the angle
// to the nearer pole, since cosines near 1 have no digits left for it.
vec3 texelDirection(uvec2 texel, vec2 u)
{
    vec2 size = vec2(environmentSize());
    bool below = 2u * texel.y >= scene.environmentHeight;
    float row = float(below ? scene.environmentHeight - 1u - texel.y : texel.y); // from the nearer pole
    vec2 margin = EDGE_TURNS * vec2(size.x, 2.0 * size.y);
    u = clamp(u, row == 0.0 ? vec2(margin.x, margin.y * margin.y) : margin, 1.0 - margin); // areas at a pole are squares of angles
    float begin = unitCircle(0.25 * row / size.y).y;
    float end = unitCircle(0.25 * (row + 1.0) / size.y).y;
    float h = mix(begin * begin, end * end, u.y);
    float y = 1.0 - 2.0 * h;
    vec2 across = 2.0 * sqrt(h * (1.0 - h)) * unitCircle((float(texel.x) + u.x) / size.x);
    return vec3(across.x, below ? -y : y, across.y);
}

vec4 loadTexel(uvec2 texel)
{
    return uintBitsToFloat(FETCH(SceneData, scene.environmentOffset + texel.y * scene.environmentWidth + texel.x));
}

// Radiance in xyz; w is the probability that next-event estimation takes this texel over its solid angle (given the environment).
vec4 loadEnvironment(vec3 direction)
{
    if (!HAS_ENVIRONMENT) return vec4(0.0);
    return loadTexel(environmentTexel(direction));
}

// A texel by its probability.
uvec2 pickTexel(uvec2 bits)
{
    float rest;
    uint index = pick(bits, scene.environmentWidth * scene.environmentHeight, rest);
    uvec4 pair = FETCH(SceneData, scene.environmentAliasOffset + (index >> 1u));
    uvec2 alias = (index & 1u) == 0u ? pair.xy : pair.zw;
    if (rest >= uintBitsToFloat(alias.x)) index = alias.y;
    uint row = index / scene.environmentWidth;
    return uvec2(index - row * scene.environmentWidth, row);
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
    float rest;
    uvec4 light = FETCH(SceneData, scene.lightOffset + pick(random.xw, scene.lightCount, rest));
    if (rest >= uintBitsToFloat(light.x)) light = FETCH(SceneData, scene.lightOffset + light.y);
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
        if (squared != 0.0 && c != 0.0) { // NaN goes on
            l.pdf *= squared / (0.5 * twiceArea * abs(c));
            uint row = attributeRow(item);
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
        vec3 chord = l.direction + axis; // half its square is 1 - cos of the angle to the axis
        float x = within((head.w - 0.5 * dot(chord, chord)) * intensity.w, 0.0, 1.0);
        float spot = intensity.w > 0.0 ? x * x : 1.0;
        if (squared != 0.0) l.radiance = intensity.rgb * (spot / squared);
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
        uvec4 own = pcg4d(random); // more numbers from the same block: the texel, and the point in it
        uvec2 texel = pickTexel(own.xy);
        l.direction = texelDirection(texel, vec2(unitFloat(own.z), unitFloat(own.w)));
        vec4 environment = loadTexel(texel);
        l.radiance = environment.rgb;
        l.pdf *= environment.w;
        l.infinite = true;
    }
    return l;
}

#endif
