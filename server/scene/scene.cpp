#include "scene/scene.hpp"

#include <cmath>
#include <cstddef>
#include <set>

#include "scene/environment.hpp"

namespace heliograph::scene {
namespace {

// std430 layouts: the device reads these structs as they are.
static_assert(sizeof(shared::Vertex) == 64);
static_assert(offsetof(shared::Vertex, color_rg) == 12 && offsetof(shared::Vertex, normal) == 16);
static_assert(offsetof(shared::Vertex, tangent) == 32 && offsetof(shared::Vertex, uv1) == 56);
static_assert(sizeof(shared::TextureSlot) == 48);
static_assert(sizeof(shared::Material) == 320 && sizeof(shared::Material) % 16 == 0);
static_assert(offsetof(shared::Material, alpha_cutoff) == 28);
static_assert(offsetof(shared::Material, base_color_texture) == 80);
static_assert(sizeof(shared::Mesh) == 16);
static_assert(sizeof(shared::Instance) == 208 && offsetof(shared::Instance, mesh) == 192);
static_assert(sizeof(shared::Light) == 80);
static_assert(offsetof(shared::Light, direction) == 16 && offsetof(shared::Light, color) == 32);

}  // namespace

void Bounds::include(const glm::vec3& point) {
  minimum = glm::min(minimum, point);
  maximum = glm::max(maximum, point);
}

void Bounds::include(const Bounds& other) {
  minimum = glm::min(minimum, other.minimum);
  maximum = glm::max(maximum, other.maximum);
}

Bounds world_bounds(const Bounds& mesh, const glm::mat4& world) {
  Bounds bounds;
  if (mesh.empty()) return bounds;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 point(corner & 1 ? mesh.maximum.x : mesh.minimum.x,
                          corner & 2 ? mesh.maximum.y : mesh.minimum.y,
                          corner & 4 ? mesh.maximum.z : mesh.minimum.z);
    bounds.include(glm::vec3(world * glm::vec4(point, 1.0f)));
  }
  return bounds;
}

float length_scale(const glm::mat4& world) {
  const double determinant = glm::determinant(glm::dmat3(world));  // floats would overflow
  return static_cast<float>(std::cbrt(std::abs(determinant)));
}

glm::mat4 Transform::matrix() const {
  glm::mat4 matrix = glm::mat4_cast(rotation);
  for (int axis = 0; axis < 3; ++axis) matrix[axis] *= scale[axis];
  matrix[3] = glm::vec4(translation, 1.0f);
  return matrix;
}

// Translation * rotation * scale. The sample matrix in the text of KHR_texture_transform rotates
// the other way; its test model and the implementations agree on this one
// (github.com/KhronosGroup/glTF/issues/1563).
void TextureTransform::apply(shared::TextureSlot& slot) const {
  const float cosine = std::cos(rotation);
  const float sine = std::sin(rotation);
  slot.transform_row0 = {cosine * scale.x, sine * scale.y, offset.x, 0.0f};
  slot.transform_row1 = {-sine * scale.x, cosine * scale.y, offset.y, 0.0f};
}

std::uint64_t Scene::bytes() const {
  const auto size = [](const auto& list) { return std::uint64_t{list.size() * sizeof(list[0])}; };
  std::uint64_t sum = size(nodes) + size(materials) + size(instances) + size(alpha_heap);
  for (const Mesh& mesh : meshes) sum += size(mesh.vertices) + size(mesh.indices);
  std::set<const void*> files;  // one file may be used as color and as data
  for (const Image& image : images) {
    sum += size(image.pixels);
    if (image.file && files.insert(image.file.get()).second) sum += size(*image.file);
  }
  for (const Shape& shape : shapes) {
    sum += size(shape.vertices) + size(shape.influences);
    for (const MorphTarget& target : shape.targets) {
      sum += size(target.positions) + size(target.normals) + size(target.tangents);
    }
  }
  for (const Clip& clip : clips) {
    for (const Channel& channel : clip.channels) sum += size(channel.times) + size(channel.values);
    for (const Track& track : clip.tracks) sum += size(track.times) + size(track.values);
  }
  if (environment) sum += size(environment->radiance);
  return sum;
}

std::uint64_t Scene::triangle_count() const {
  std::uint64_t count = 0;
  for (const Instance& instance : instances) count += meshes[instance.mesh].indices.size() / 3;
  return count;
}

}  // namespace heliograph::scene
