#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "scene/gltf/document/gltf_file.hpp"

namespace heliograph::scene {

enum class ComponentType { i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, u32 = 5125, f32 = 5126 };
enum class ElementType { scalar, vec2, vec3, vec4, mat2, mat3, mat4 };

/// A typed array of the file, with all ranges checked against its buffers.
struct Accessor {
  /// Sparse values: indices ascend and are below `count`.
  struct Sparse {
    std::vector<std::uint32_t> indices;
    std::span<const std::uint8_t> values;  // tightly packed
  };

  std::string path;                     // for errors: "accessors[3]"
  std::span<const std::uint8_t> bytes;  // empty: all elements are zero
  std::uint32_t stride = 0;
  std::uint32_t count = 0;
  ComponentType component = ComponentType::f32;
  ElementType element = ElementType::scalar;
  bool normalized = false;
  std::optional<Sparse> sparse;

  [[noreturn]] void refuse(std::string_view reason) const;
};

/// Number of components: 4 for mat2, 16 for mat4.
std::uint32_t component_count(ElementType type);

/// Bytes of one element, tightly packed.
std::uint32_t element_bytes(ElementType element, ComponentType component);

/// @throws ImportError, LoadCancelled
std::vector<Accessor> read_accessors(const GltfFile& file, const ImportLimits& limits,
                                     const std::stop_token& stop);

/// All elements as float vectors, normalized integers mapped per glTF 3.11; missing components are
/// 0. For scalars and vectors only.
/// @throws ImportError when an element is not finite
template <int components>
std::vector<glm::vec<components, float>> read_vectors(const Accessor& accessor);

/// All components of all elements, one after the other. For scalars and vectors only.
/// @throws ImportError when one is not finite
std::vector<float> read_numbers(const Accessor& accessor);

/// The first `count` elements of an accessor of float 4x4 matrices, which has as many.
/// @throws ImportError when one is not finite
std::vector<glm::mat4> read_matrices(const Accessor& accessor, std::size_t count);

/// All elements of an index accessor (unsigned scalar), widened to 32 bits.
/// @throws ImportError when the type does not fit or an index is not below `vertex_count`
std::vector<std::uint32_t> read_vertex_indices(const Accessor& accessor,
                                               std::uint32_t vertex_count);

}  // namespace heliograph::scene
