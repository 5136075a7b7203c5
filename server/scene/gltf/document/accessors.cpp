#include "scene/gltf/document/accessors.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "scene/gltf/document/extension_value.hpp"
#include "scene/import_error.hpp"

namespace heliograph::scene {
namespace {

std::uint32_t component_size(ComponentType type) {
  switch (type) {
    case ComponentType::i8:
    case ComponentType::u8:
      return 1;
    case ComponentType::i16:
    case ComponentType::u16:
      return 2;
    case ComponentType::u32:
    case ComponentType::f32:
      return 4;
  }
  return 4;
}

ElementType to_element(int type) {
  switch (type) {
    case TINYGLTF_TYPE_VEC2:
      return ElementType::vec2;
    case TINYGLTF_TYPE_VEC3:
      return ElementType::vec3;
    case TINYGLTF_TYPE_VEC4:
      return ElementType::vec4;
    case TINYGLTF_TYPE_MAT2:
      return ElementType::mat2;
    case TINYGLTF_TYPE_MAT3:
      return ElementType::mat3;
    case TINYGLTF_TYPE_MAT4:
      return ElementType::mat4;
    default:
      return ElementType::scalar;
  }
}

// `count` elements of `size` bytes, `stride` apart, from `offset`: within the view?
std::span<const std::uint8_t> checked_range(const std::string& place, const BufferView& view,
                                            std::uint64_t offset, std::uint64_t count,
                                            std::uint32_t stride, std::uint32_t size) {
  // `count` fits 32 bits and the stride 8, so that this cannot wrap.
  const std::uint64_t needed = count == 0 ? 0 : (count - 1) * stride + size;
  if (offset > view.bytes.size() || needed > view.bytes.size() - offset) {
    refuse_at(place, "reaches past the end of its buffer view");
  }
  return view.bytes.subspan(offset, needed);
}

template <typename T>
T load(const std::uint8_t* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

float load_component(const std::uint8_t* bytes, ComponentType type, bool normalized) {
  switch (type) {
    case ComponentType::i8: {
      const float value = load<std::int8_t>(bytes);
      return normalized ? std::max(value / 127.0f, -1.0f) : value;
    }
    case ComponentType::u8:
      return load<std::uint8_t>(bytes) / (normalized ? 255.0f : 1.0f);
    case ComponentType::i16: {
      const float value = load<std::int16_t>(bytes);
      return normalized ? std::max(value / 32767.0f, -1.0f) : value;
    }
    case ComponentType::u16:
      return load<std::uint16_t>(bytes) / (normalized ? 65535.0f : 1.0f);
    case ComponentType::u32:
      return static_cast<float>(load<std::uint32_t>(bytes));
    case ComponentType::f32:
      return load<float>(bytes);
  }
  return 0.0f;
}

std::uint32_t load_unsigned(const std::uint8_t* bytes, ComponentType type) {
  switch (type) {
    case ComponentType::u8:
      return load<std::uint8_t>(bytes);
    case ComponentType::u16:
      return load<std::uint16_t>(bytes);
    default:
      return load<std::uint32_t>(bytes);
  }
}

bool is_index_type(ComponentType type) {
  return type == ComponentType::u8 || type == ComponentType::u16 || type == ComponentType::u32;
}

/// Calls `store(element, component, value)` for the first `components` components of the first
/// `count` elements.
template <typename Store>
void read_elements(const Accessor& accessor, int components, std::size_t count,
                   const Store& store) {
  const std::uint32_t size = component_size(accessor.component);
  const int available =
      std::min<int>(components, static_cast<int>(component_count(accessor.element)));
  const auto load_element = [&](const std::uint8_t* bytes, std::size_t element) {
    for (int i = 0; i < available; ++i) {
      const float value = load_component(bytes + i * size, accessor.component, accessor.normalized);
      if (!std::isfinite(value)) accessor.refuse("holds a number that is not finite");
      store(element, i, value);
    }
  };
  if (!accessor.bytes.empty()) {
    for (std::size_t i = 0; i < count; ++i) {
      load_element(accessor.bytes.data() + i * accessor.stride, i);
    }
  }
  if (accessor.sparse) {
    const std::uint32_t size_in_file = element_bytes(accessor.element, accessor.component);
    for (std::size_t i = 0; i < accessor.sparse->indices.size(); ++i) {
      if (accessor.sparse->indices[i] >= count) break;  // they ascend
      load_element(accessor.sparse->values.data() + i * size_in_file, accessor.sparse->indices[i]);
    }
  }
}

Accessor::Sparse read_sparse(const tinygltf::Accessor& document, const GltfFile& file,
                             const Accessor& accessor) {
  const auto& sparse = document.sparse;
  const std::string place = accessor.path + ".sparse";
  const auto count = static_cast<std::uint64_t>(sparse.count);
  if (count > accessor.count) refuse_at(place, "count", "must be from 1 to the accessor's count");

  const auto index_type = static_cast<ComponentType>(sparse.indices.componentType);
  const std::uint32_t index_size = component_size(index_type);
  const std::string indices = place + ".indices";
  const auto index_bytes = checked_range(
      indices, file.views()[static_cast<std::size_t>(sparse.indices.bufferView)],
      static_cast<std::uint64_t>(sparse.indices.byteOffset), count, index_size, index_size);

  Accessor::Sparse result;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t index = load_unsigned(index_bytes.data() + i * index_size, index_type);
    if (index >= accessor.count) {
      refuse_at(indices, "index " + std::to_string(index) + " is out of range");
    }
    if (i > 0 && index <= result.indices.back()) refuse_at(indices, "must ascend");
    result.indices.push_back(index);
  }

  const std::uint32_t size = element_bytes(accessor.element, accessor.component);
  result.values = checked_range(
      place + ".values", file.views()[static_cast<std::size_t>(sparse.values.bufferView)],
      static_cast<std::uint64_t>(sparse.values.byteOffset), count, size, size);
  return result;
}

Accessor read_accessor(const tinygltf::Accessor& document, std::string path, const GltfFile& file,
                       const ImportLimits& limits) {
  Accessor result;
  result.path = std::move(path);
  result.component = static_cast<ComponentType>(document.componentType);
  result.element = to_element(document.type);
  result.normalized = document.normalized;
  if (document.count > 3 * limits.triangles) {
    refuse_at(result.path, "count",
              std::to_string(document.count) + " exceeds the limit of " +
                  std::to_string(3 * limits.triangles) + " elements");
  }
  result.count = static_cast<std::uint32_t>(document.count);
  const std::uint32_t size = element_bytes(result.element, result.component);
  result.stride = size;
  if (const auto view = to_index(document.bufferView)) {
    const BufferView& source = file.views()[*view];
    if (source.stride != 0) result.stride = source.stride;
    if (result.stride < size) result.refuse("is wider than its buffer view's byteStride");
    result.bytes =
        checked_range(result.path, source, document.byteOffset, result.count, result.stride, size);
  }
  if (document.sparse.isSparse) result.sparse = read_sparse(document, file, result);
  return result;
}

}  // namespace

// Columns of a matrix start on 4-byte boundaries (glTF 3.6.2.4).
std::uint32_t element_bytes(ElementType element, ComponentType component) {
  const std::uint32_t size = component_size(component);
  const auto matrix = [&](std::uint32_t dimension) {
    return dimension * ((dimension * size + 3) / 4 * 4);
  };
  switch (element) {
    case ElementType::mat2:
      return matrix(2);
    case ElementType::mat3:
      return matrix(3);
    case ElementType::mat4:
      return matrix(4);
    default:
      return component_count(element) * size;
  }
}

void Accessor::refuse(std::string_view reason) const {
  refuse_at(path, reason);
}

std::uint32_t component_count(ElementType type) {
  switch (type) {
    case ElementType::scalar:
      return 1;
    case ElementType::vec2:
      return 2;
    case ElementType::vec3:
      return 3;
    case ElementType::vec4:
    case ElementType::mat2:
      return 4;
    case ElementType::mat3:
      return 9;
    case ElementType::mat4:
      return 16;
  }
  return 1;
}

std::vector<Accessor> read_accessors(const GltfFile& file, const ImportLimits& limits,
                                     const std::stop_token& stop) {
  std::vector<Accessor> result;
  std::uint64_t replacements = 0;
  for (const tinygltf::Accessor& document : file.model().accessors) {
    throw_if_cancelled(stop);
    result.push_back(
        read_accessor(document, item_path("", "accessors", result.size()), file, limits));
    // Accessors may share the bytes of their sparse values, so that the file's size is no limit.
    if (result.back().sparse) replacements += result.back().sparse->indices.size();
    if (replacements > 3 * limits.triangles) {
      result.back().refuse("exceeds the limit of " + std::to_string(3 * limits.triangles) +
                           " sparse elements for the whole scene");
    }
  }
  return result;
}

template <int components>
std::vector<glm::vec<components, float>> read_vectors(const Accessor& accessor) {
  using Vector = glm::vec<components, float>;
  std::vector<Vector> result(accessor.count, Vector(0.0f));
  read_elements(
      accessor, components, accessor.count,
      [&](std::size_t element, int component, float value) { result[element][component] = value; });
  return result;
}

template std::vector<glm::vec2> read_vectors<2>(const Accessor&);
template std::vector<glm::vec3> read_vectors<3>(const Accessor&);
template std::vector<glm::vec4> read_vectors<4>(const Accessor&);

std::vector<float> read_numbers(const Accessor& accessor) {
  const std::size_t width = component_count(accessor.element);
  std::vector<float> result(accessor.count * width, 0.0f);
  read_elements(accessor, static_cast<int>(width), accessor.count,
                [&](std::size_t element, std::size_t component, float value) {
                  result[element * width + component] = value;
                });
  return result;
}

std::vector<glm::mat4> read_matrices(const Accessor& accessor, std::size_t count) {
  std::vector<glm::mat4> result(count, glm::mat4(0.0f));
  read_elements(accessor, 16, count, [&](std::size_t element, int component, float value) {
    result[element][component / 4][component % 4] = value;
  });
  return result;
}

std::vector<std::uint32_t> read_vertex_indices(const Accessor& accessor,
                                               std::uint32_t vertex_count) {
  if (accessor.element != ElementType::scalar || !is_index_type(accessor.component) ||
      accessor.normalized) {
    accessor.refuse("cannot hold indices: they are unsigned, unnormalised scalars");
  }
  std::vector<std::uint32_t> result(accessor.count, 0);
  if (!accessor.bytes.empty()) {
    for (std::size_t i = 0; i < result.size(); ++i) {
      result[i] = load_unsigned(accessor.bytes.data() + i * accessor.stride, accessor.component);
    }
  }
  if (accessor.sparse) {
    const std::uint32_t size = component_size(accessor.component);
    for (std::size_t i = 0; i < accessor.sparse->indices.size(); ++i) {
      result[accessor.sparse->indices[i]] =
          load_unsigned(accessor.sparse->values.data() + i * size, accessor.component);
    }
  }
  for (const std::uint32_t index : result) {
    if (index >= vertex_count) {
      accessor.refuse("index " + std::to_string(index) + " is out of range: there are " +
                      std::to_string(vertex_count) + " vertices");
    }
  }
  return result;
}

}  // namespace heliograph::scene
