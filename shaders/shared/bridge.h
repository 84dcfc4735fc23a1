// Lets one file declare a struct for C++ and GLSL. Structs are made of rows of 16 bytes, so that std140, std430 and C++
// agree; tests/gpu/passes/shared_structs_test.cpp asks the driver.
#ifndef BRICKFIELD_BRIDGE_H
#define BRICKFIELD_BRIDGE_H

#ifdef BRICKFIELD_GLSL
#define SHARED_BEGIN
#define SHARED_END
#define SHARED_ASSERT_SIZE(type, bytes)
#define SHARED_CONST const
#else
#include <cstdint>
#include <glm/glm.hpp>
#define SHARED_BEGIN                                                                                                   \
  namespace brickfield::shared {                                                                                       \
  using glm::ivec4;                                                                                                    \
  using glm::mat4;                                                                                                     \
  using glm::uvec4;                                                                                                    \
  using glm::vec4;                                                                                                     \
  using uint = std::uint32_t;
#define SHARED_END }
#define SHARED_ASSERT_SIZE(type, bytes) static_assert(sizeof(type) == (bytes), "rows of 16 bytes");
#define SHARED_CONST inline constexpr
#endif

#endif
