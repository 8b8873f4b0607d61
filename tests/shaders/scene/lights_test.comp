#version 460
#extension GL_GOOGLE_include_directive : require
// Samples the scene's lights from points, and asks for the density of each sample's direction.
#include "scene/bindings.glsl"
layout(local_size_x = 64) in;

layout(set = SET_PASS, binding = 0, std430) readonly buffer Origins { vec4 origins[]; }; // scaled; samples take turns
layout(set = SET_PASS, binding = 1, std430) writeonly buffer Results { vec4 results[]; };
// Three rows a sample: radiance, density; direction, kind (0 surface, 1 Dirac, 2 environment);
// density found again, radiance found again's red, triangle, -.

#include "scene/camera.glsl"
#include "scene/lights.glsl"

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= uint(results.length()) / 3u) return;
    vec3 origin = origins[i % uint(origins.length())].xyz;
    Surface from; // in free space
    from.position = origin;
    from.geometricNormal = vec3(0.0);
    from.offset = 0.0;
    LightSample light = sampleLight(pcg4d(uvec4(i, 5u, 6u, 7u)), from);
    float density = light.pdf;
    vec3 radiance = light.radiance;
    uint triangle = NO_INDEX;
    if (light.infinite && !light.dirac) {
        vec4 environment = loadEnvironment(light.direction);
        density = environmentPdf(environment);
        radiance = environment.rgb;
    } else if (!light.dirac) {
        Hit hit = closestHit(Ray(origin, light.direction, RAY_MAX), 0u);
        triangle = hit.triangle;
        if (hit.triangle != NO_HIT) {
            Surface s = loadSurface(hit.triangle, hit.barycentric, -light.direction);
            density = lightPdf(s, origin, light.direction);
            radiance = s.emission;
        }
    }
    results[3u * i] = vec4(light.radiance, light.pdf);
    results[3u * i + 1u] = vec4(light.direction, light.dirac ? 1.0 : light.infinite ? 2.0 : 0.0);
    results[3u * i + 2u] = vec4(density, radiance.r, float(triangle), 0.0);
}
