#include "scene/gltf/geometry/tangents.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "scene/import_error.hpp"

namespace heliograph::scene {
namespace {

constexpr std::uint32_t none = 0xffffffffu;

glm::vec2 transformed_uv(const shared::Vertex& vertex, const shared::TextureSlot& slot) {
  const glm::vec3 uv(slot.uv_set == 0 ? vertex.uv0 : vertex.uv1, 1.0f);
  return {glm::dot(glm::vec3(slot.transform_row0), uv),
          glm::dot(glm::vec3(slot.transform_row1), uv)};
}

// Corners share a tangent if these are equal.
using WeldKey = std::array<float, 8>;

WeldKey weld_key(const shared::Vertex& vertex, const glm::vec2& uv) {
  return {vertex.position.x,
          vertex.position.y,
          vertex.position.z,
          vertex.normal.x,
          vertex.normal.y,
          vertex.normal.z,
          uv.x,
          uv.y};
}

std::uint64_t hash_of(const WeldKey& key) {
  std::uint64_t hash = 0x9e3779b97f4a7c15ull;
  for (const float value : key) {
    // Adding zero turns -0 into +0.
    hash = (hash ^ std::bit_cast<std::uint32_t>(value + 0.0f)) * 0xff51afd7ed558ccdull;
    hash ^= hash >> 32;
  }
  return hash;
}

// For each vertex the first one that equals it: an open-addressing table of vertex numbers.
std::vector<std::uint32_t> weld(const std::vector<shared::Vertex>& vertices,
                                const std::vector<glm::vec2>& uvs, const std::stop_token& stop) {
  const std::size_t slot_count = std::bit_ceil(2 * vertices.size() + 1);
  std::vector<std::uint32_t> table(slot_count, none);
  std::vector<std::uint32_t> first(vertices.size());
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    throw_if_cancelled(stop, i);
    const WeldKey key = weld_key(vertices[i], uvs[i]);
    std::size_t slot = hash_of(key) & (slot_count - 1);
    while (table[slot] != none && weld_key(vertices[table[slot]], uvs[table[slot]]) != key) {
      slot = (slot + 1) & (slot_count - 1);
    }
    if (table[slot] == none) table[slot] = i;
    first[i] = table[slot];
  }
  return first;
}

glm::vec3 project(const glm::vec3& vector, const glm::vec3& normal) {
  return vector - normal * glm::dot(normal, vector);
}

glm::vec3 normalized_or_zero(const glm::vec3& vector) {
  const float length = glm::length(vector);
  return length > 0.0f && std::isfinite(length) ? vector / length : glm::vec3(0.0f);
}

enum class Hand : std::uint8_t { right, left, undefined };

struct FaceTangent {
  glm::vec3 direction{0.0f};  // along increasing u; zero where undefined
  Hand hand = Hand::undefined;
};

FaceTangent face_tangent(const std::array<glm::vec3, 3>& p, const std::array<glm::vec2, 3>& uv) {
  const glm::vec3 edge1 = p[1] - p[0];
  const glm::vec3 edge2 = p[2] - p[0];
  const glm::vec2 uv1 = uv[1] - uv[0];
  const glm::vec2 uv2 = uv[2] - uv[0];
  // v is negated: glTF's v runs down the image, the tangent space's y runs up.
  const float area = uv2.x * uv1.y - uv1.x * uv2.y;
  if (area == 0.0f || !std::isfinite(area)) return {};
  const glm::vec3 along_u = (edge2 * uv1.y - edge1 * uv2.y) * (area > 0.0f ? 1.0f : -1.0f);
  const glm::vec3 direction = normalized_or_zero(along_u);
  if (direction == glm::vec3(0.0f)) return {};
  return {direction, area > 0.0f ? Hand::right : Hand::left};
}

float corner_angle(const glm::vec3& to_previous, const glm::vec3& to_next,
                   const glm::vec3& normal) {
  const glm::vec3 a = normalized_or_zero(project(to_previous, normal));
  const glm::vec3 b = normalized_or_zero(project(to_next, normal));
  return std::acos(std::clamp(glm::dot(a, b), -1.0f, 1.0f));
}

class TangentBuilder {
 public:
  TangentBuilder(std::vector<shared::Vertex>& vertices, std::vector<std::uint32_t>& indices,
                 const shared::TextureSlot& normal_map, const std::stop_token& stop)
      : vertices_(vertices), indices_(indices), stop_(stop) {
    uvs_.reserve(vertices.size());
    for (const shared::Vertex& vertex : vertices)
      uvs_.push_back(transformed_uv(vertex, normal_map));
    welded_ = weld(vertices, uvs_, stop);
    sums_.resize(2 * vertices.size(), glm::vec3(0.0f));
  }

