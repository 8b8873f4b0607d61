#pragma once
// Meshes made in code: each function adds vertices and triangles to a scene. Fronts face outward (or where it is said).
// Positions and normals only: no texture coordinates, tangents or colours.

#include <cstdint>
#include <functional>
#include <span>

#include <glm/glm.hpp>

#include "engine/scene/scene.h"

namespace scene
{

uint32_t addMaterial(Scene& scene, const Material& material); // its index
Material diffuse(const char* name, glm::vec3 color);          // exactly Lambert
Material emitter(const char* name, glm::vec3 radiance);       // black, emits from the front
Material glossy(const char* name, glm::vec3 color, float roughness);

// corner, corner + u, corner + u + v, corner + v; the front is on the side of cross(u, v).
void addQuad(Scene& scene, uint32_t material, glm::vec3 corner, glm::vec3 u, glm::vec3 v);

// `transform` maps the cube [-1, 1]^3; its determinant is positive. Closed.
void addBox(Scene& scene, uint32_t material, const glm::mat4& transform);
void addBox(Scene& scene, uint32_t material, glm::vec3 low, glm::vec3 high);

// The icosahedron subdivided: 20 * 4^subdivisions triangles. Closed.
enum class Normals { Smooth, Flat };
enum class Facing { Outward, Inward };
void addSphere(Scene& scene, uint32_t material, glm::vec3 center, float radius, uint32_t subdivisions,
               Normals normals = Normals::Smooth, Facing facing = Facing::Outward);

// A parametric surface as a smooth grid of columns x rows cells: position(s, t), s and t from 0 to 1; the front is on
// the side of cross(dp/ds, dp/dt). `closed`: s = 1 is s = 0. Triangles without area (a pole) are left out.
struct Grid {
    uint32_t columns = 1;
    uint32_t rows = 1;
    bool closed = false;
};
void addSurface(Scene& scene, uint32_t material, Grid grid, const std::function<glm::vec3(float, float)>& position);

// A profile of (radius, height) points, from the bottom up, turned around the vertical axis through `base`: smooth
// around, an edge at each profile point. Closed when the profile starts and ends on the axis.
void addLathe(Scene& scene, uint32_t material, glm::vec3 base, std::span<const glm::vec2> profile, uint32_t segments);

// A round bar. No caps.
void addBar(Scene& scene, uint32_t material, glm::vec3 from, glm::vec3 to, float radius, uint32_t segments = 8);

// A camera at `position` that looks at `target`, the sky is +y; `fieldDegrees` is vertical.
Camera lookAt(const char* name, glm::dvec3 position, glm::dvec3 target, double fieldDegrees);

} // namespace scene
