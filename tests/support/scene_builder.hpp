#pragma once

#include <array>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <span>

#include "scene/environment.hpp"
#include "scene/scene.hpp"

namespace heliograph::test {

/// A material without textures: linear base colour, perceptual roughness.
shared::Material surface(const glm::vec3& color, float roughness = 1.0f, float metallic = 0.0f);

/// Builds small scenes in code.
class SceneBuilder {
 public:
  std::uint32_t add_material(const shared::Material& material);
  /// `material` with the layers of material extensions.
  shared::Material with_layers(shared::Material material, const scene::MaterialLayers& layers);
  /// Four corners, counter-clockwise from outside; uv (0,0) (1,0) (1,1) (0,1), tangent along u.
  std::uint32_t add_quad(const std::array<glm::vec3, 4>& corners, const shared::Material& material);
  /// Several quads as one mesh.
  std::uint32_t add_quads(std::span<const std::array<glm::vec3, 4>> quads,
                          const shared::Material& material);
  /// Centered at the origin, with exact normals.
  std::uint32_t add_sphere(float radius, const shared::Material& material);
  SceneBuilder& place(std::uint32_t mesh, const glm::mat4& world = glm::mat4(1.0f));

  /// RGBA8 texture, sRGB or linear, without mip levels; nearest filter, clamped.
  std::uint32_t add_texture(std::uint32_t width, std::uint32_t height, bool srgb,
                            std::vector<std::uint8_t> pixels);
  /// Linear RGBA8 of `side` x `side`, a power of two, whose levels darken by `step` / 255 each from
  /// white; linear filters, clamped.
  std::uint32_t add_darkening_texture(std::uint32_t side, std::uint8_t step);

  /// Light travels along `direction`; `irradiance` is that of a facing surface.
  SceneBuilder& add_sun(const glm::vec3& direction, const glm::vec3& irradiance,
                        float angular_diameter = 0.0f);
  SceneBuilder& add_point_light(const glm::vec3& position, const glm::vec3& intensity,
                                float radius = 0.0f);

  std::shared_ptr<const scene::Scene> build();

 private:
  scene::Scene scene_;
};

/// A camera at `eye` that looks at `target`.
scene::Camera look(const glm::vec3& eye, const glm::vec3& target, float vertical_fov = 45.0f);

/// Equirectangular environment of height `height`, sampled from a function of the direction.
scene::Environment make_environment(std::uint32_t width,
                                    const std::function<glm::vec3(const glm::vec3&)>& radiance);

}  // namespace heliograph::test
