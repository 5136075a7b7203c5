#pragma once

// The table of glTF's buffers, accessors, meshes, skins and animations, and of their extensions.

#include <array>
#include <nlohmann/json.hpp>

#include "scene/gltf/schema/place.hpp"
#include "scene/gltf/schema/schema.hpp"

namespace heliograph::scene::schema {

// Sizes are compared with the data there is. Doubles hold whole numbers up to this one, and those
// in extensions are doubles.
inline constexpr std::uint64_t most_in_double = 1ull << 53;

constexpr Member size(std::string_view name) {
  return integer(name).integers(0, Member::any_size);
}
constexpr Member size_in_extension(std::string_view name) {
  return integer(name).integers(0, most_in_double);
}

inline constexpr Member fallback_members[] = {boolean("fallback")};
inline constexpr ObjectType fallback = {fallback_members};
inline constexpr Extension buffer_extensions[] = {{"EXT_meshopt_compression", &fallback}};
inline constexpr Member buffer_members[] = {
    size("byteLength").integers(1, Member::any_size).needed(),
    uri("uri").otherwise("@"),
};
inline constexpr ObjectType buffer = {
    .members = buffer_members, .extensions = buffer_extensions, .holds_bytes = true};

/// That a view, or the packed bytes of one, lie within their buffer.
inline void check_range(const nlohmann::json& view, const Place& place,
                        const nlohmann::json& document) {
  const auto number = [](const nlohmann::json& owner, const char* name) {
    const auto found = owner.find(name);
    return found == owner.end() ? 0 : found->get<std::uint64_t>();
  };
  const nlohmann::json& buffer_json = document.at("buffers").at(number(view, "buffer"));
  const std::uint64_t available = number(buffer_json, "byteLength");
  const std::uint64_t offset = number(view, "byteOffset");
  if (offset > available || number(view, "byteLength") > available - offset) {
    refuse_at(place.text(), "reaches past the end of its buffer");
  }
}

inline constexpr std::string_view meshopt_mode_words[] = {"ATTRIBUTES", "TRIANGLES", "INDICES"};
inline constexpr Choices meshopt_modes = {.words = meshopt_mode_words,
                                          .reason = "is not ATTRIBUTES, TRIANGLES or INDICES"};
inline constexpr std::string_view meshopt_filter_words[] = {"NONE", "OCTAHEDRAL", "QUATERNION",
                                                            "EXPONENTIAL"};
inline constexpr Choices meshopt_filters = {.words = meshopt_filter_words,
                                            .reason = "is not a filter"};
inline constexpr Member meshopt_members[] = {
    index("buffer", Table::buffers).needed(),
    size_in_extension("byteOffset"),
    size_in_extension("byteLength").needed(),
    integer("byteStride").integers(1, 256).needed(),
    size_in_extension("count").integers(1, most_in_double).needed(),
    text("mode").one_of(meshopt_modes).needed(),
    text("filter").one_of(meshopt_filters),
};
inline constexpr ObjectType meshopt = {.members = meshopt_members, .rule = check_range};
inline constexpr Extension view_extensions[] = {{"EXT_meshopt_compression", &meshopt}};
// 0 is not valid, but common for "tightly packed".
inline constexpr auto stride_values = [] {
  std::array<std::uint32_t, 64> values{};
  for (std::uint32_t i = 0; i < values.size(); ++i) values[i] = 4 * i;
  return values;
}();
inline constexpr Choices strides = {.numbers = stride_values,
                                    .reason = "must be a multiple of 4 from 4 to 252"};
inline constexpr Member view_members[] = {
    index("buffer", Table::buffers).needed(),
    size("byteOffset"),
    size("byteLength").integers(1, Member::any_size).needed(),
    integer("byteStride").one_of(strides),
};
inline constexpr ObjectType buffer_view = {
    .members = view_members, .extensions = view_extensions, .rule = check_range};

inline constexpr std::uint32_t component_values[] = {5120, 5121, 5122, 5123, 5125, 5126};
inline constexpr Choices components = {.numbers = component_values,
                                       .reason = "is not a component type"};
inline constexpr std::uint32_t index_component_values[] = {5121, 5123, 5125};
inline constexpr Choices index_components = {.numbers = index_component_values,
                                             .reason = "is not an unsigned integer type"};
inline constexpr std::string_view element_words[] = {"SCALAR", "VEC2", "VEC3", "VEC4",
                                                     "MAT2",   "MAT3", "MAT4"};
inline constexpr Choices elements = {.words = element_words, .reason = "is not an element type"};
inline constexpr Member sparse_index_members[] = {
    index("bufferView", Table::buffer_views).needed(),
    integer("byteOffset"),
    integer("componentType").one_of(index_components).needed(),
};
inline constexpr ObjectType sparse_indices = {sparse_index_members};
inline constexpr Member sparse_value_members[] = {
    index("bufferView", Table::buffer_views).needed(),
    integer("byteOffset"),
};
inline constexpr ObjectType sparse_values = {sparse_value_members};
inline constexpr Member sparse_members[] = {
    integer("count").integers(1, 0x7fffffff).needed(),
    object("indices", sparse_indices).needed(),
    object("values", sparse_values).needed(),
};
inline constexpr ObjectType sparse = {sparse_members};
// tinygltf refuses indices without a buffer view, as Draco's have none: it is given one more view
// than there are, which stands for none.
inline constexpr Member accessor_members[] = {
    index("bufferView", Table::buffer_views).otherwise("#"),
    size("byteOffset"),
    integer("componentType").one_of(components).needed(),
    boolean("normalized"),
    size("count").integers(1, Member::any_size).needed(),
    text("type").one_of(elements).needed(),
    object("sparse", sparse),
};
inline constexpr ObjectType accessor = {accessor_members};

inline constexpr Member draco_members[] = {
    index("bufferView", Table::buffer_views).needed(),
    integer_map("attributes").integers(0, 0xffffffffu).needed(),
};
inline constexpr ObjectType draco = {draco_members};
inline constexpr Member mapping_members[] = {
    index("material", Table::materials).needed(),
    indices("variants", Table::variants).items(1).needed(),
};
inline constexpr ObjectType mapping = {mapping_members};
inline constexpr Member mappings_members[] = {objects("mappings", mapping)};
inline constexpr ObjectType mappings = {mappings_members};
inline constexpr Extension primitive_extensions[] = {
    {"KHR_draco_mesh_compression", &draco},
    {"KHR_materials_variants", &mappings},
};
inline constexpr std::uint32_t mode_values[] = {0, 1, 2, 3, 4, 5, 6};
inline constexpr Choices modes = {.numbers = mode_values, .reason = "is not a primitive mode"};
inline constexpr Member primitive_members[] = {
    index_map("attributes", Table::accessors).needed(),
    index("indices", Table::accessors),
    index("material", Table::materials),
    integer("mode").one_of(modes),
    {.name = "targets", .kind = Kind::index_maps, .table = Table::accessors},
};
inline constexpr ObjectType primitive = {primitive_members, primitive_extensions};
inline constexpr Member mesh_members[] = {
    text("name"),
    objects("primitives", primitive).items(1).needed(),
    numbers("weights", 0),
};
inline constexpr ObjectType mesh = {mesh_members};

inline constexpr Member skin_members[] = {
    indices("joints", Table::nodes).items(1).needed(),
    index("skeleton", Table::nodes),
    index("inverseBindMatrices", Table::accessors),
};
inline constexpr ObjectType skin = {skin_members};

inline constexpr std::string_view path_words[] = {"translation", "rotation", "scale", "weights",
                                                  "pointer"};
inline constexpr Choices paths = {.words = path_words,
                                  .reason = "is not a property that can be animated"};
inline constexpr Member pointer_members[] = {text("pointer").needed()};
inline constexpr ObjectType pointer = {pointer_members};
inline constexpr Extension target_extensions[] = {{"KHR_animation_pointer", &pointer}};
/// A pointer names its object itself.
inline void check_target(const nlohmann::json& target_json, const Place& place,
                         const nlohmann::json&) {
  if (target_json.at("path") != "pointer") return;
  if (target_json.contains("node")) refuse_at(place.text(), "node", "must not be beside a pointer");
  const auto extensions = target_json.find("extensions");
  if (extensions == target_json.end() || !extensions->contains("KHR_animation_pointer")) {
    refuse_at(place.text(), "extensions.KHR_animation_pointer", "is missing");
  }
}
// tinygltf drops channels without a node.
inline constexpr Member target_members[] = {
    index("node", Table::nodes).otherwise("-1"),
    text("path").one_of(paths).needed(),
};
inline constexpr ObjectType target = {
    .members = target_members, .extensions = target_extensions, .rule = check_target};
inline constexpr Member channel_members[] = {
    index("sampler", Table::animation_samplers).needed(),
    object("target", target).needed(),
};
inline constexpr ObjectType channel = {channel_members};
inline constexpr std::string_view interpolation_words[] = {"LINEAR", "STEP", "CUBICSPLINE"};
inline constexpr Choices interpolations = {.words = interpolation_words,
                                           .reason = "is not LINEAR, STEP or CUBICSPLINE"};
inline constexpr Member animation_sampler_members[] = {
    index("input", Table::accessors).needed(),
    index("output", Table::accessors).needed(),
    text("interpolation").one_of(interpolations),
};
inline constexpr ObjectType animation_sampler = {animation_sampler_members};
inline constexpr Member animation_members[] = {
    text("name"),
    objects("samplers", animation_sampler).items(1).needed(),
    objects("channels", channel).items(1).needed(),
};
inline constexpr ObjectType animation = {
    .members = animation_members, .own_table = Table::animation_samplers, .own_array = "samplers"};

}  // namespace heliograph::scene::schema
