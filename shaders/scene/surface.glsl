// Surface points: from a stored hit (triangle, barycentrics) to everything shading needs. Pure functions of the hit, so that
// every stage that loads the same hit computes the same bits.
#ifndef SHADERS_SCENE_SURFACE_GLSL
#define SHADERS_SCENE_SURFACE_GLSL

#include "lib/basis.glsl"
#include "lib/offset.glsl"
#include "scene/texture.glsl"

const bool HAS_TEXTURES = HAS_BASE_COLOR_TEXTURE || HAS_METALLIC_ROUGHNESS_TEXTURE || HAS_NORMAL_MAP || HAS_EMISSIVE_TEXTURE ||
                          HAS_TRANSMISSION_TEXTURE || HAS_SPECULAR_TEXTURE;

vec3 baryMix(vec3 a, vec3 b, vec3 c, vec2 uv)
{
    precise vec3 mixed = (1.0 - uv.x - uv.y) * a + uv.x * b + uv.y * c;
    return mixed;
}

// ------------------------------------------------------------------------------------------------------------- geometry
struct TriangleGeometry {
    vec3 p0;
    vec3 p1;
    vec3 p2;
    uint material;   // index
    uint light;      // index, or NO_INDEX
    vec3 areaNormal; // cross product of the edges: length is twice the area, direction is the front
    float clearance; // least barycentric weight of a point that paths scatter at
    vec3 size;       // the largest that coordinates are, by axis
};

// Where a triangle lies of a mesh that is stored once.
struct Place {
    mat3 linear; // from mesh to world
    vec3 origin; // of the mesh, in the world
    vec3 size;   // as TriangleGeometry has it, of all of the mesh
    float side;  // -1: it mirrors
};

bool isPlaced(uint triangle) { return HAS_INSTANCES && triangle >= scene.flatTriangles; }

uint instanceRow(uint triangle)
{
    return scene.instanceOffset + INSTANCE_ROWS * ((triangle - scene.flatTriangles) >> scene.triangleBits);
}

Place loadPlace(uint triangle)
{
    uint row = instanceRow(triangle);
    vec4 x = uintBitsToFloat(FETCH(SceneData, row));
    vec4 y = uintBitsToFloat(FETCH(SceneData, row + 1u));
    vec4 z = uintBitsToFloat(FETCH(SceneData, row + 2u));
    uvec4 last = FETCH(SceneData, row + 3u);
    Place place;
    place.linear = transpose(mat3(x.xyz, y.xyz, z.xyz));
    place.origin = vec3(x.w, y.w, z.w);
    place.size = uintBitsToFloat(last.yzw);
    place.side = (last.x & INSTANCE_MIRRORS) != 0u ? -1.0 : 1.0;
    return place;
}

// The same for equal points, whichever triangle has them.
vec3 inWorld(Place place, vec3 point)
{
    precise vec3 p = place.linear[0] * point.x + place.linear[1] * point.y + place.linear[2] * point.z + place.origin;
    return p;
}

vec3 normalInWorld(Place place, vec3 normal)
{
    mat3 m = place.linear;
    mat3 cofactors = mat3(cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1]));
    return normalize(place.side * (cofactors * normal));
}

uint attributeRow(uint triangle)
{
    uint row = (TWO_WORLDS ? scene.attributeOffset : 0u) + triangle * scene.attributeRows;
    if (!isPlaced(triangle)) return row;
    uint first = FETCH(SceneData, instanceRow(triangle) + 3u).x & ~INSTANCE_MIRRORS;
    return first + ((triangle - scene.flatTriangles) & ((1u << scene.triangleBits) - 1u)) * scene.attributeRows;
}

// As scene::packAttributes() has it, for triangles that are not in the world when it packs them.
float clearanceOf(TriangleGeometry g)
{
    const float PART = 1.9073486328125e-6; // 2^-19
    float longest = max(max(distance(g.p0, g.p1), distance(g.p1, g.p2)), distance(g.p2, g.p0));
    float weight = PART * maxComponent(g.size) * longest / length(g.areaNormal);
    return weight < 1.0 / 3.0 ? weight : 1.0 / 3.0;
}

