#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "scene/byte_budget.hpp"
#include "scene/gltf/document/accessors.hpp"
#include "scene/gltf/document/gltf_file.hpp"
#include "scene/warnings.hpp"

namespace heliograph::scene {

/// Compressed geometry of KHR_draco_mesh_compression.
struct DracoGeometry {
  std::string path;  // for errors: "meshes[0].primitives[1].extensions.KHR_draco_mesh_compression"
  std::span<const std::uint8_t> bytes;
  std::map<std::string, std::uint32_t, std::less<>> attributes;  // name -> id in the stream
};

/// The accessors of one triangle primitive, with types and counts checked.
struct Primitive {
  enum class Mode { triangles = 4, strip = 5, fan = 6 };

  /// The accessors of a morph target.
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
  std::array<std::optional<std::uint32_t>, 2> joints;  // each set requires its weights
  std::array<std::optional<std::uint32_t>, 2> weights;
  std::vector<Target> targets;
  std::optional<DracoGeometry> draco;  // replaces the accessors' bytes

  /// Calls `visit(name, accessor)` for each attribute that the primitive has.
  template <typename Visit>
  void for_each_attribute(const Visit& visit) {
    visit("POSITION", position);
    if (normal) visit("NORMAL", *normal);
    if (tangent) visit("TANGENT", *tangent);
    if (color) visit("COLOR_0", *color);
    for (std::size_t set = 0; set < uv.size(); ++set) {
      const std::string number = std::to_string(set);
      if (uv[set]) visit("TEXCOORD_" + number, *uv[set]);
      if (joints[set]) visit("JOINTS_" + number, *joints[set]);
      if (weights[set]) visit("WEIGHTS_" + number, *weights[set]);
    }
  }

  bool deforms() const { return joints[0] || !targets.empty(); }
};

/// All triangle primitives, and which of them form each mesh of the document.
struct PrimitiveTable {
  std::vector<Primitive> primitives;
  std::vector<std::vector<std::uint32_t>> of_mesh;
};

/// Points and lines are left out with a warning. Materials are those of `variant` if given. Charges
/// `budget` with the memory of the geometry.
/// @throws ImportError, LoadCancelled
PrimitiveTable read_primitives(const GltfFile& file, std::span<const Accessor> accessors,
                               std::optional<std::uint32_t> variant, const ImportLimits& limits,
                               ByteBudget& budget, Warnings& warnings, const std::stop_token& stop);

}  // namespace heliograph::scene
