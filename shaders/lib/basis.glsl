// Orthonormal bases and directions in 32 bits.
#ifndef SHADERS_LIB_BASIS_GLSL
#define SHADERS_LIB_BASIS_GLSL

// Columns: tangent, bitangent, n. Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017.
mat3 basisFromNormal(vec3 n)
{
    float s = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (s + n.z);
    float b = n.x * n.y * a;
    return mat3(vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x), vec3(b, s + n.y * n.y * a, -n.y), n);
}

// Octahedral unit vectors, 16 bits a coordinate. Cigolle et al., "A Survey of Efficient Representations for Independent Unit
// Vectors", JCGT 3(2), 2014.
vec3 octahedralDecode(uint packed)
{
    vec2 e = max(unpackSnorm2x16(packed), vec2(-1.0));
    vec3 v = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    float fold = max(-v.z, 0.0);
    v.x += v.x >= 0.0 ? -fold : fold;
    v.y += v.y >= 0.0 ? -fold : fold;
    return normalize(v);
}

float maxComponent(vec3 v) { return max(max(v.x, v.y), v.z); }

#endif
