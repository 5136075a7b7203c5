// Names that C++ and GLSL both understand, so that one struct declaration serves both sides.
#ifndef HELIOGRAPH_SHARED_TYPES_H
#define HELIOGRAPH_SHARED_TYPES_H

#ifdef __cplusplus
#include <cstdint>
#include <glm/glm.hpp>
namespace heliograph::shared {
using glm::ivec2;
using glm::mat4;
using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = std::uint32_t;
}  // namespace heliograph::shared
#define SHARED_BEGIN namespace heliograph::shared {
#define SHARED_END }
#define SHARED_CONSTANT inline constexpr
#define SHARED_FUNCTION inline
#else
#define SHARED_BEGIN
#define SHARED_END
#define SHARED_CONSTANT const
#define SHARED_FUNCTION
#endif

#endif
