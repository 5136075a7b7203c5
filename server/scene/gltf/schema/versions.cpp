#include "scene/gltf/schema/versions.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "scene/gltf/schema/place.hpp"
#include "scene/quote.hpp"

namespace heliograph::scene {
namespace {

constexpr std::array<std::string_view, 25> supported_extensions = {
    "EXT_lights_image_based",
    "EXT_meshopt_compression",
    "EXT_mesh_gpu_instancing",
    "EXT_texture_webp",
    "KHR_animation_pointer",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_node_visibility",
    "KHR_texture_basisu",
    "KHR_texture_transform",
};

/// A scene without them is complete: they tell what people may point at.
constexpr std::array<std::string_view, 2> harmless_extensions = {
    "KHR_node_hoverability",
    "KHR_node_selectability",
};

bool is_supported(const std::string& extension) {
  return std::ranges::find(supported_extensions, extension) != supported_extensions.end();
}

bool is_harmless(const std::string& extension) {
  return std::ranges::find(harmless_extensions, extension) != harmless_extensions.end();
}

/// The strings of an array at the document's root. Other items are refused by the document's check.
std::vector<std::string> texts(const nlohmann::json& document, const char* name) {
  std::vector<std::string> result;
  const auto found = document.find(name);
  if (found == document.end() || !found->is_array()) return result;
  for (const nlohmann::json& item : *found) {
    if (item.is_string()) result.push_back(item.get<std::string>());
  }
  return result;
}

std::string text_of(const nlohmann::json& asset, const char* name) {
  const auto found = asset.find(name);
  return found != asset.end() && found->is_string() ? found->get<std::string>() : std::string();
}

}  // namespace

void check_versions(const nlohmann::json& document, Warnings& warnings) {
  const auto asset = document.find("asset");
  if (asset == document.end()) throw ImportError("not a glTF file: asset is missing");
  if (!asset->is_object()) refuse_at("asset", "must be an object");
  const std::string version = text_of(*asset, "version");
  if (!version.starts_with("2.")) refuse_at("asset", "version", in_quotes(version) + " is not 2.x");
  const std::string minimum = text_of(*asset, "minVersion");
  if (!minimum.empty() && !minimum.starts_with("2.")) {
    refuse_at("asset", "minVersion", in_quotes(minimum) + " is not 2.x");
  }
  if (!minimum.empty() && minimum != "2.0") {
    warnings.add("asset.minVersion " + in_quotes(minimum) + " is newer than 2.0");
  }
  std::string missing;
  for (const std::string& extension : texts(document, "extensionsRequired")) {
    if (is_supported(extension) || is_harmless(extension)) continue;
    missing += (missing.empty() ? "" : ", ") + in_quotes(extension);
  }
  if (!missing.empty()) throw ImportError("requires extensions that are not supported: " + missing);
  for (const std::string& extension : texts(document, "extensionsUsed")) {
    if (!is_supported(extension)) {
      warnings.add("extension " + in_quotes(extension) + " is ignored");
    }
  }
}

}  // namespace heliograph::scene
