#include "render/resources/placement.hpp"

namespace heliograph::render {

shared::Instance place_mesh(std::uint32_t mesh, const glm::mat4& world) {
  shared::Instance instance{};
  instance.mesh = mesh;
  instance.world = world;
  move_instance(instance, world);
  return instance;
}

void move_instance(shared::Instance& instance, const glm::mat4& world) {
  const glm::mat3 linear(world);
  const float determinant = glm::determinant(linear);
  instance.previous_world = instance.world;
  instance.world = world;
  // Squeezed flat, nothing of it is seen and its normals do not matter.
  instance.normal_matrix =
      determinant != 0.0f ? glm::mat4(glm::transpose(glm::inverse(linear))) : glm::mat4(1.0f);
  instance.flags = determinant < 0.0f ? shared::instance_flipped : 0u;
  instance.scale = scene::length_scale(world);
}

shared::DrawConstants draw_constants(const shared::Instance& instance, std::uint32_t index) {
  shared::DrawConstants constants{};
  const glm::mat4 now = glm::transpose(instance.world);
  const glm::mat4 before = glm::transpose(instance.previous_world);
  for (int row = 0; row < 3; ++row) {
    constants.world[row] = now[row];
    constants.previous_world[row] = before[row];
  }
  constants.instance = index;
  constants.flags = instance.flags;
  constants.scale = instance.scale;
  return constants;
}

}  // namespace heliograph::render
