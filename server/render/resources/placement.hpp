#pragma once

#include <glm/glm.hpp>

#include "scene/scene.hpp"

namespace heliograph::render {

/// A mesh placed by `world`, static: the previous matrix is the same.
shared::Instance place_mesh(std::uint32_t mesh, const glm::mat4& world);
/// Moves an instance to `world`; its old matrix becomes the previous one.
void move_instance(shared::Instance& instance, const glm::mat4& world);

/// What the rasteriser pushes for an instance.
shared::DrawConstants draw_constants(const shared::Instance& instance, std::uint32_t index);

}  // namespace heliograph::render