TriangleGeometry loadTriangle(uint triangle)
{
    uint row = attributeRow(triangle);
    uvec4 a = FETCH(Attributes, row);
    uvec4 b = FETCH(Attributes, row + 1u);
    uvec4 c = FETCH(Attributes, row + 2u);
    TriangleGeometry g;
    g.p0 = uintBitsToFloat(a.xyz);
    g.p1 = uintBitsToFloat(b.xyz);
    g.p2 = uintBitsToFloat(c.xyz);
    g.material = a.w;
    g.light = b.w;
    g.clearance = uintBitsToFloat(c.w);
    if (!isPlaced(triangle)) {
        precise vec3 n = cross(g.p1 - g.p0, g.p2 - g.p0);
        g.areaNormal = n;
        g.size = max(abs(g.p0), max(abs(g.p1), abs(g.p2)));
        return g;
    }
    Place place = loadPlace(triangle);
    g.p0 = inWorld(place, g.p0);
    g.p1 = inWorld(place, g.p1);
    g.p2 = inWorld(place, g.p2);
    precise vec3 n = place.side * cross(g.p1 - g.p0, g.p2 - g.p0);
    g.areaNormal = n;
    g.size = place.size;
    g.clearance = clearanceOf(g);
    return g;
}

float leastWeight(vec2 barycentric) { return min(min(barycentric.x, barycentric.y), 1.0 - barycentric.x - barycentric.y); }

// Of the least weight that keeps clear of the edges: as near to one rounding can tell neither side of it from the other.
const float EDGE_WEIGHT = 1.0 / 8.0;

// Where paths scatter that hit a triangle there: the same point, but that it keeps clear of the edges. On an edge it would lie
// on two surfaces, and be moved off one of them only (offsetOrigin): in the corner of a room the next ray could begin outside.
vec3 pointOn(TriangleGeometry g, vec2 barycentric)
{
    vec3 weights = vec3(1.0 - barycentric.x - barycentric.y, barycentric);
    if (leastWeight(barycentric) < g.clearance) {
        weights = max(weights, vec3(g.clearance));
        weights /= weights.x + weights.y + weights.z;
    }
    return baryMix(g.p0, g.p1, g.p2, weights.yz);
}

vec3 hitPosition(uint triangle, vec2 barycentric) { return pointOn(loadTriangle(triangle), barycentric); }

float largestCoordinate(TriangleGeometry g) { return maxComponent(g.size); }

// How far from its plane rays begin that leave the triangle there. Near its edges they must pass clear of what lies beyond,
// too, which is known as exactly as the largest coordinate.
float offsetOf(TriangleGeometry g, vec2 barycentric)
{
    bool nearEdge = leastWeight(barycentric) < 2.0 * g.clearance;
    return nearEdge ? originOffset(vec3(1.0, 0.0, 0.0), vec3(largestCoordinate(g))) : originOffset(normalize(g.areaNormal), g.size);
}

// ------------------------------------------------------------------------------------------------------ what lies on it
// A variant with everything compiled in also reads scenes whose records lack the rows.
struct Coordinates {
    vec2 uv0;
    vec2 uv1;
    uvec2 tangents; // of vertices 0 and 1, octahedral; the lowest bit is the handedness
};

Coordinates loadCoordinates(uint row, vec2 barycentric)
{
    Coordinates c = Coordinates(vec2(0.0), vec2(0.0), uvec2(0u));
    vec3 weights = vec3(1.0 - barycentric.x - barycentric.y, barycentric);
    if (HAS_TEXTURES) {
        vec4 ab = uintBitsToFloat(FETCH(Attributes, row + 4u));
        uvec4 last = FETCH(Attributes, row + 5u);
        c.uv0 = weights.x * ab.xy + weights.y * ab.zw + weights.z * uintBitsToFloat(last.xy);
        c.tangents = last.zw;
    }
    if (HAS_TEXTURES && HAS_SECOND_UV) {
        vec4 ab = uintBitsToFloat(FETCH(Attributes, row + 6u));
        vec2 uvC = uintBitsToFloat(FETCH(Attributes, row + 7u).xy);
        c.uv1 = weights.x * ab.xy + weights.y * ab.zw + weights.z * uvC;
    }
    return c;
}

vec4 loadVertexColor(uint row, vec2 barycentric)
{
    if (!HAS_VERTEX_COLORS) return vec4(1.0);
    uvec2 a = FETCH(Attributes, row + 7u).zw;
    uvec4 bc = FETCH(Attributes, row + 8u);
    vec4 colorA = vec4(unpackHalf2x16(a.x), unpackHalf2x16(a.y));
    vec4 colorB = vec4(unpackHalf2x16(bc.x), unpackHalf2x16(bc.y));
    vec4 colorC = vec4(unpackHalf2x16(bc.z), unpackHalf2x16(bc.w));
    return colorA + barycentric.x * (colorB - colorA) + barycentric.y * (colorC - colorA); // one color stays exactly that
}

uint materialRow(uint material) { return scene.materialOffset + (HAS_MANY_MATERIALS ? material * MATERIAL_ROWS : 0u); }

uint textureRow(uint material, uint texture) { return material + MATERIAL_HEAD_ROWS + texture * TEXTURE_ROWS; }

