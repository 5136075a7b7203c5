#include "tests/gpu/support/textured_scene.hpp"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/image/mipmaps.hpp"
#include "tests/support/scene_builder.hpp"

namespace heliograph::test {
namespace {

/// Sine waves in every channel, smooth enough that one mip level more or less changes little.
std::uint32_t add_waves(scene::Scene& scene, bool srgb, double phase) {
  constexpr std::uint32_t size = 256;
  scene::Image image{"waves", size, size, scene::mip_level_count(size, size), srgb, {}};
  image.pixels.resize(scene::mip_chain_bytes(size, size));
  for (std::uint32_t i = 0; i < size * size * 4; ++i) {
    const double x = (i / 4) % size, y = i / 4 / size, channel = i % 4;
    const double wave = std::sin(0.0491 * (x + 2.0 * channel * y) + phase + channel);
    image.pixels[i] = static_cast<std::uint8_t>(128.0 + 100.0 * wave);
  }
  scene::fill_mip_chain(image);
  scene.images.push_back(std::move(image));
  scene::Sampler sampler;
  sampler.wrap_t = shared::wrap_mirror;
  scene.textures.push_back({static_cast<std::uint32_t>(scene.images.size() - 1), sampler});
  return static_cast<std::uint32_t>(scene.textures.size() - 1);
}

shared::Material textured(scene::Scene& scene) {
  shared::Material material = surface({0.9f, 0.8f, 0.7f}, 0.9f, 0.8f);
  material.emissive = {0.4f, 0.2f, 0.1f};
  material.flags = shared::material_double_sided;
  material.normal_scale = 0.7f;
  material.base_color_texture.texture = add_waves(scene, true, 0.0);
  material.metallic_roughness_texture.texture = add_waves(scene, false, 1.0);
  material.metallic_roughness_texture.uv_set = 1;
  material.normal_texture.texture = add_waves(scene, false, 2.0);
  material.occlusion_texture.texture = add_waves(scene, false, 3.0);
  material.emissive_texture.texture = add_waves(scene, true, 4.0);
  material.emissive_texture.transform_row0 = {1.5f, 0.2f, 0.1f, 0.0f};
  material.emissive_texture.transform_row1 = {-0.3f, 0.8f, 0.4f, 0.0f};
  return material;
}

}  // namespace

std::shared_ptr<const scene::Scene> textured_scene() {
  scene::Scene textures;
  const shared::Material material = textured(textures);
  SceneBuilder builder;
  const auto quad = builder.add_quad({{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}}, material);
  const auto ball = builder.add_sphere(0.8f, surface({0.2f, 0.5f, 0.9f}, 0.3f, 0.5f));
  const auto turned = [](const glm::vec3& to, float angle, const glm::vec3& axis,
                         const glm::vec3& scale) {
    return glm::scale(glm::rotate(glm::translate(glm::mat4(1.0f), to), angle, axis), scale);
  };
  builder.place(quad, turned({-1.2f, 0.9f, 0}, 0.4f, {0, 1, 0}, {1, 1, 1}));
  builder.place(quad, turned({1.2f, 0.9f, 0}, 2.7f, {0, 1, 0}, {1, 0.8f, 1}));  // back face
  builder.place(quad, turned({-1.2f, -1, 0}, 0.5f, {1, 0, 0}, {-1, 0.7f, 2}));  // mirrored
  builder.place(quad, turned({1.2f, -1, 0}, 2.5f, {1, 0, 0}, {-1, 1, 1}));      // both
  builder.place(ball, turned({0, 0, -1}, 0.3f, {0, 0, 1}, {-1, 1.4f, 0.7f}));
  scene::Scene scene = *builder.build();
  scene.images = std::move(textures.images);
  scene.textures = std::move(textures.textures);
  for (scene::Mesh& mesh : scene.meshes) {
    for (shared::Vertex& vertex : mesh.vertices) vertex.uv1 = 1.7f * vertex.uv0 + 0.3f;
  }
  return std::make_shared<const scene::Scene>(std::move(scene));
}

std::shared_ptr<const scene::Scene> transparent_scene() {
  SceneBuilder builder;
  const std::array<glm::vec3, 4> corners{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}};
  shared::Material masked = surface({0.9f, 0.4f, 0.2f}), blended = masked, bright = masked;
  std::vector<std::uint8_t> holes;
  for (int i = 0; i < 64; ++i) {
    const std::uint8_t alpha = i * 5 % 7 < 4 ? 230 : 40;
    holes.insert(holes.end(), {200, 100, static_cast<std::uint8_t>(4 * i), alpha});
  }
  masked.base_color_texture.texture = builder.add_texture(8, 8, true, holes);
  masked.flags = shared::material_alpha_mask | shared::material_double_sided;
  masked.alpha_cutoff = 0.5f;
  blended.base_color.w = 0.4f;
  blended.flags = shared::material_alpha_blend;
  bright.flags = shared::material_unlit;
  const auto at = [](const glm::vec3& to) {
    glm::mat4 world(1.0f);
    world[3] = glm::vec4(to, 1.0f);
    return world;
  };
  builder.place(builder.add_quad(corners, masked), at({-0.8f, 0, 1}));
  const auto pane = builder.add_quad(corners, blended);
  builder.place(pane, at({0.5f, 0.2f, 0.5f})).place(pane, at({0.8f, -0.3f, 0.7f}));
  glm::mat4 away = at({0, 0.5f, 0.8f});
  away[0][0] = away[2][2] = -1.0f;
  builder.place(pane, away);  // back face
  builder.place(builder.add_quad(corners, bright), at({0.2f, 0.1f, -0.5f}));
  return builder.build();
}

}  // namespace heliograph::test
