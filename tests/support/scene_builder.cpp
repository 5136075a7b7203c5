#include "tests/support/scene_builder.hpp"

#include <cmath>
#include <glm/gtc/packing.hpp>
#include <numbers>

#include "scene/gltf/materials/layer_table.hpp"

namespace heliograph::test {
namespace {

shared::Vertex make_vertex(const glm::vec3& position, const glm::vec3& normal,
                           const glm::vec3& tangent, const glm::vec2& uv) {
  shared::Vertex vertex{};
  vertex.position = position;
  vertex.normal = normal;
  vertex.tangent = glm::vec4(tangent, 1.0f);
  vertex.uv0 = vertex.uv1 = uv;
  vertex.color_rg = vertex.color_ba = glm::packUnorm2x16(glm::vec2(1.0f));
  return vertex;
}

shared::TextureSlot empty_slot() {
  shared::TextureSlot slot{};
  slot.transform_row0 = {1, 0, 0, 0};
  slot.transform_row1 = {0, 1, 0, 0};
  slot.texture = shared::no_texture;
  return slot;
}

}  // namespace

shared::Material surface(const glm::vec3& color, float roughness, float metallic) {
  shared::Material material{};
  material.base_color = glm::vec4(color, 1.0f);
  material.alpha_cutoff = 0.5f;
  material.metallic = metallic;
  material.roughness = roughness;
  material.normal_scale = material.occlusion_strength = 1.0f;
  material.ior = 1.5f;
  material.alpha_mask = shared::no_texture;
  material.base_color_texture = material.metallic_roughness_texture = material.normal_texture =
      material.occlusion_texture = material.emissive_texture = empty_slot();
  return material;
}

std::uint32_t SceneBuilder::add_material(const shared::Material& material) {
  scene_.materials.push_back(material);
  scene_.material_names.emplace_back();
  return static_cast<std::uint32_t>(scene_.materials.size() - 1);
}

std::uint32_t SceneBuilder::add_quad(const std::array<glm::vec3, 4>& corners,
                                     const shared::Material& material) {
  return add_quads({&corners, 1}, material);
}

std::uint32_t SceneBuilder::add_quads(std::span<const std::array<glm::vec3, 4>> quads,
                                      const shared::Material& material) {
  scene::Mesh mesh;
  mesh.material = add_material(material);
  constexpr std::array<glm::vec2, 4> uv{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  for (const auto& corners : quads) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    const glm::vec3 tangent = glm::normalize(corners[1] - corners[0]);
    const glm::vec3 normal = glm::normalize(glm::cross(tangent, corners[3] - corners[0]));
    for (std::size_t i = 0; i < 4; ++i) {
      mesh.vertices.push_back(make_vertex(corners[i], normal, tangent, uv[i]));
      mesh.bounds.include(corners[i]);
    }
    for (const std::uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) {
      mesh.indices.push_back(first + corner);
    }
  }
  scene_.meshes.push_back(std::move(mesh));
  return static_cast<std::uint32_t>(scene_.meshes.size() - 1);
}

std::uint32_t SceneBuilder::add_sphere(float radius, const shared::Material& material) {
  constexpr std::uint32_t columns = 96, rows = 48;
  scene::Mesh mesh;
  mesh.material = add_material(material);
  for (std::uint32_t y = 0; y <= rows; ++y) {
    for (std::uint32_t x = 0; x <= columns; ++x) {
      const glm::vec2 uv(static_cast<float>(x) / columns, static_cast<float>(y) / rows);
      const float theta = uv.y * std::numbers::pi_v<float>;
      const float phi = uv.x * 2.0f * std::numbers::pi_v<float>;
      const glm::vec3 normal{std::sin(theta) * std::sin(phi), std::cos(theta),
                             std::sin(theta) * std::cos(phi)};
      mesh.vertices.push_back(
          make_vertex(radius * normal, normal, {std::cos(phi), 0.0f, -std::sin(phi)}, uv));
      mesh.bounds.include(radius * normal);
    }
  }
  for (std::uint32_t y = 0; y < rows; ++y) {
    for (std::uint32_t x = 0; x < columns; ++x) {
      const std::uint32_t a = y * (columns + 1) + x, below = a + columns + 1;
      mesh.indices.insert(mesh.indices.end(), {a, below, a + 1, a + 1, below, below + 1});
    }
  }
  scene_.meshes.push_back(std::move(mesh));
  return static_cast<std::uint32_t>(scene_.meshes.size() - 1);
}

SceneBuilder& SceneBuilder::place(std::uint32_t mesh, const glm::mat4& world) {
  scene_.instances.push_back({mesh, static_cast<std::uint32_t>(scene_.nodes.size())});
  scene_.nodes.push_back({.name = {}, .parent = {}, .local = world, .world = world});
  for (const shared::Vertex& vertex : scene_.meshes[mesh].vertices) {
    scene_.bounds.include(glm::vec3(world * glm::vec4(vertex.position, 1.0f)));
  }
  return *this;
}

std::uint32_t SceneBuilder::add_texture(std::uint32_t width, std::uint32_t height, bool srgb,
                                        std::vector<std::uint8_t> pixels) {
  scene::Texture texture;
  texture.image = static_cast<std::uint32_t>(scene_.images.size());
  texture.sampler = {shared::wrap_clamp,
                     shared::wrap_clamp,
                     scene::Filter::nearest,
                     scene::Filter::nearest,
                     false,
                     scene::Filter::nearest};
  scene_.images.push_back({"texture", width, height, 1, srgb, std::move(pixels)});
  scene_.textures.push_back(texture);
  return static_cast<std::uint32_t>(scene_.textures.size() - 1);
}

std::uint32_t SceneBuilder::add_darkening_texture(std::uint32_t side, std::uint8_t step) {
  std::vector<std::uint8_t> pixels;
  std::uint8_t value = 255;
  std::uint32_t levels = 0;
  for (std::uint32_t size = side; size > 0; size /= 2, ++levels) {
    pixels.insert(pixels.end(), std::size_t{4} * size * size, value);
    value = static_cast<std::uint8_t>(std::max(value - step, 0));
  }
  const std::uint32_t texture = add_texture(side, side, false, std::move(pixels));
  scene_.images.back().levels = levels;
  scene_.textures.back().sampler = {
      shared::wrap_clamp,   shared::wrap_clamp, scene::Filter::linear, scene::Filter::linear, true,
      scene::Filter::linear};
  return texture;
}

SceneBuilder& SceneBuilder::add_sun(const glm::vec3& direction, const glm::vec3& irradiance,
                                    float angular_diameter) {
  shared::Light light{};
  light.type = shared::light_directional;
  light.direction = glm::normalize(direction);
  light.color = irradiance;
  light.radius = std::tan(glm::radians(0.5f * angular_diameter));
  scene_.lights.push_back({"sun", light, angular_diameter});
  return *this;
}

SceneBuilder& SceneBuilder::add_point_light(const glm::vec3& position, const glm::vec3& intensity,
                                            float radius) {
  shared::Light light{};
  light.type = shared::light_point;
  light.position = position;
  light.direction = {0, -1, 0};
  light.color = intensity;
  light.radius = radius;
  scene_.lights.push_back({"point light", light, 0.0f});
  return *this;
}

shared::Material SceneBuilder::with_layers(shared::Material material,
                                           const scene::MaterialLayers& layers) {
  scene::Scene one;
  one.materials = {material};
  one.material_layers = {layers};
  one.images = scene_.images;
  one.textures = scene_.textures;
  scene::build_layers(one);
  material = one.materials[0];
  if (scene_.layers.empty()) scene_.layers = {scene::plain_layer()};
  if (material.layer != 0) {
    material.layer = static_cast<std::uint32_t>(scene_.layers.size());
    scene_.layers.push_back(one.layers[1]);
  }
  return material;
}

std::shared_ptr<const scene::Scene> SceneBuilder::build() {
  if (scene_.materials.empty()) add_material(surface(glm::vec3(1.0f)));
  return std::make_shared<const scene::Scene>(scene_);
}

scene::Camera look(const glm::vec3& eye, const glm::vec3& target, float vertical_fov) {
  scene::Camera camera;
  camera.eye = eye;
  camera.target = target;
  camera.vertical_fov = vertical_fov;
  return camera;
}

scene::Environment make_environment(std::uint32_t width,
                                    const std::function<glm::vec3(const glm::vec3&)>& radiance) {
  scene::Environment environment{width, width / 2, {}};
  for (std::uint32_t y = 0; y < environment.height; ++y) {
    const double theta = (y + 0.5) / environment.height * std::numbers::pi;
    for (std::uint32_t x = 0; x < width; ++x) {
      const double phi = ((x + 0.5) / width - 0.5) * 2.0 * std::numbers::pi;
      environment.radiance.push_back(radiance(
          {std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)}));
    }
  }
  return environment;
}

}  // namespace heliograph::test
