#include "scene/gltf/geometry/primitives.hpp"

#include "scene/gltf/document/variants.hpp"
#include "scene/gltf/geometry/draco.hpp"
#include "scene/scene.hpp"

namespace heliograph::scene {
namespace {

class PrimitiveReader {
 public:
  PrimitiveReader(const GltfFile& file, std::span<const Accessor> accessors,
                  std::size_t material_count, std::optional<std::uint32_t> variant,
                  const ImportLimits& limits, ByteBudget& budget, Warnings& warnings)
      : file_(file),
        accessors_(accessors),
        material_count_(material_count),
        variant_(variant),
        limits_(limits),
        budget_(budget),
        warnings_(warnings) {}

  /// Nullopt for points, lines and primitives without a triangle.
  std::optional<Primitive> read(const JsonValue& json) {
    const std::uint64_t mode = json.integer("mode", 4);
    if (mode > 6) json.refuse("mode", std::to_string(mode) + " is not a primitive mode");
    const auto attributes = json.object("attributes");
    if (!attributes) json.refuse("attributes", "is missing");

    Primitive primitive;
    const auto position = attribute(*attributes, "POSITION", ElementType::vec3);
    primitive.normal = attribute(*attributes, "NORMAL", ElementType::vec3);
    primitive.tangent = attribute(*attributes, "TANGENT", ElementType::vec4);
    primitive.uv[0] = attribute(*attributes, "TEXCOORD_0", ElementType::vec2);
    primitive.uv[1] = attribute(*attributes, "TEXCOORD_1", ElementType::vec2);
    primitive.color = color_attribute(*attributes);
    read_joints(*attributes, primitive);
    check_counts(*attributes);
    read_targets(json, primitive);
    primitive.indices = json.index("indices", accessors_.size(), "accessors");
    primitive.material = json.index("material", material_count_, "materials");
    if (variant_) {
      const auto other = material_of_variant(json, *variant_);
      if (other) primitive.material = other;
    }
    if (mode < 4) {
      warnings_.add("points and lines are not drawn");
      return std::nullopt;
    }
    if (!position) {
      warnings_.add(json.path() + " has no positions and was left out");
      return std::nullopt;
    }
    primitive.mode = static_cast<Primitive::Mode>(mode);
    primitive.position = *position;
    read_draco(json, primitive);
    if (!count_triangles(json, primitive)) return std::nullopt;
    return primitive;
  }

 private:
  std::optional<std::uint32_t> attribute(const JsonValue& attributes, std::string_view name,
                                         ElementType type) {
    const auto index = attributes.index(name, accessors_.size(), "accessors");
    if (index && accessors_[*index].element != type)
      attributes.refuse(name, "has the wrong element type");
    if (index && accessors_[*index].component == ComponentType::u32) {
      attributes.refuse(name, "has the wrong component type");
    }
    return index;
  }

  std::optional<std::uint32_t> color_attribute(const JsonValue& attributes) {
    const auto index = attributes.index("COLOR_0", accessors_.size(), "accessors");
    if (!index) return index;
    const ElementType type = accessors_[*index].element;
    if (type != ElementType::vec3 && type != ElementType::vec4) {
      attributes.refuse("COLOR_0", "has the wrong element type");
    }
    if (accessors_[*index].component == ComponentType::u32) {
      attributes.refuse("COLOR_0", "has the wrong component type");
    }
    return index;
  }

  // All attributes, known or not, must have the same count.
  void check_counts(const JsonValue& attributes) {
    std::optional<std::uint32_t> count;
    for (const std::string& name : attributes.keys()) {
      const std::uint32_t index = attributes.required_index(name, accessors_.size(), "accessors");
      const std::uint32_t own = accessors_[index].count;
      if (count && own != *count)
        attributes.refuse(name, "differs in count from the other attributes");
      count = own;
    }
    vertex_count_ = count.value_or(0);
  }

  void read_joints(const JsonValue& attributes, Primitive& primitive) {
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
    if (attributes.has("JOINTS_2")) warnings_.add("more than 8 joints for a vertex are left out");
  }

