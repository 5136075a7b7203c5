#include "scene/gltf/export/texture_export.hpp"

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>

#include "scene/confined_folder.hpp"
#include "scene/gltf/export/embedded_files.hpp"
#include "scene/gltf/export/material_export.hpp"
#include "scene/gltf/materials/texture_kinds.hpp"
#include "scene/quote.hpp"

namespace heliograph::scene {
namespace {

using nlohmann::json;

constexpr const char* other_model = "KHR_materials_pbrSpecularGlossiness";

bool has_extension(const json& material, const std::string& name) {
  const auto extensions = material.find("extensions");
  return extensions != material.end() && extensions->contains(name);
}

/// The extension by which a texture refers to such an image; empty: by its own source.
std::string extension_of(std::string_view mime_type) {
  if (mime_type == "image/ktx2") return "KHR_texture_basisu";
  return mime_type == "image/webp" ? "EXT_texture_webp" : "";
}

class TextureWriter {
 public:
  TextureWriter(EditableDocument& document, const ImportLimits& limits, const std::stop_token& stop)
      : document_(document), limits_(limits), stop_(stop) {}

  void write(const ReplacedTexture& replaced) {
    const TextureKind& kind = *find_texture_kind(replaced.by.slot);
    const std::string owner(kind.owner);
    json& material = material_of(document_, replaced.material);
    if (owner == "pbrMetallicRoughness" && has_extension(material, other_model)) {
      if (!replaced.by.image.empty()) made_.files.push_back(examine_file(replaced.by.image));
      return document_.warn("material " + in_quotes(replaced.by.material) + ": the texture " +
                            replaced.by.slot + " stays as in the file, since it is one of " +
                            other_model);
    }
    if (replaced.by.image.empty()) return erase(material, kind);
    const std::size_t image = image_of(replaced.by);
    json info = info_of(material_of(document_, replaced.material), kind);
    info["index"] = texture_of(info, image);
    json& changed = material_of(document_, replaced.material);
    owner_of(changed, kind)[kind.member] = std::move(info);
    if (kind.of_extension()) document_.use(owner);
  }

  TextureExport take() { return std::move(made_); }

 private:
  static void erase(json& material, const TextureKind& kind) {
    if (const std::string owner(kind.owner); owner.empty()) {
      material.erase(kind.member);
    } else if (!kind.of_extension()) {
      erase_within(material, kind.owner, kind.member);
    } else if (has_extension(material, owner)) {
      material["extensions"][owner].erase(kind.member);
    }
  }

  static json& owner_of(json& material, const TextureKind& kind) {
    const std::string owner(kind.owner);
    if (owner.empty()) return material;
    return kind.of_extension() ? material["extensions"][owner] : material[owner];
  }

  /// The textureInfo of the document, with its texCoord set and transform, or a new one.
  static json info_of(json& material, const TextureKind& kind) {
    const json& owner = owner_of(material, kind);
    return owner.is_null() ? json::object() : owner.value(kind.member, json::object());
  }

  /// A texture of the image, with the sampler of the one that it replaces.
  std::size_t texture_of(const json& info, std::size_t image) {
    json texture = json::object();
    if (const auto index = info.find("index"); index != info.end()) {
      const json& before = document_.list("textures")[index->get<std::size_t>()];
      if (before.contains("sampler")) texture["sampler"] = before["sampler"];
    }
    const std::string type = document_.list("images")[image]["mimeType"];
    if (const std::string extension = extension_of(type); extension.empty()) {
      texture["source"] = image;
    } else {
      texture["extensions"][extension]["source"] = image;
      // There is no source for readers that lack the extension, which therefore is required
      // (EXT_texture_webp, KHR_texture_basisu).
      document_.require(extension);
    }
    return document_.append("textures", std::move(texture));
  }

  std::size_t image_of(const TextureOverride& by) {
    const auto known = images_.find(by.image);
    if (known != images_.end()) return known->second;
    made_.files.push_back(examine_file(by.image));
    std::vector<std::uint8_t> file =
        read_regular_file(by.image, limits_.file_bytes, "the image " + in_quotes(by.name), stop_);
    const std::size_t image =
        document_.append("images", {{"name", by.name}, {"mimeType", mime_type_of(file)}});
    made_.images.push_back({image, std::move(file)});
    images_[by.image] = image;
    return image;
  }

  EditableDocument& document_;
  const ImportLimits& limits_;
  const std::stop_token& stop_;
  std::map<std::filesystem::path, std::size_t> images_;
  TextureExport made_;
};

}  // namespace

TextureExport export_textures(EditableDocument& document, const Scene& scene,
                              const ImportLimits& limits, const std::stop_token& stop) {
  TextureWriter writer(document, limits, stop);
  for (const ReplacedTexture& replaced : scene.replaced_textures) writer.write(replaced);
  return writer.take();
}

}  // namespace heliograph::scene
