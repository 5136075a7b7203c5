#include "scene/gltf/document/variants.hpp"

#include <algorithm>
#include <set>

#include "scene/gltf/document/extension_value.hpp"

namespace heliograph::scene {
namespace {

constexpr const char* extension = "KHR_materials_variants";

void check_mappings(const tinygltf::Primitive& primitive, const std::string& path) {
  const auto own = find_extension(primitive.extensions, extension, path);
  if (!own) return;
  std::set<std::uint32_t> mapped;
  for (const ExtensionValue& mapping : own->objects("mappings")) {
    for (const std::uint32_t variant : mapping.indices("variants")) {
      if (!mapped.insert(variant).second) mapping.refuse("variants", "lists a variant twice");
    }
  }
}

}  // namespace

std::vector<std::string> read_variants(const tinygltf::Model& model) {
  std::vector<std::string> names;
  if (const auto own = find_extension(model.extensions, extension, "")) {
    for (const ExtensionValue& variant : own->objects("variants")) {
      names.push_back(variant.text("name"));
    }
  }
  for (std::size_t i = 0; i < model.meshes.size(); ++i) {
    const auto& primitives = model.meshes[i].primitives;
    for (std::size_t k = 0; k < primitives.size(); ++k) {
      check_mappings(primitives[k], item_path(item_path("", "meshes", i), "primitives", k));
    }
  }
  return names;
}

std::optional<std::uint32_t> material_of_variant(const tinygltf::Primitive& primitive,
                                                 std::uint32_t variant) {
  const auto own = find_extension(primitive.extensions, extension, "");
  if (!own) return std::nullopt;
  for (const ExtensionValue& mapping : own->objects("mappings")) {
    const auto variants = mapping.indices("variants");
    if (std::ranges::find(variants, variant) != variants.end()) return mapping.index("material");
  }
  return std::nullopt;
}

}  // namespace heliograph::scene