  void read_targets(const JsonValue& json, Primitive& primitive) {
    for (const JsonValue& target : json.objects("targets")) {
      for (const std::string& name : target.keys()) {
        const std::uint32_t index = target.required_index(name, accessors_.size(), "accessors");
        if (accessors_[index].count != vertex_count_)
          target.refuse(name, "differs in count from its primitive");
      }
      primitive.targets.push_back({attribute(target, "POSITION", ElementType::vec3),
                                   attribute(target, "NORMAL", ElementType::vec3),
                                   attribute(target, "TANGENT", ElementType::vec3)});
    }
  }

  void read_draco(const JsonValue& json, Primitive& primitive) {
    const auto packed = json.object("extensions", "KHR_draco_mesh_compression");
    if (!packed) return;
    if (primitive.mode == Primitive::Mode::fan) {
      packed->refuse("is for triangles and strips only");
    }
    const auto attributes = packed->object("attributes");
    if (!attributes) packed->refuse("attributes", "is missing");
    DracoGeometry& geometry = primitive.draco.emplace();
    geometry.path = packed->path();
    geometry.bytes =
        file_.views()[packed->required_index("bufferView", file_.views().size(), "buffer views")]
            .bytes;
    for (const std::string& name : attributes->keys()) {
      const std::uint64_t id = attributes->required_integer(name);
      if (id > 0xffffffffu) attributes->refuse(name, "is not an identifier of 32 bits");
      if (!json.object("attributes")->has(name)) {
        attributes->refuse(name, "is not an attribute of the primitive");
      }
      geometry.attributes[name] = static_cast<std::uint32_t>(id);
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

  bool count_triangles(const JsonValue& json, const Primitive& primitive) {
    const std::uint64_t corners = count_corners(primitive);
    const bool separate = primitive.draco || primitive.mode == Primitive::Mode::triangles;
    if (corners < 3) {
      warnings_.add(json.path() + " has no triangle and was left out");
      return false;
    }
    if (separate && corners % 3 != 0) warnings_.add(json.path() + " ends in a part of a triangle");
    const std::uint64_t triangles = separate ? corners / 3 : corners - 2;
    triangles_ += triangles;
    if (triangles_ > limits_.triangles || vertices_ > 3 * limits_.triangles) {
      json.refuse("exceeds the limit of " + std::to_string(limits_.triangles) +
                  " triangles for the whole scene");
    }
    charge(json, primitive, triangles);
    return true;
  }

  void charge(const JsonValue& json, const Primitive& primitive, std::uint64_t triangles) {
    // Flat triangles share no vertices.
    const std::uint64_t vertices =
        primitive.normal && !primitive.draco ? vertex_count_ : 3 * triangles;
    std::uint64_t size = sizeof(shared::Vertex) + primitive.targets.size() * 3 * sizeof(glm::vec3);
    if (primitive.joints[0]) size += 8 * sizeof(JointWeight);
    budget_.take(vertices, size, json.path());
    budget_.take(triangles, 3 * sizeof(std::uint32_t), json.path());
  }

  const GltfFile& file_;
  std::span<const Accessor> accessors_;
  std::size_t material_count_;
  std::optional<std::uint32_t> variant_;
  const ImportLimits& limits_;
  ByteBudget& budget_;
  Warnings& warnings_;
  std::uint32_t vertex_count_ = 0;
  std::uint64_t triangles_ = 0;
  std::uint64_t vertices_ = 0;
};

}  // namespace

PrimitiveTable read_primitives(const GltfFile& file, std::span<const Accessor> accessors,
                               std::size_t material_count, std::optional<std::uint32_t> variant,
                               const ImportLimits& limits, ByteBudget& budget, Warnings& warnings) {
  PrimitiveTable table;
  PrimitiveReader reader(file, accessors, material_count, variant, limits, budget, warnings);
  for (const JsonValue& mesh : file.root().objects("meshes")) {
    const std::vector<JsonValue> primitives = mesh.objects("primitives");
    if (primitives.empty()) mesh.refuse("has no primitives");
    const std::string mesh_name = mesh.text("name");
    std::vector<std::uint32_t>& members = table.of_mesh.emplace_back();
    for (std::size_t i = 0; i < primitives.size(); ++i) {
      auto primitive = reader.read(primitives[i]);
      if (!primitive) continue;
      primitive->name = primitives.size() == 1 ? mesh_name : mesh_name + "." + std::to_string(i);
      members.push_back(static_cast<std::uint32_t>(table.primitives.size()));
      table.primitives.push_back(std::move(*primitive));
    }
  }
  return table;
}

}  // namespace heliograph::scene
