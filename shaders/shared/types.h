// Types that mean the same in C++ and GLSL. Members of shared structs: uint int float vec2 uvec2 vec4 uvec4 mat4 and
// arrays and structs of these. No vec3, no bool: then std430 equals the C++ layout.
#ifndef SHADERS_SHARED_TYPES_H
#define SHADERS_SHARED_TYPES_H

#ifdef __cplusplus
#include <cstdint>
#include <glm/glm.hpp>
namespace shared
{
using uint = uint32_t;
using vec2 = glm::vec2;
using uvec2 = glm::uvec2;
using vec4 = glm::vec4;
using uvec4 = glm::uvec4;
using mat4 = glm::mat4;
} // namespace shared
#define SHARED_BEGIN                                                                                                   \
    namespace shared                                                                                                   \
    {
#define SHARED_END }
#define SHARED_CONST inline constexpr
#define SHARED_FUNCTION constexpr
#else
#define SHARED_BEGIN
#define SHARED_END
#define SHARED_CONST const
#define SHARED_FUNCTION
#endif

// Descriptor sets.
#define SET_FRAME 0
#define SET_SCENE 1
#define SET_PASS 2

#endif
