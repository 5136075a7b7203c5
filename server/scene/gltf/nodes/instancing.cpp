#include "scene/gltf/nodes/instancing.hpp"

#include <string>

#include "scene/gltf/document/extension_value.hpp"

namespace heliograph::scene {
namespace {

/// The values of one attribute, or `fallback` for each of the `count` instances.
template <int components>
std::vector<glm::vec<components, float>> read_places(const ExtensionValue& attributes,
                                                     const std::string& name, ElementType type,
                                                     std::span<const Accessor> accessors,
                                                     std::uint32_t count,
                                                     const glm::vec<components, float>& fallback) {
  const auto index = attributes.index(name);
  if (!index) return std::vector<glm::vec<components, float>>(count, fallback);
  const Accessor& accessor = accessors[*index];
  if (accessor.element != type) attributes.refuse(name, "has the wrong element type");
  const bool whole = accessor.component != ComponentType::f32;
  if (whole && !(type == ElementType::vec4 && accessor.normalized)) {
    attributes.refuse(name, "has the wrong component type");
  }
  return read_vectors<components>(accessor);
}

std::uint32_t count_places(const ExtensionValue& attributes, std::span<const Accessor> accessors) {
  std::optional<std::uint32_t> count;
  for (const std::string& name : attributes.members()) {
    const std::uint32_t index = *attributes.index(name);
    if (count && accessors[index].count != *count) {
      attributes.refuse(name, "differs in count from the other attributes");
    }
    count = accessors[index].count;
  }
  if (!count) attributes.refuse("must have at least one attribute");
  return *count;
}

glm::quat to_rotation(const ExtensionValue& attributes, const glm::vec4& value) {
  const float length = glm::length(value);
  if (!(length > 1e-6f)) attributes.refuse("ROTATION", "contains a quaternion of zero length");
  return {value.w / length, value.x / length, value.y / length, value.z / length};
}

}  // namespace

std::optional<std::vector<Transform>> read_instancing(const tinygltf::Node& node,
                                                      const std::string& path,
                                                      std::span<const Accessor> accessors,
                                                      std::uint64_t limit) {
  const auto extension = find_extension(node.extensions, "EXT_mesh_gpu_instancing", path);
  if (!extension) return std::nullopt;
  const auto attributes = extension->object("attributes");
  if (!attributes) extension->refuse("attributes", "must have at least one attribute");
  const std::uint32_t count = count_places(*attributes, accessors);
  if (count > limit) {
    extension->refuse("exceeds the limit of " + std::to_string(limit) + " instances");
  }
  const auto translations = read_places<3>(*attributes, "TRANSLATION", ElementType::vec3, accessors,
                                           count, glm::vec3(0.0f));
  const auto rotations = read_places<4>(*attributes, "ROTATION", ElementType::vec4, accessors,
                                        count, glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
  const auto scales =
      read_places<3>(*attributes, "SCALE", ElementType::vec3, accessors, count, glm::vec3(1.0f));
  std::vector<Transform> instance_transforms(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    instance_transforms[i] = {translations[i], to_rotation(*attributes, rotations[i]), scales[i]};
  }
  return instance_transforms;
}

}  // namespace heliograph::scene
