#include "scenes/generator/gltf/document.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace heliograph::scenes {

bool Material::is_anisotropic() const {
  return std::ranges::any_of(extensions, [](const MaterialExtension& extension) {
    return extension.name == "KHR_materials_anisotropy";
  });
}

int Document::add_material(Material material) {
  materials.push_back(std::move(material));
  return int(materials.size()) - 1;
}

int Document::add_mesh(std::string mesh_name, Mesh mesh, int material) {
  const auto& texture = materials[std::size_t(material)].texture;
  if (texture) scale_uv(mesh, glm::vec2(1.0f / texture->width));
  compute_tangents(mesh);
  meshes.push_back({std::move(mesh_name), std::move(mesh), material});
  return int(meshes.size()) - 1;
}

int Document::add_node(Node node) {
  nodes.push_back(std::move(node));
  return int(nodes.size()) - 1;
}

int Document::place(int mesh, glm::vec3 translation, float turn_degrees, glm::vec3 scale) {
  Node node;
  node.name = meshes[std::size_t(mesh)].name;
  node.translation = translation;
  node.rotation = glm::angleAxis(glm::radians(turn_degrees), glm::vec3(0, 1, 0));
  node.scale = scale;
  node.mesh = mesh;
  return add_node(std::move(node));
}

int Document::add_camera(const std::string& camera_name, glm::vec3 eye, glm::vec3 target,
                         float vertical_fov_degrees) {
  cameras.push_back({camera_name, glm::radians(vertical_fov_degrees)});
  Node node;
  node.name = camera_name;
  node.translation = eye;
  node.rotation = look_rotation(eye, target);
  node.camera = int(cameras.size()) - 1;
  return add_node(std::move(node));
}

int Document::add_light(Light light, Node node) {
  node.name = light.name;
  lights.push_back(std::move(light));
  node.light = int(lights.size()) - 1;
  return add_node(std::move(node));
}

std::size_t Document::drawn_triangles() const {
  std::size_t triangles = 0;
  for (const Node& node : nodes) {
    if (node.mesh >= 0) triangles += meshes[std::size_t(node.mesh)].mesh.triangle_count();
  }
  return triangles;
}

std::size_t Document::instance_count() const {
  std::size_t count = 0;
  for (const Node& node : nodes) count += node.mesh >= 0;
  return count;
}

void apply(const Sweep& sweep, Document& document) {
  for (Material& material : document.materials) {
    if (material.swept && sweep.roughness) material.uniform_roughness = sweep.roughness;
  }
  for (Node& node : document.nodes) {
    if (node.angular_diameter && sweep.shadow_angle) node.angular_diameter = sweep.shadow_angle;
  }
}

glm::quat look_rotation(glm::vec3 eye, glm::vec3 target) {
  const glm::vec3 forward = glm::normalize(target - eye);
  const float turn = std::atan2(-forward.x, -forward.z);
  const float tilt = std::asin(forward.y);
  return glm::angleAxis(turn, glm::vec3(0, 1, 0)) * glm::angleAxis(tilt, glm::vec3(1, 0, 0));
}

glm::vec3 direction_to_sun(float elevation, float azimuth) {
  const float e = glm::radians(elevation);
  const float a = glm::radians(azimuth);
  return {std::cos(e) * std::sin(a), std::sin(e), std::cos(e) * std::cos(a)};
}

}  // namespace heliograph::scenes
