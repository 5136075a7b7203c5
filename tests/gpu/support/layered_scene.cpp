#include "tests/gpu/support/layered_scene.hpp"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/support/engine.hpp"

namespace heliograph::test {
namespace {

/// Sine waves in every channel.
std::uint32_t add_waves(SceneBuilder& builder, bool srgb, double phase) {
  constexpr std::uint32_t size = 64;
  std::vector<std::uint8_t> texels(size * size * 4);
  for (std::uint32_t i = 0; i < texels.size(); ++i) {
    const double x = (i / 4) % size, y = i / 4 / size, channel = i % 4;
    texels[i] = static_cast<std::uint8_t>(
        128.0 + 100.0 * std::sin(0.1 * (x + 2.0 * channel * y) + phase + channel));
  }
  return builder.add_texture(size, size, srgb, std::move(texels));
}

shared::Light area(std::uint32_t type, const glm::vec3& position) {
  shared::Light light{};
  light.type = type;
  light.position = position;
  light.direction = glm::normalize(-position);
  light.tangent = glm::normalize(glm::cross(light.direction, glm::vec3(0.1f, 1.0f, 0.2f)));
  light.color = {6.0f, 5.0f, 4.0f};
  light.half_width = 0.7f;
  light.half_height = 0.3f;
  light.radius = 0.5f;
  return light;
}

}  // namespace

scene::MaterialLayers coat(SceneBuilder&) {
  return {.clearcoat = 0.8f, .clearcoat_roughness = 0.15f};
}
scene::MaterialLayers sheen(SceneBuilder&) {
  return {.sheen_color = {0.6f, 0.3f, 0.5f}, .sheen_roughness = 0.4f};
}
scene::MaterialLayers specular(SceneBuilder&) {
  return {.specular = 0.6f, .specular_color = {1.0f, 0.6f, 2.5f}};
}
scene::MaterialLayers film(SceneBuilder&) {
  return {.iridescence = 0.9f, .iridescence_ior = 1.8f, .iridescence_thickness_maximum = 350.0f};
}
scene::MaterialLayers brushed(SceneBuilder&) {
  return {.anisotropy = 0.7f, .anisotropy_rotation = 0.6f};
}
scene::MaterialLayers brushed_film(SceneBuilder& builder) {
  scene::MaterialLayers layers = film(builder);
  layers.iridescence_thickness_minimum = 200.0f;
  layers.iridescence_texture.texture = add_waves(builder, false, 0.5);
  layers.iridescence_thickness_texture.texture = add_waves(builder, false, 1.5);
  layers.anisotropy = 0.8f;
  layers.anisotropy_rotation = -0.3f;
  layers.anisotropy_texture.texture = add_waves(builder, false, 2.5);
  layers.anisotropy_texture.uv_set = 1;
  layers.clearcoat = 0.5f;
  layers.clearcoat_roughness = 0.2f;
  layers.sheen_color = {0.2f, 0.3f, 0.1f};
  layers.sheen_roughness = 0.5f;
  return layers;
}
scene::MaterialLayers transmission(SceneBuilder&) {
  return {.transmission = 0.6f,
          .thickness = 0.2f,
          .attenuation_distance = 0.3f,
          .attenuation_color = {0.9f, 0.5f, 0.7f}};
}
scene::MaterialLayers diffuse_transmission(SceneBuilder&) {
  return {.diffuse_transmission = 0.6f, .diffuse_transmission_color = {0.9f, 0.5f, 0.2f}};
}
scene::MaterialLayers textured_diffuse_transmission(SceneBuilder& builder) {
  scene::MaterialLayers layers = brushed_film(builder);
  layers.diffuse_transmission = 0.9f;
  layers.diffuse_transmission_color = {0.8f, 1.0f, 0.6f};
  layers.diffuse_transmission_texture.texture = add_waves(builder, false, 3.5);
  layers.diffuse_transmission_color_texture.texture = add_waves(builder, true, 4.5);
  layers.diffuse_transmission_color_texture.uv_set = 1;
  layers.thickness = 0.2f;
  layers.attenuation_distance = 0.5f;
  layers.attenuation_color = {0.9f, 0.8f, 0.4f};
  return layers;
}
scene::MaterialLayers all_of_them(SceneBuilder& builder) {
  scene::MaterialLayers layers{.specular = 0.9f,
                               .specular_color = {0.9f, 0.8f, 0.7f},
                               .clearcoat = 0.7f,
                               .clearcoat_roughness = 0.3f,
                               .clearcoat_normal_scale = 0.5f,
                               .sheen_color = {0.5f, 0.4f, 0.3f},
                               .sheen_roughness = 0.6f};
  layers.specular_texture.texture = add_waves(builder, false, 0.0);
  layers.specular_color_texture.texture = add_waves(builder, true, 1.0);
  layers.clearcoat_texture.texture = add_waves(builder, false, 2.0);
  layers.clearcoat_roughness_texture.texture = layers.clearcoat_texture.texture;
  layers.clearcoat_normal_texture.texture = add_waves(builder, false, 3.0);
  layers.sheen_color_texture.texture = add_waves(builder, true, 4.0);
  layers.sheen_color_texture.transform_row0 = {1.5f, 0.2f, 0.1f, 0.0f};
  layers.sheen_color_texture.uv_set = 1;
  layers.sheen_roughness_texture.texture = add_waves(builder, false, 5.0);
  return layers;
}

std::shared_ptr<const scene::Scene> layered_scene(const LayeredCase& which) {
  SceneBuilder builder;
  const auto material = [&](const glm::vec3& color, float roughness, float metallic) {
    shared::Material made = surface(color, roughness, metallic);
    if (which.layers) made = builder.with_layers(made, which.layers(builder));
    if (which.alpha < 1.0f) {
      made.base_color.w = which.alpha;
      made.flags |= shared::material_alpha_blend | shared::material_double_sided;
    }
    return made;
  };
  const auto at = [](const glm::vec3& to) { return glm::translate(glm::mat4(1.0f), to); };
  const auto scaled_at = [&](const glm::vec3& to) {
    return glm::scale(at(to), glm::vec3(which.scale));
  };
  const auto ball =
      builder.add_sphere(0.6f / which.scale, material({0.8f, 0.4f, 0.2f}, 0.5f, 0.0f));
  builder.place(ball, scaled_at({-0.7f, 0.0f, 0.0f})).place(ball, scaled_at({0.2f, 0.1f, -1.2f}));
  shared::Material panel = material({0.9f, 0.8f, 0.6f}, 0.25f, 0.7f);
  if (which.shines) panel.emissive = {3.0f, 2.0f, 1.0f};
  builder.place(
      builder.add_quad({{{-0.5f, -0.5f, 0}, {0.5f, -0.5f, 0}, {0.5f, 0.5f, 0}, {-0.5f, 0.5f, 0}}},
                       panel),
      glm::rotate(at({0.7f, 0.0f, 0.1f}), 0.4f, glm::vec3(0, 1, 0)));
  builder.place(builder.add_quad({{{-3, -0.6f, 3}, {3, -0.6f, 3}, {3, -0.6f, -3}, {-3, -0.6f, -3}}},
                                 surface({0.7f, 0.7f, 0.6f}, 0.3f, 0.4f)));
  if (!which.areas) {
    builder.add_sun({0.3f, -0.5f, -1.0f}, {3, 2, 1}, 2.0f);
    builder.add_point_light({1.5f, 1.2f, 1.0f}, {4, 5, 6}, 0.1f);
    return builder.build();
  }
  builder.add_point_light({1.5f, 1.2f, 1.0f}, {1, 2, 3}, 0.1f);
  auto made = std::make_shared<scene::Scene>(*builder.build());
  made->lights.push_back({"rectangle", area(shared::light_rectangle, {-1.5f, 1.5f, 1.0f}), 0.0f});
  made->lights.push_back({"disk", area(shared::light_disk, {1.8f, -0.5f, 1.0f}), 0.0f});
  return made;
}

scene::Camera layered_camera(const LayeredCase& which) {
  scene::Camera made = look({0.3f, 0.6f, 3.0f}, {0, -0.1f, 0}, 40.0f);
  if (which.orthographic) made.orthographic_height = 2.5f;
  return made;
}

scene::Environment colored_environment() {
  return make_environment(128, [](const glm::vec3& d) {
    return glm::vec3(1.0f + d.y, 0.5f + 0.4f * d.x * d.z, 1.0f - d.x);
  });
}

}  // namespace heliograph::test
