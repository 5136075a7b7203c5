#include "session/library/scene_description.hpp"

namespace heliograph::session {

protocol::Vec3 to_protocol(const glm::vec3& vector) {
  return {vector.x, vector.y, vector.z};
}

glm::vec3 from_protocol(const protocol::Vec3& vector) {
  return {vector[0], vector[1], vector[2]};
}

protocol::SceneInfo describe_scene(const LoadedScene& loaded) {
  const scene::Scene& scene = *loaded.scene;
  const auto count = [](const auto& list) { return static_cast<std::uint32_t>(list.size()); };
  protocol::SceneInfo info;
  info.name = loaded.name;
  info.triangles = scene.triangle_count();
  info.instances = count(scene.instances);
  info.meshes = count(scene.meshes);
  info.materials = count(scene.materials);
  info.textures = count(scene.textures);
  info.lights = count(scene.lights);
  for (const scene::Mesh& mesh : scene.meshes) info.vertices += mesh.vertices.size();
  info.nodes = count(scene.nodes);
  info.images = count(scene.images);
  for (const scene::Image& image : scene.images) {
    info.texels += std::uint64_t{image.width} * image.height;
  }
  info.deforming = count(scene.deformations);
  info.material_names = scene.material_names;
  for (const scene::Light& light : scene.lights) info.light_names.push_back(light.name);
  if (!loaded.environment.empty()) info.environment = loaded.environment;
  for (const scene::SourceFile& source : scene.sources) info.memory.file += source.bytes;
  info.memory.host = loaded.host_bytes;
  info.memory.device = loaded.device_bytes;
  for (const scene::Camera& camera : scene.cameras) info.cameras.push_back(camera.name);
  for (const scene::Clip& clip : scene.clips) info.clips.push_back({clip.name, clip.duration});
  info.scenes = scene.scenes;
  info.scene = scene.shown_scene;
  info.variants = scene.variants;
  if (scene.variant) info.variant = scene.variants[*scene.variant];
  if (!scene.bounds.empty()) {
    info.bounds = {.min = to_protocol(scene.bounds.minimum),
                   .max = to_protocol(scene.bounds.maximum)};
  }
  info.warnings = scene.warnings;
  return info;
}

}  // namespace heliograph::session
