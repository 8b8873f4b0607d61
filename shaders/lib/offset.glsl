// Where rays that leave a surface begin.
#ifndef SHADERS_LIB_OFFSET_GLSL
#define SHADERS_LIB_OFFSET_GLSL

// Part of a coordinate's size by which rounding may move a point that is computed on a surface.
const float POSITION_ERROR = 1.0 / 4194304.0; // 2^-22

// How far from a triangle's plane rays that leave it begin: farther than rounding can have moved the point and the plane.
// Both err by parts of the coordinates, each axis by its own: walls along an axis keep their exact place, and a large
// triangle elsewhere changes nothing. `size`: the largest absolute coordinates of its vertices, by axis.
float originOffset(vec3 geometricNormal, vec3 size) { return 2.0 * POSITION_ERROR * dot(abs(geometricNormal), size); }

// Where a ray in `direction` that leaves a surface point begins.
vec3 offsetOrigin(vec3 position, vec3 geometricNormal, vec3 direction, float offset)
{
    return position + (dot(geometricNormal, direction) < 0.0 ? -offset : offset) * geometricNormal;
}

#endif