// b of the model: base color * texture * vertex color, with alpha. `material` and `row` are rows.
vec4 loadBaseColor(uint material, uint row, vec2 barycentric, Coordinates at)
{
    vec4 color = uintBitsToFloat(FETCH(SceneData, material)) * loadVertexColor(row, barycentric);
    if (HAS_BASE_COLOR_TEXTURE) color *= sampleTexture(textureRow(material, TEXTURE_BASE_COLOR), at.uv0, at.uv1);
    return color;
}

// Radiance emitted to the side that `front` says.
vec3 loadEmission(uint material, Coordinates at, bool front, vec3 baseColor)
{
    uvec4 words = FETCH(SceneData, material + 1u);
    vec3 emission = uintBitsToFloat(words.xyz);
    if (HAS_EMISSIVE_TEXTURE) emission *= sampleTexture(textureRow(material, TEXTURE_EMISSIVE), at.uv0, at.uv1).rgb;
    if (!front && (words.w & MATERIAL_DOUBLE_SIDED) == 0u) emission = vec3(0.0);
    return HAS_UNLIT && (words.w & MATERIAL_UNLIT) != 0u ? baseColor : emission;
}

// The probability that the surface exists where a ray meets it.
float loadCoverage(uint material, uint row, vec2 barycentric, Coordinates at)
{
    uint flags = FETCH(SceneData, material + 1u).w;
    if (!HAS_ALPHA || (flags & (MATERIAL_MASK | MATERIAL_BLEND)) == 0u) return 1.0;
    float alpha = loadBaseColor(material, row, barycentric, at).a;
    float cutoff = uintBitsToFloat(FETCH(SceneData, material + 4u).y);
    return (flags & MATERIAL_MASK) != 0u ? float(alpha >= cutoff) : min(alpha, 1.0);
}

// Is it asked whether it exists?
bool isAsked(TriangleGeometry g)
{
    return (FETCH(SceneData, materialRow(g.material) + 1u).w & (MATERIAL_MASK | MATERIAL_BLEND)) != 0u;
}

// What decides whether a translucent surface exists for a ray: independent for each triangle, but where the ray meets an edge
// or a vertex all triangles around it decide as one. A ray exactly along an edge asks both of its triangles, and would
// meet alpha twice.
uvec4 alphaKey(uint triangle, TriangleGeometry g, vec2 barycentric)
{
    const float ON_EDGE = 2.384185791015625e-7; // 2^-22: rounding of a weight that is 0
    bvec3 meets = greaterThan(vec3(1.0 - barycentric.x - barycentric.y, barycentric), vec3(ON_EDGE));
    // A sum of the ends, whichever is first; + 0.0 makes one zero of two.
    uvec3 ends = mix(uvec3(0u), floatBitsToUint(g.p0 + 0.0), bvec3(meets.x)) +
                 mix(uvec3(0u), floatBitsToUint(g.p1 + 0.0), bvec3(meets.y)) +
                 mix(uvec3(0u), floatBitsToUint(g.p2 + 0.0), bvec3(meets.z));
    return all(meets) ? uvec4(triangle, 0u, 0u, 0u) : uvec4(ends, 1u);
}

// Does it exist for this ray? Called by traversal for triangles flagged so at build time.
bool alphaPasses(uint triangle, vec2 barycentric, uint alphaSeed)
{
    uint row = attributeRow(triangle);
    TriangleGeometry g = loadTriangle(triangle);
    float coverage = loadCoverage(materialRow(g.material), row, barycentric, loadCoordinates(row, barycentric));
    // Independent per ray, and the same again when the path is replayed.
    uvec4 key = alphaKey(triangle, g, barycentric);
    key.xy = pcg4d(key).xy;
    return unitFloat(pcg4d(uvec4(alphaSeed, key.xy, 0u)).x) < coverage;
}

// ------------------------------------------------------------------------------------------------------------- surfaces
struct Surface {
    vec3 position;
    vec3 geometricNormal; // n_g, on w_o's side
    float offset;         // of the origins of rays that leave it
    vec3 normal;          // n_s, likewise
    vec3 baseColor;       // b
    vec3 emission;        // radiance towards w_o
    vec3 specularColor;
    float specular;     // s
    float metallic;     // m
    float alphaG;       // roughness^2
    float transmission; // before (1 - m)
    float ior;
    float eta;  // index beyond the surface over index on w_o's side, as if solid
    uint flags; // MATERIAL_*
    uint light; // index of the emissive triangle, or NO_INDEX
    float area; // of the triangle, scaled
};

