#include "scene/gltf/geometry/primitives.hpp"

#include <algorithm>

#include "scene/gltf/document/extension_value.hpp"
#include "scene/gltf/document/variants.hpp"
#include "scene/gltf/geometry/draco.hpp"
#include "scene/import_error.hpp"
#include "scene/scene.hpp"

namespace heliograph::scene {
namespace {

bool uses_quantization(const tinygltf::Model& model) {
  const auto lists_it = [](const std::vector<std::string>& extensions) {
    return std::ranges::find(extensions, "KHR_mesh_quantization") != extensions.end();
  };
  return lists_it(model.extensionsUsed) || lists_it(model.extensionsRequired);
}

class PrimitiveReader {
 public:
  PrimitiveReader(const GltfFile& file, std::span<const Accessor> accessors,
                  std::optional<std::uint32_t> variant, const ImportLimits& limits,
                  ByteBudget& budget, Warnings& warnings)
      : file_(file),
        accessors_(accessors),
        variant_(variant),
        quantized_(uses_quantization(file.model())),
        limits_(limits),
        budget_(budget),
        warnings_(warnings) {}

  /// Nullopt for points, lines and primitives without a triangle.
  std::optional<Primitive> read(const tinygltf::Primitive& document, const std::string& path) {
    const Attributes attributes{document.attributes, path + ".attributes"};
    Primitive primitive;
    const auto position = attribute(attributes, "POSITION", ElementType::vec3);
    primitive.normal = attribute(attributes, "NORMAL", ElementType::vec3);
    primitive.tangent = attribute(attributes, "TANGENT", ElementType::vec4);
    primitive.uv[0] = attribute(attributes, "TEXCOORD_0", ElementType::vec2);
    primitive.uv[1] = attribute(attributes, "TEXCOORD_1", ElementType::vec2);
    primitive.color = color_attribute(attributes);
    read_joints(attributes, primitive);
    check_counts(attributes);
    read_targets(document, path, primitive);
    primitive.indices = to_index(document.indices);
    primitive.material = to_index(document.material);
    if (variant_) {
      const auto other = material_of_variant(document, *variant_);
      if (other) primitive.material = other;
    }
    if (document.mode < TINYGLTF_MODE_TRIANGLES) {
      warnings_.add("points and lines are not drawn");
      return std::nullopt;
    }
    if (!position) {
      warnings_.add(path + " has no positions and was left out");
      return std::nullopt;
    }
    primitive.mode = static_cast<Primitive::Mode>(document.mode);
    primitive.position = *position;
    read_draco(document, path, primitive);
    if (!count_triangles(path, primitive)) return std::nullopt;
    return primitive;
  }

 private:
  /// The accessors of a primitive's attributes, or of a morph target, and how errors name them.
  struct Attributes {
    const std::map<std::string, int>& accessors;
    std::string path;

    std::optional<std::uint32_t> find(const std::string& name) const {
      const auto found = accessors.find(name);
      return found == accessors.end() ? std::nullopt : to_index(found->second);
    }
    [[noreturn]] void refuse(std::string_view name, std::string_view reason) const {
      refuse_at(path, name, reason);
    }
  };

  std::optional<std::uint32_t> attribute(const Attributes& attributes, const std::string& name,
                                         ElementType type) {
    const auto index = attributes.find(name);
    if (!index) return index;
    if (accessors_[*index].element != type) attributes.refuse(name, "has the wrong element type");
    check_component(attributes, name, accessors_[*index].component);
    return index;
  }

  void check_component(const Attributes& attributes, const std::string& name,
                       ComponentType component) {
    if (component == ComponentType::u32) attributes.refuse(name, "has the wrong component type");
    const bool of_floats = name == "POSITION" || name == "NORMAL" || name == "TANGENT";
    if (of_floats && component != ComponentType::f32 && !quantized_) {
      attributes.refuse(name, "must contain floats without KHR_mesh_quantization");
    }
  }

  std::optional<std::uint32_t> color_attribute(const Attributes& attributes) {
    const auto index = attributes.find("COLOR_0");
    if (!index) return index;
    const ElementType type = accessors_[*index].element;
    if (type != ElementType::vec3 && type != ElementType::vec4) {
      attributes.refuse("COLOR_0", "has the wrong element type");
    }
    check_component(attributes, "COLOR_0", accessors_[*index].component);
    return index;
  }

  // All attributes, known or not, must have the same count.
  void check_counts(const Attributes& attributes) {
    std::optional<std::uint32_t> count;
    for (const auto& [name, accessor] : attributes.accessors) {
      const std::uint32_t own = accessors_[static_cast<std::size_t>(accessor)].count;
      if (count && own != *count) {
        attributes.refuse(name, "differs in count from the other attributes");
      }
      count = own;
    }
    vertex_count_ = count.value_or(0);
  }

  void read_joints(const Attributes& attributes, Primitive& primitive) {
    for (std::size_t set = 0; set < primitive.joints.size(); ++set) {
      const std::string number = std::to_string(set);
      const auto joints = attribute(attributes, "JOINTS_" + number, ElementType::vec4);
      const auto weights = attribute(attributes, "WEIGHTS_" + number, ElementType::vec4);
      if (joints.has_value() != weights.has_value()) {
        attributes.refuse((joints ? "WEIGHTS_" : "JOINTS_") + number, "is missing");
      }
      if (!joints) return;
      const Accessor& numbers = accessors_[*joints];
      if (numbers.normalized ||
          (numbers.component != ComponentType::u8 && numbers.component != ComponentType::u16)) {
        attributes.refuse("JOINTS_" + number, "has the wrong component type");
      }
      primitive.joints[set] = joints;
      primitive.weights[set] = weights;
    }
    if (attributes.find("JOINTS_2")) {
      warnings_.add("more than 8 joints for a vertex are left out");
    }
  }

