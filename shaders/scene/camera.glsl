// Camera rays, and the direction back to the camera.
#ifndef SHADERS_SCENE_CAMERA_GLSL
#define SHADERS_SCENE_CAMERA_GLSL

#include "scene/bindings.glsl"
#include "scene/trace.glsl"

// `at` in pixels, (0, 0) is the upper left corner of a run's picture.
Ray cameraRay(CameraUniform camera, vec2 at)
{
    vec2 p = vec2(2.0, -2.0) * at / vec2(frame.width, frame.runHeight) + vec2(-1.0, 1.0);
    vec3 offset = p.x * camera.right.xyz + p.y * camera.up.xyz;
    if (ORTHOGRAPHIC) return Ray(camera.position.xyz + offset, camera.forward.xyz, RAY_MAX);
    return Ray(camera.position.xyz, normalize(camera.forward.xyz + offset), RAY_MAX);
}

// The inverse: xy / z is the picture point in [-1, 1]^2, y up, if z > 0. z is the depth; 1 for parallel rays.
vec3 project(CameraUniform camera, vec3 position)
{
    vec3 d = position - camera.position.xyz;
    vec3 right = camera.right.xyz;
    vec3 up = camera.up.xyz;
    return vec3(dot(d, right) / dot(right, right), dot(d, up) / dot(up, up), ORTHOGRAPHIC ? 1.0 : dot(d, camera.forward.xyz));
}

// The ray of a pixel in this frame: through its center, or anywhere through it. `alphaSeed` decides about transparent surfaces.
Ray pixelRay(uvec2 pixel, out uint alphaSeed)
{
    PathSeed seed = PathSeed(frame.frame, pixel.y * frame.width + pixel.x);
    uvec4 random = randomBlock(seed, STREAM_CAMERA, uvec2(frame.key0, frame.key1));
    alphaSeed = random.w;
    vec2 corner = vec2(pixel.x, pixel.y % frame.runHeight);
    return cameraRay(frame.camera, corner + (BOX_FILTER ? vec2(unitFloat(random.x), unitFloat(random.y)) : vec2(0.5)));
}

// w_o of a primary hit.
vec3 towardsCamera(CameraUniform camera, vec3 position)
{
    return ORTHOGRAPHIC ? -camera.forward.xyz : normalize(camera.position.xyz - position);
}

#endif