vec3 shadingNormal(uint triangle, uint material, uvec4 packed, vec2 barycentric, Coordinates at)
{
    mat3 normals = mat3(octahedralDecode(packed.x), octahedralDecode(packed.y), octahedralDecode(packed.z));
    Place place;
    bool placed = isPlaced(triangle);
    if (placed) {
        place = loadPlace(triangle);
        for (int i = 0; i < 3; ++i) normals[i] = normalInWorld(place, normals[i]);
    }
    vec3 normal = normalize(baryMix(normals[0], normals[1], normals[2], barycentric));
    if (!HAS_NORMAL_MAP) return normal;
    uint use = textureRow(material, TEXTURE_NORMAL);
    if (FETCH(SceneData, use).x == NO_INDEX) return normal;

    vec3 bent = sampleTexture(use, at.uv0, at.uv1).xyz * 2.0 - 1.0;
    bent.xy *= uintBitsToFloat(FETCH(SceneData, material + 4u).x);
    mat3 tangents = mat3(octahedralDecode(at.tangents.x), octahedralDecode(at.tangents.y), octahedralDecode(packed.w));
    if (placed)
        for (int i = 0; i < 3; ++i) tangents[i] = normalize(place.linear * tangents[i]);
    vec3 tangent = baryMix(tangents[0], tangents[1], tangents[2], barycentric);
    float length2 = dot(tangent, tangent);
    if (length2 > 0.0) tangent *= inversesqrt(length2); // opposite ones may leave nothing
    float handedness = (at.tangents.x & 1u) != 0u ? -1.0 : 1.0;
    if (placed) handedness *= place.side;
    vec3 candidate = tangent * bent.x + cross(normal, tangent) * handedness * bent.y + normal * bent.z;
    float squared = dot(candidate, candidate);
    return squared <= 1e-12 ? normal : candidate * inversesqrt(squared); // a map that decodes to nothing bends nothing
}

Surface loadSurface(uint triangle, vec2 barycentric, vec3 wo)
{
    uint row = attributeRow(triangle);
    TriangleGeometry g = loadTriangle(triangle);
    uint material = materialRow(g.material);
    Coordinates at = loadCoordinates(row, barycentric);

    Surface s;
    s.position = pointOn(g, barycentric);
    s.offset = offsetOf(g, barycentric);
    s.area = 0.5 * length(g.areaNormal);
    s.light = g.light;
    s.flags = FETCH(SceneData, material + 1u).w;
    vec3 frontNormal = normalize(g.areaNormal);
    bool front = dot(wo, frontNormal) >= 0.0;
    s.geometricNormal = front ? frontNormal : -frontNormal;
    vec3 normal = shadingNormal(triangle, material, FETCH(Attributes, row + 3u), barycentric, at);
    if (!front) normal = -normal;
    s.normal = dot(normal, wo) > 0.0 ? normal : s.geometricNormal;
    s.baseColor = loadBaseColor(material, row, barycentric, at).rgb;
    s.emission = loadEmission(material, at, front, s.baseColor);

    s.specularColor = vec3(0.0);
    s.specular = 0.0;
    s.metallic = 0.0;
    s.alphaG = 1.0;
    s.transmission = 0.0;
    s.ior = 1.0;
    s.eta = 1.0;
    if (HAS_SPECULAR || HAS_TRANSMISSION) {
        vec4 numbers = uintBitsToFloat(FETCH(SceneData, material + 2u)); // metallic, roughness, ior, specular
        vec4 tint = uintBitsToFloat(FETCH(SceneData, material + 3u));    // specular color, transmission
        if (HAS_METALLIC_ROUGHNESS_TEXTURE)
            numbers.yx *= sampleTexture(textureRow(material, TEXTURE_METALLIC_ROUGHNESS), at.uv0, at.uv1).gb;
        if (HAS_SPECULAR_TEXTURE) {
            numbers.w *= sampleTexture(textureRow(material, TEXTURE_SPECULAR), at.uv0, at.uv1).a;
            tint.rgb *= sampleTexture(textureRow(material, TEXTURE_SPECULAR_COLOR), at.uv0, at.uv1).rgb;
        }
        if (HAS_TRANSMISSION_TEXTURE)
            tint.w *= sampleTexture(textureRow(material, TEXTURE_TRANSMISSION), at.uv0, at.uv1).r;
        s.metallic = numbers.x;
        s.alphaG = numbers.y * numbers.y;
        s.ior = numbers.z;
        s.specular = numbers.w;
        s.specularColor = tint.rgb;
        s.transmission = tint.w;
        s.eta = HAS_SOLID && (s.flags & MATERIAL_SOLID) != 0u && !front ? 1.0 / numbers.z : numbers.z;
    }
    return s;
}

// Where a path leaves the surface in direction d: all directions and distances of what follows are measured from there, by
// rays, light samples and reconnections alike, so that they agree however near the next vertex is.
vec3 departure(Surface s, vec3 d) { return offsetOrigin(s.position, s.geometricNormal, d, s.offset); }

#endif
