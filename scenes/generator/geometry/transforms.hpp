#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace heliograph::scenes {

inline constexpr float pi = glm::pi<float>();
inline constexpr float two_pi = 2.0f * pi;

inline glm::mat4 moved(glm::vec3 by) {
  return glm::translate(glm::mat4(1.0f), by);
}

inline glm::mat4 turned(float angle, glm::vec3 axis) {
  return glm::rotate(glm::mat4(1.0f), angle, axis);
}

}  // namespace heliograph::scenes
