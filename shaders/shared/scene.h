// The scene's tables (set 1): record layouts, in units of uvec4. Written by engine/scene/gpu_scene.cpp, read by
// shaders/scene/. All lengths are scaled by a power of two so that the scene's radius is about 1, all light so that its
// largest value is about 1.
#ifndef SHADERS_SHARED_SCENE_H
#define SHADERS_SHARED_SCENE_H

#include "shared/types.h"

SHARED_BEGIN

SHARED_CONST uint NO_INDEX = 0xffffffffu;

// Table Attributes: one record a triangle. Rows 0-2: vertex positions, w = material, light (or NO_INDEX), the least
// barycentric weight of points that paths scatter at (surface.glsl's pointOn).
// Row 3: three octahedral normals, w = tangent 2. With UVs, rows 4-5: uv of vertices 0,1; uv of vertex 2, tangents 0,1.
// With second UVs or vertex colors, rows 6-8: uv1 of 0,1; uv1 of 2, color 0; colors 1,2 (each color 4 halves).
SHARED_CONST uint ATTRIBUTE_ROWS_BARE = 4u;
SHARED_CONST uint ATTRIBUTE_ROWS_UV = 6u;
SHARED_CONST uint ATTRIBUTE_ROWS_FULL = 9u;

// A scene that moves is there twice, as two worlds: as it is, and as it was in the frame before. Each table but Texels,
// and but the environment, holds one after the other.
//
// Table SceneData holds, at the offsets in SceneUniform: environment texels and aliases; materials, lights, punctual
// lights. Material: rows 0-4, then TEXTURE_ROWS rows for each texture use.
//   0 baseColor rgba | 1 emission rgb, flags | 2 metallic, roughness, ior, specular | 3 F0 dielectric rgb, transmission
//   4 normalScale, alphaCutoff, 0, 0
// Texture use: 0 first block, width | height << 16, flags, 0 | 1 row0 xyz, 0 | 2 row1 xyz, 0. First block NO_INDEX:
// none.
SHARED_CONST uint TEXTURE_ROWS = 3u;
SHARED_CONST uint TEXTURE_BASE_COLOR = 0u;
SHARED_CONST uint TEXTURE_METALLIC_ROUGHNESS = 1u;
SHARED_CONST uint TEXTURE_NORMAL = 2u;
SHARED_CONST uint TEXTURE_EMISSIVE = 3u;
SHARED_CONST uint TEXTURE_TRANSMISSION = 4u;
SHARED_CONST uint TEXTURE_SPECULAR = 5u;
SHARED_CONST uint TEXTURE_SPECULAR_COLOR = 6u;
SHARED_CONST uint TEXTURE_COUNT = 7u;
SHARED_CONST uint MATERIAL_HEAD_ROWS = 5u;
SHARED_CONST uint MATERIAL_ROWS = 26u; // MATERIAL_HEAD_ROWS + TEXTURE_COUNT * TEXTURE_ROWS

SHARED_CONST uint MATERIAL_DOUBLE_SIDED = 1u;
SHARED_CONST uint MATERIAL_UNLIT = 2u;
SHARED_CONST uint MATERIAL_SOLID = 4u;
SHARED_CONST uint MATERIAL_TRANSMISSIVE = 8u; // transmission factor above 0: exact dielectric Fresnel
SHARED_CONST uint MATERIAL_MASK = 16u;
SHARED_CONST uint MATERIAL_BLEND = 32u;

SHARED_CONST uint TEXTURE_WRAP_U_SHIFT = 0u; // 2 bits: scene::Wrap
SHARED_CONST uint TEXTURE_WRAP_V_SHIFT = 2u;
SHARED_CONST uint TEXTURE_NEAREST = 16u;
SHARED_CONST uint TEXTURE_SECOND_UV = 32u;
SHARED_CONST uint TEXTURE_SRGB = 64u;
SHARED_CONST uint TEXTURE_DEEP = 128u; // 16 bits a sample: a block is two rows of table Texels

// Light: alias threshold, alias index, pick probability, kind | index << 2. The index is a triangle or a punctual
// light.
SHARED_CONST uint LIGHT_TRIANGLE = 0u;
SHARED_CONST uint LIGHT_PUNCTUAL = 1u; // point or spot
SHARED_CONST uint LIGHT_DIRECTIONAL = 2u;
SHARED_CONST uint LIGHT_ENVIRONMENT = 3u;
// Punctual light: position xyz, 1 - cos outer | intensity rgb, 1 / (cos inner - cos outer) or 0 for a point | direction
// xyz, 0
SHARED_CONST uint PUNCTUAL_ROWS = 3u;
// Environment texel: radiance rgb, probability / solid angle. Alias rows, two texels each: threshold, index.

// Instance, a mesh that is stored once in one of its places: rows 0-2: those of the transform from mesh to world, w its
// translation | 3: x the mesh's first row in table Attributes, with INSTANCE_MIRRORS where it mirrors; yzw: the largest
// that a coordinate can be on the way to the world.
// Triangles before SceneUniform::flatTriangles lie in the world. Triangle t of the mesh of instance i is called
// flatTriangles + (i << triangleBits) + t. Trees, records and attributes of the meshes lie behind those of all worlds.
// In their records triangles count from 0.
// The tree over the instances has them for records of table Triangles: rows 0-2: those of the linear transform from
// world to mesh, w the translation before it | 3: root node of the mesh's tree, the first of its triangles here, 0, 0.
SHARED_CONST uint INSTANCE_ROWS = 4u;
SHARED_CONST uint INSTANCE_MIRRORS = 0x80000000u;

struct SceneUniform {
    uint attributeRows;          // rows of table Attributes per triangle
    uint attributeOffset;        // rows
    uint rootNode;               // of the tree in table Nodes
    uint materialOffset;         // rows in table SceneData
    uint lightOffset;            // rows
    uint lightCount;             // lights that next-event estimation picks from
    uint punctualOffset;         // rows
    uint environmentOffset;      // rows
    uint environmentAliasOffset; // rows
    uint environmentWidth;       // texels
    uint environmentHeight;      // texels
    float environmentPick;       // probability that next-event estimation picks the environment
    float radius;                // of the bounding sphere about the origin, scaled
    uint instanceOffset;         // rows
    uint instanceRoot;           // of the tree over instances in table Nodes
    uint flatTriangles;
    uint triangleBits;
    uint padding0;
    uint padding1;
    uint padding2;
};

SHARED_END
#ifdef __cplusplus
static_assert(sizeof(shared::SceneUniform) == 80);
static_assert(shared::MATERIAL_ROWS == shared::MATERIAL_HEAD_ROWS + shared::TEXTURE_COUNT * shared::TEXTURE_ROWS);
#endif
#endif
