#include "scene/gltf/nodes/animation_pointer.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>

#include "scene/gltf/document/extension_value.hpp"
#include "scene/gltf/materials/texture_kinds.hpp"
#include "scene/gltf/materials/texture_slot.hpp"
#include "scene/quote.hpp"

namespace heliograph::scene {
namespace {

using Pointed = PointedProperty;

constexpr const char* pointer_extension = "KHR_animation_pointer";
constexpr std::string_view transform_part = "/extensions/KHR_texture_transform/";

/// A property, as the rest of a pointer below its object.
struct PointerName {
  std::string_view rest;
  std::variant<Property, Pointed> property;
};

constexpr PointerName node_names[] = {
    {"translation", Property::translation},
    {"rotation", Property::rotation},
    {"scale", Property::scale},
    {"weights", Property::weights},
    {"extensions/KHR_node_visibility/visible", Pointed::visible},
};
constexpr PointerName camera_names[] = {
    {"perspective/yfov", Pointed::vertical_fov},
    {"orthographic/ymag", Pointed::orthographic_height},
};
constexpr PointerName light_names[] = {
    {"color", Pointed::light_color},
    {"intensity", Pointed::light_intensity},
    {"range", Pointed::light_range},
    {"spot/innerConeAngle", Pointed::inner_cone},
    {"spot/outerConeAngle", Pointed::outer_cone},
};
constexpr PointerName core_material_names[] = {
    {"pbrMetallicRoughness/baseColorFactor", Pointed::base_color},
    {"pbrMetallicRoughness/metallicFactor", Pointed::metallic},
    {"pbrMetallicRoughness/roughnessFactor", Pointed::roughness},
    {"emissiveFactor", Pointed::emissive},
    {"extensions/KHR_materials_emissive_strength/emissiveStrength", Pointed::emissive_strength},
    {"normalTexture/scale", Pointed::normal_scale},
    {"occlusionTexture/strength", Pointed::occlusion_strength},
};
/// Below "extensions/KHR_materials_".
constexpr PointerName extended_material_names[] = {
    {"ior/ior", Pointed::ior},
    {"specular/specularFactor", Pointed::specular},
    {"specular/specularColorFactor", Pointed::specular_color},
    {"clearcoat/clearcoatFactor", Pointed::clearcoat},
    {"clearcoat/clearcoatRoughnessFactor", Pointed::clearcoat_roughness},
    {"clearcoat/clearcoatNormalTexture/scale", Pointed::clearcoat_normal_scale},
    {"sheen/sheenColorFactor", Pointed::sheen_color},
    {"sheen/sheenRoughnessFactor", Pointed::sheen_roughness},
    {"iridescence/iridescenceFactor", Pointed::iridescence},
    {"iridescence/iridescenceIor", Pointed::iridescence_ior},
    {"iridescence/iridescenceThicknessMinimum", Pointed::iridescence_thickness_minimum},
    {"iridescence/iridescenceThicknessMaximum", Pointed::iridescence_thickness_maximum},
    {"anisotropy/anisotropyStrength", Pointed::anisotropy},
    {"anisotropy/anisotropyRotation", Pointed::anisotropy_rotation},
    {"diffuse_transmission/diffuseTransmissionFactor", Pointed::diffuse_transmission},
    {"diffuse_transmission/diffuseTransmissionColorFactor", Pointed::diffuse_transmission_color},
    {"volume/thicknessFactor", Pointed::thickness},
    {"volume/attenuationDistance", Pointed::attenuation_distance},
    {"volume/attenuationColor", Pointed::attenuation_color},
};
/// Likewise, of what only materials have whose file lets light through.
constexpr PointerName transmission_names[] = {
    {"transmission/transmissionFactor", Pointed::transmission},
    {"dispersion/dispersion", Pointed::dispersion},
};

/// A pointer that has been read up to a place.
class PointerReader {
 public:
  PointerReader(std::string pointer, std::string path)
      : pointer_(std::move(pointer)), path_(std::move(path)), rest_(pointer_) {
    if (!rest_.starts_with('/')) refuse("is not a JSON pointer to a property");
    for (std::size_t i = 0; i < rest_.size(); ++i) {
      const std::string_view escaped = rest_.substr(i, 2);
      if (rest_[i] == '~' && escaped != "~0" && escaped != "~1") refuse("is not a JSON pointer");
    }
  }

