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

/// Puts small scenes together by hand.
class SceneBuilder {
 public:
  std::uint32_t add_material(const shared::Material& material);
  /// `material` with what an extension adds to it.
  shared::Material with_layers(shared::Material material, const scene::MaterialLayers& layers);
  /// Four corners, counter-clockwise from outside; uv (0,0) (1,0) (1,1) (0,1), tangent along u.
  std::uint32_t add_quad(const std::array<glm::vec3, 4>& corners, const shared::Material& material);
  /// Several of them as one thing.
  std::uint32_t add_quads(std::span<const std::array<glm::vec3, 4>> quads,
                          const shared::Material& material);
  /// About the origin, with exact normals.
  std::uint32_t add_sphere(float radius, const shared::Material& material);
  SceneBuilder& place(std::uint32_t mesh, const glm::mat4& world = glm::mat4(1.0f));

  /// A texture of sRGB or linear RGBA8 texels without mips, read by nearest texel, clamped.
  std::uint32_t add_texture(std::uint32_t width, std::uint32_t height, bool srgb,
                            std::vector<std::uint8_t> pixels);

  /// Light that travels along `direction`; irradiance of a facing surface.
  SceneBuilder& add_sun(const glm::vec3& direction, const glm::vec3& irradiance,
                        float angular_diameter = 0.0f);
  SceneBuilder& add_lamp(const glm::vec3& position, const glm::vec3& intensity,
                         float radius = 0.0f);

  std::shared_ptr<const scene::Scene> build();

 private:
  scene::Scene scene_;
};

/// A camera at `eye` that looks at `target`.
scene::Camera look(const glm::vec3& eye, const glm::vec3& target, float vertical_fov = 45.0f);

/// An environment whose radiance is a function of the direction.
scene::Environment make_environment(std::uint32_t width,
                                    const std::function<glm::vec3(const glm::vec3&)>& radiance);

}  // namespace heliograph::test
