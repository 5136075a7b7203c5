#include "scene/gltf/document/variants.hpp"

#include <algorithm>
#include <set>

namespace heliograph::scene {
namespace {

constexpr std::string_view extension = "KHR_materials_variants";

void check_mappings(const JsonValue& primitive, std::size_t variant_count,
                    std::size_t material_count) {
  const auto own = primitive.object("extensions", extension);
  if (!own) return;
  std::set<std::uint32_t> mapped;
  for (const JsonValue& mapping : own->objects("mappings")) {
    mapping.required_index("material", material_count, "materials");
    const auto variants = mapping.indices("variants", variant_count, "variants");
    if (variants.empty()) mapping.refuse("variants", "must refer to at least one variant");
    for (const std::uint32_t variant : variants) {
      if (!mapped.insert(variant).second) mapping.refuse("variants", "lists a variant twice");
    }
  }
}

}  // namespace

std::vector<std::string> read_variants(const JsonValue& root, std::size_t material_count) {
  std::vector<std::string> names;
  if (const auto own = root.object("extensions", extension)) {
    for (const JsonValue& variant : own->objects("variants")) names.push_back(variant.text("name"));
  }
  for (const JsonValue& mesh : root.objects("meshes")) {
    for (const JsonValue& primitive : mesh.objects("primitives")) {
      check_mappings(primitive, names.size(), material_count);
    }
  }
  return names;
}

std::optional<std::uint32_t> material_of_variant(const JsonValue& primitive,
                                                 std::uint32_t variant) {
  constexpr auto any = std::size_t(-1);
  const auto own = primitive.object("extensions", extension);
  if (!own) return std::nullopt;
  for (const JsonValue& mapping : own->objects("mappings")) {
    const auto variants = mapping.indices("variants", any, "variants");
    if (std::ranges::find(variants, variant) == variants.end()) continue;
    return mapping.required_index("material", any, "materials");
  }
  return std::nullopt;
}

}  // namespace heliograph::scene
