#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "scene/scene.hpp"

namespace heliograph::render {

/// What textures leave of the emission of each triangle: the mean of their linear texels over it,
/// estimated where the images' pixels are at hand. Nothing is kept of meshes without such a
/// texture.
class EmissionMeans {
 public:
  explicit EmissionMeans(const scene::Scene& scene);

  /// `pixels`: levels of the image of that number, perhaps without the largest; each image once.
  void add(const scene::Scene& scene, std::size_t image, std::span<const std::uint8_t> pixels);

  /// RGB by triangle; empty where the mesh's emission has no texture.
  std::span<const glm::vec3> of_mesh(std::uint32_t mesh) const { return means_[mesh]; }
  std::uint64_t bytes() const;

 private:
  std::vector<std::vector<glm::vec3>> means_;  // by mesh
};

}  // namespace heliograph::render