  /// Whether `text` comes next, which is passed then.
  bool pass(std::string_view text) {
    if (!rest_.starts_with(text)) return false;
    rest_.remove_prefix(text.size());
    return true;
  }
  /// Passes an index into an array of so many, and the slash behind it.
  std::uint32_t index(std::size_t count, std::string_view plural) {
    const std::string_view token = rest_.substr(0, rest_.find('/'));
    std::uint32_t number = 0;
    const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), number);
    const bool padded = token.size() > 1 && token.front() == '0';
    if (error == std::errc::result_out_of_range || (error == std::errc() && number >= count)) {
      refuse(in_quotes(token) + " is not an index into " + std::to_string(count) + " " +
             std::string(plural));
    }
    if (error != std::errc() || end != token.data() + token.size() || padded) {
      refuse(in_quotes(token) + " is not an index");
    }
    rest_.remove_prefix(std::min(token.size() + 1, rest_.size()));
    return number;
  }
  std::string_view rest() const { return rest_; }

 private:
  [[noreturn]] void refuse(const std::string& reason) const {
    refuse_at(path_ + ".target.extensions." + pointer_extension, "pointer",
              in_quotes(pointer_) + ": " + reason);
  }

  std::string pointer_;
  std::string path_;
  std::string_view rest_;
};

std::optional<PointedTarget> find_name(std::span<const PointerName> names, std::string_view rest,
                                       std::uint32_t object) {
  const auto found = std::ranges::find(names, rest, &PointerName::rest);
  if (found == names.end()) return std::nullopt;
  return PointedTarget{.property = found->property, .object = object};
}

bool is_opaque(const tinygltf::Material& material) {
  return material.alphaMode != "BLEND" && material.alphaMode != "MASK";
}

bool transmits_light(const tinygltf::Material& material) {
  const auto own = find_extension(material.extensions, "KHR_materials_transmission", "");
  return own && own->number("transmissionFactor", 0.0f) > 0.0f && material.alphaMode != "MASK";
}

/// The place of a slot's textureInfo below its material.
std::string slot_place(const TextureKind& kind) {
  const std::string owner = kind.owner;
  if (owner.empty()) return kind.member;
  return (kind.of_extension() ? "extensions/" : "") + owner + "/" + kind.member;
}

std::optional<Pointed> transform_property(std::string_view member) {
  if (member == "offset") return Pointed::texture_offset;
  if (member == "rotation") return Pointed::texture_rotation;
  if (member == "scale") return Pointed::texture_scale;
  return std::nullopt;
}

/// Rays look up alpha where the file puts it.
bool transform_is_fixed(const tinygltf::Material& material, const TextureKind& kind) {
  if (kind.of_extension()) return material.extensions.contains("KHR_materials_unlit");
  return kind.base == &shared::Material::base_color_texture && !is_opaque(material);
}

std::optional<PointedTarget> texture_target(const tinygltf::Material& material,
                                            std::string_view rest, std::uint32_t object) {
  const std::size_t end = rest.find(transform_part);
  if (end == std::string_view::npos) return std::nullopt;
  const auto property = transform_property(rest.substr(end + transform_part.size()));
  const auto kinds = texture_kinds();
  const auto found = std::ranges::find_if(
      kinds, [&](const TextureKind& kind) { return slot_place(kind) == rest.substr(0, end); });
  if (!property || found == kinds.end() || transform_is_fixed(material, *found)) {
    return std::nullopt;
  }
  return PointedTarget{.property = *property,
                       .object = object,
                       .kind = static_cast<std::uint32_t>(found - kinds.begin())};
}

std::optional<PointedTarget> material_target(const tinygltf::Material& material,
                                             std::string_view rest, std::uint32_t object) {
  // Its core material stands for another model.
  const bool converted = material.extensions.contains("KHR_materials_pbrSpecularGlossiness");
  if (converted && rest.starts_with("pbrMetallicRoughness")) return std::nullopt;
  if (const auto texture = texture_target(material, rest, object)) return texture;
  if (const auto core = find_name(core_material_names, rest, object)) return core;
  constexpr std::string_view prefix = "extensions/KHR_materials_";
  const bool unlit = material.extensions.contains("KHR_materials_unlit");
  if (unlit || !rest.starts_with(prefix)) return std::nullopt;
  const std::string_view extended = rest.substr(prefix.size());
  if (const auto known = find_name(extended_material_names, extended, object)) return known;
  if (!transmits_light(material)) return std::nullopt;
  return find_name(transmission_names, extended, object);
}