  void read_targets(const tinygltf::Primitive& document, const std::string& path,
                    Primitive& primitive) {
    for (const auto& accessors : document.targets) {
      const Attributes target{accessors, item_path(path, "targets", primitive.targets.size())};
      for (const auto& [name, accessor] : accessors) {
        if (accessors_[static_cast<std::size_t>(accessor)].count != vertex_count_) {
          target.refuse(name, "differs in count from its primitive");
        }
      }
      primitive.targets.push_back({attribute(target, "POSITION", ElementType::vec3),
                                   attribute(target, "NORMAL", ElementType::vec3),
                                   attribute(target, "TANGENT", ElementType::vec3)});
    }
  }

  void read_draco(const tinygltf::Primitive& document, const std::string& path,
                  Primitive& primitive) {
    const auto packed = find_extension(document.extensions, "KHR_draco_mesh_compression", path);
    if (!packed) return;
    if (primitive.mode == Primitive::Mode::fan) {
      packed->refuse("is for triangles and strips only");
    }
    DracoGeometry& geometry = primitive.draco.emplace();
    geometry.path = packed->path();
    geometry.bytes = file_.views()[*packed->index("bufferView")].bytes;
    const auto attributes = packed->object("attributes");
    if (!attributes) return;
    for (const std::string& name : attributes->members()) {
      if (!document.attributes.contains(name)) {
        attributes->refuse(name, "is not an attribute of the primitive");
      }
      geometry.attributes[name] = static_cast<std::uint32_t>(*attributes->integer(name));
    }
  }

  /// Number of triangle corners; adds to the vertex count. For a compressed primitive the stream's
  /// counts are used, not the document's.
  std::uint64_t count_corners(const Primitive& primitive) {
    if (primitive.draco) {
      const DracoCounts counts = probe_draco(*primitive.draco);
      vertices_ += counts.vertices + vertex_count_ * primitive.targets.size();
      return 3 * counts.triangles;
    }
    vertices_ += vertex_count_ * (1 + primitive.targets.size());
    return primitive.indices ? accessors_[*primitive.indices].count : vertex_count_;
  }

  bool count_triangles(const std::string& path, const Primitive& primitive) {
    const std::uint64_t corners = count_corners(primitive);
    const bool separate = primitive.draco || primitive.mode == Primitive::Mode::triangles;
    if (corners < 3) {
      warnings_.add(path + " has no triangle and was left out");
      return false;
    }
    if (separate && corners % 3 != 0) warnings_.add(path + " ends in a part of a triangle");
    const std::uint64_t triangles = separate ? corners / 3 : corners - 2;
    triangles_ += triangles;
    if (triangles_ > limits_.triangles || vertices_ > 3 * limits_.triangles) {
      refuse_at(path, "exceeds the limit of " + std::to_string(limits_.triangles) +
                          " triangles for the whole scene");
    }
    charge(path, primitive, triangles);
    return true;
  }

  void charge(const std::string& path, const Primitive& primitive, std::uint64_t triangles) {
    // Flat triangles share no vertices.
    const std::uint64_t vertices =
        primitive.normal && !primitive.draco ? vertex_count_ : 3 * triangles;
    std::uint64_t size = sizeof(shared::Vertex) + primitive.targets.size() * 3 * sizeof(glm::vec3);
    if (primitive.joints[0]) size += 8 * sizeof(JointWeight);
    budget_.take(vertices, size, path);
    budget_.take(triangles, 3 * sizeof(std::uint32_t), path);
  }

  const GltfFile& file_;
  std::span<const Accessor> accessors_;
  std::optional<std::uint32_t> variant_;
  bool quantized_;
  const ImportLimits& limits_;
  ByteBudget& budget_;
  Warnings& warnings_;
  std::uint32_t vertex_count_ = 0;
  std::uint64_t triangles_ = 0;
  std::uint64_t vertices_ = 0;
};

}  // namespace

PrimitiveTable read_primitives(const GltfFile& file, std::span<const Accessor> accessors,
                               std::optional<std::uint32_t> variant, const ImportLimits& limits,
                               ByteBudget& budget, Warnings& warnings,
                               const std::stop_token& stop) {
  PrimitiveTable table;
  PrimitiveReader reader(file, accessors, variant, limits, budget, warnings);
  for (const tinygltf::Mesh& mesh : file.model().meshes) {
    const std::string path = item_path("", "meshes", table.of_mesh.size());
    std::vector<std::uint32_t>& members = table.of_mesh.emplace_back();
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
      throw_if_cancelled(stop);
      auto primitive = reader.read(mesh.primitives[i], item_path(path, "primitives", i));
      if (!primitive) continue;
      primitive->name =
          mesh.primitives.size() == 1 ? mesh.name : mesh.name + "." + std::to_string(i);
      members.push_back(static_cast<std::uint32_t>(table.primitives.size()));
      table.primitives.push_back(std::move(*primitive));
    }
  }
  return table;
}

}  // namespace heliograph::scene
