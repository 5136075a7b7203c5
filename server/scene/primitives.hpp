#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/accessors.hpp"
#include "scene/gltf_file.hpp"
#include "scene/warnings.hpp"

namespace heliograph::scene {

/// One triangle primitive of the document: which accessors it is made of, types and counts checked.
struct Primitive {
  enum class Mode { triangles = 4, strip = 5, fan = 6 };

  /// What a morph target changes.
  struct Target {
    std::optional<std::uint32_t> position;
    std::optional<std::uint32_t> normal;
    std::optional<std::uint32_t> tangent;
  };

  std::string name;
  Mode mode = Mode::triangles;
  std::uint32_t position = 0;
  std::optional<std::uint32_t> normal;
  std::optional<std::uint32_t> tangent;
  std::array<std::optional<std::uint32_t>, 2> uv;
  std::optional<std::uint32_t> color;
  std::optional<std::uint32_t> indices;
  std::optional<std::uint32_t> material;
  std::array<std::optional<std::uint32_t>, 2> joints;  // both or none of a set with its weights
  std::array<std::optional<std::uint32_t>, 2> weights;
  std::vector<Target> targets;

  bool deforms() const { return joints[0] || !targets.empty(); }
};

/// All primitives that have triangles, and which of them make up each mesh of the document.
struct PrimitiveTable {
  std::vector<Primitive> primitives;
  std::vector<std::vector<std::uint32_t>> of_mesh;
};

/// Points and lines are left out with a warning.
/// @throws ImportError
PrimitiveTable read_primitives(const JsonValue& root, std::span<const Accessor> accessors,
                               std::size_t material_count, const ImportLimits& limits,
                               Warnings& warnings);

}  // namespace heliograph::scene