std::optional<PointedTarget> light_target(const tinygltf::Light& light, std::string_view rest,
                                          std::uint32_t object) {
  const bool of_spots = rest.starts_with("spot/");
  if (of_spots && light.type != "spot") return std::nullopt;
  if (rest == "range" && light.type == "directional") return std::nullopt;
  return find_name(light_names, rest, object);
}

}  // namespace

bool has_pointer(const tinygltf::AnimationChannel& channel) {
  return channel.target_path == "pointer";
}

std::string pointer_of(const tinygltf::AnimationChannel& channel) {
  return find_extension(channel.target_extensions, pointer_extension, "")->text("pointer");
}

std::optional<PointedTarget> resolve_pointer(const tinygltf::AnimationChannel& channel,
                                             const tinygltf::Model& model,
                                             const std::string& path) {
  PointerReader pointer(pointer_of(channel), path);
  if (pointer.pass("/nodes/")) {
    const std::uint32_t node = pointer.index(model.nodes.size(), "nodes");
    return find_name(node_names, pointer.rest(), node);
  }
  if (pointer.pass("/materials/")) {
    const std::uint32_t material = pointer.index(model.materials.size(), "materials");
    return material_target(model.materials[material], pointer.rest(), material);
  }
  if (pointer.pass("/extensions/KHR_lights_punctual/lights/")) {
    const std::uint32_t light = pointer.index(model.lights.size(), "lights");
    return light_target(model.lights[light], pointer.rest(), light);
  }
  if (pointer.pass("/cameras/")) {
    const std::uint32_t camera = pointer.index(model.cameras.size(), "cameras");
    if (!pointer.rest().starts_with(model.cameras[camera].type + "/")) return std::nullopt;
    return find_name(camera_names, pointer.rest(), camera);
  }
  return std::nullopt;
}

TextureTransform file_transform(const tinygltf::Material& material, std::uint32_t kind) {
  constexpr const char* extension = "KHR_texture_transform";
  const TextureKind& slot = texture_kinds()[kind];
  const auto read = [](const std::optional<ExtensionValue>& transform) {
    return transform ? read_texture_transform(*transform) : TextureTransform();
  };
  if (slot.of_extension()) {
    const auto owner = find_extension(material.extensions, slot.owner, "");
    const auto info = owner ? owner->object(slot.member) : std::nullopt;
    const auto extensions = info ? info->object("extensions") : std::nullopt;
    return read(extensions ? extensions->object(extension) : std::nullopt);
  }
  const auto& pbr = material.pbrMetallicRoughness;
  const std::string_view member = slot.member;
  const tinygltf::ExtensionMap& extensions =
      member == "baseColorTexture"           ? pbr.baseColorTexture.extensions
      : member == "metallicRoughnessTexture" ? pbr.metallicRoughnessTexture.extensions
      : member == "normalTexture"            ? material.normalTexture.extensions
      : member == "occlusionTexture"         ? material.occlusionTexture.extensions
                                             : material.emissiveTexture.extensions;
  return read(find_extension(extensions, extension, ""));
}

std::vector<bool> nodes_that_blink(const tinygltf::Model& model) {
  std::vector<bool> blink(model.nodes.size());
  for (std::size_t i = 0; i < model.animations.size(); ++i) {
    const auto& channels = model.animations[i].channels;
    for (std::size_t k = 0; k < channels.size(); ++k) {
      if (!has_pointer(channels[k])) continue;
      const auto target = resolve_pointer(channels[k], model,
                                          item_path(item_path("", "animations", i), "channels", k));
      if (!target) continue;
      const auto* const pointed = std::get_if<Pointed>(&target->property);
      if (pointed && *pointed == Pointed::visible) blink[target->object] = true;
    }
  }
  return blink;
}

}  // namespace heliograph::scene