  void build() {
    std::vector<Hand> face_hands;
    face_hands.reserve(indices_.size() / 3);
    for (std::size_t i = 0; i + 2 < indices_.size(); i += 3) {
      throw_if_cancelled(stop_, i);
      face_hands.push_back(accumulate(i));
    }
    throw_if_cancelled(stop_);
    split_by_hand(face_hands);
    for (std::uint32_t i = 0; i < vertices_.size(); ++i) {
      throw_if_cancelled(stop_, i);
      finish(i);
    }
  }

 private:
  glm::vec3& sum(std::uint32_t vertex, Hand hand) {
    return sums_[2 * welded_[vertex] + (hand == Hand::left ? 1 : 0)];
  }

  Hand accumulate(std::size_t first) {
    std::array<glm::vec3, 3> p;
    std::array<glm::vec2, 3> uv;
    for (std::size_t i = 0; i < 3; ++i) {
      p[i] = vertices_[indices_[first + i]].position;
      uv[i] = uvs_[indices_[first + i]];
    }
    const FaceTangent face = face_tangent(p, uv);
    if (face.hand == Hand::undefined) return face.hand;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t vertex = indices_[first + i];
      const glm::vec3& normal = vertices_[vertex].normal;
      const float angle = corner_angle(p[(i + 2) % 3] - p[i], p[(i + 1) % 3] - p[i], normal);
      sum(vertex, face.hand) += angle * normalized_or_zero(project(face.direction, normal));
    }
    return face.hand;
  }

  void split_by_hand(const std::vector<Hand>& face_hands) {
    hands_.assign(vertices_.size(), Hand::undefined);
    std::vector<std::uint32_t> other(vertices_.size(), none);
    for (std::size_t corner = 0; corner < 3 * face_hands.size(); ++corner) {
      const Hand hand = face_hands[corner / 3];
      const std::uint32_t vertex = indices_[corner];
      if (hand == Hand::undefined || hands_[vertex] == hand) continue;
      if (hands_[vertex] == Hand::undefined) {
        hands_[vertex] = hand;
        continue;
      }
      if (other[vertex] == none) {
        other[vertex] = static_cast<std::uint32_t>(vertices_.size());
        const shared::Vertex copy = vertices_[vertex];
        vertices_.push_back(copy);
        welded_.push_back(welded_[vertex]);
        hands_.push_back(hand);
      }
      indices_[corner] = other[vertex];
    }
  }

  void finish(std::uint32_t index) {
    shared::Vertex& vertex = vertices_[index];
    // A corner without texture area takes the sum of its neighbors, of either handedness.
    Hand hand = hands_[index];
    if (hand == Hand::undefined) {
      hand = sum(index, Hand::right) != glm::vec3(0.0f) ? Hand::right : Hand::left;
    }
    glm::vec3 tangent = normalized_or_zero(project(sum(index, hand), vertex.normal));
    if (tangent == glm::vec3(0.0f)) {
      tangent = perpendicular_to(vertex.normal);
      if (hands_[index] == Hand::undefined) hand = Hand::right;
    }
    vertex.tangent = glm::vec4(tangent, hand == Hand::left ? -1.0f : 1.0f);
  }

  std::vector<shared::Vertex>& vertices_;
  std::vector<std::uint32_t>& indices_;
  const std::stop_token& stop_;
  std::vector<glm::vec2> uvs_;
  std::vector<std::uint32_t> welded_;
  std::vector<glm::vec3> sums_;  // two per welded vertex: right- and left-handed
  std::vector<Hand> hands_;
};

}  // namespace

void generate_tangents(std::vector<shared::Vertex>& vertices, std::vector<std::uint32_t>& indices,
                       const shared::TextureSlot& normal_map, const std::stop_token& stop) {
  TangentBuilder(vertices, indices, normal_map, stop).build();
}

glm::vec3 perpendicular_to(const glm::vec3& normal) {
  // Duff et al., "Building an Orthonormal Basis, Revisited", 2017.
  const float sign = std::copysign(1.0f, normal.z);
  const float a = -1.0f / (sign + normal.z);
  return {1.0f + sign * normal.x * normal.x * a, sign * normal.x * normal.y * a, -sign * normal.x};
}

}  // namespace heliograph::scene
