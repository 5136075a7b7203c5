#include "session/edits/texture_edits.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include "scene/gltf/materials/texture_kinds.hpp"
#include "scene/quote.hpp"
#include "session/edits/edited_parts.hpp"

namespace heliograph::session {

using protocol::Result;
using protocol::TextureInfo;
namespace error = protocol::error;

namespace {

bool is_of(const scene::TextureOverride& texture, const std::string& material,
           const std::string& slot) {
  return texture.material == material && texture.slot == slot;
}

std::vector<std::string> labels_of(const scene::Scene& scene) {
  return scene::material_labels(scene.material_names, scene.materials.size());
}

/// What the slot has now, as the file's where it is not replaced.
TextureInfo describe_slot(const scene::Scene& scene, std::size_t material, const std::string& label,
                          const scene::TextureKind& kind) {
  TextureInfo info{.material = label, .slot = std::string(kind.name)};
  for (const scene::ReplacedTexture& replaced : scene.replaced_textures) {
    if (replaced.material != material || replaced.by.slot != kind.name) continue;
    info.file_image = replaced.file_image;
    info.width = replaced.file_width;
    info.height = replaced.file_height;
    info.removed = replaced.by.image.empty();
    if (!info.removed) info.image = replaced.by.name;
    return info;
  }
  const scene::MaterialLayers none;
  const bool extended = material < scene.material_layers.size();
  const shared::TextureSlot& slot =
      kind.of(scene.materials[material], extended ? scene.material_layers[material] : none);
  if (slot.texture == shared::no_texture) return info;
  const scene::Image& image = scene.images[scene.textures[slot.texture].image];
  info.file_image = image.name;
  if (image.damaged) return info;
  info.width = image.width;
  info.height = image.height;
  return info;
}

/// The images as they are on disk now.
class Images {
 public:
  explicit Images(const SceneCatalogue& catalogue) : entries_(list_images(catalogue)) {
    for (const CatalogueEntry& entry : entries_) {
      by_name_.try_emplace(entry.name, &entry);
      by_name_.try_emplace(entry.name + entry.path.extension().string(), &entry);
    }
  }

  const CatalogueEntry* find(const std::string& name) const {
    const auto found = by_name_.find(name);
    return found == by_name_.end() ? nullptr : found->second;
  }
  /// @return an error of the member "image"
  Result<void> choose(const std::string& name, scene::TextureOverride& texture) const {
    const CatalogueEntry* const image = find(name);
    if (!image) {
      std::vector<std::string_view> names;
      for (const CatalogueEntry& entry : entries_) names.push_back(entry.name);
      return error::not_found("image", scene::in_quotes(name) + " is not one of the images" +
                                           protocol::suggestion(name, names));
    }
    texture.name = image->name;
    texture.image = image->path;
    return {};
  }

 private:
  std::vector<CatalogueEntry> entries_;
  std::map<std::string, const CatalogueEntry*> by_name_;
};

/// An image of the same name may be another file by now. One that is gone is left out.
void find_again(TextureOverrides& textures, const Images& images) {
  std::erase_if(textures, [&](scene::TextureOverride& texture) {
    if (texture.image.empty()) return false;
    const CatalogueEntry* const image = images.find(texture.name);
    if (image) texture.image = image->path;
    return image == nullptr;
  });
}

}  // namespace

TextureOverrides canonical(TextureOverrides textures) {
  std::ranges::sort(textures, {}, [](const scene::TextureOverride& texture) {
    return std::tie(texture.material, texture.slot);
  });
  return textures;
}

TextureOverrides overrides_of(const scene::Scene& scene) {
  TextureOverrides textures;
  for (const scene::ReplacedTexture& replaced : scene.replaced_textures) {
    textures.push_back(replaced.by);
  }
  return canonical(std::move(textures));
}

std::vector<CatalogueEntry> list_images(const SceneCatalogue& catalogue) {
  return catalogue.list_files({".png", ".jpg", ".jpeg", ".webp", ".ktx2"});
}

protocol::TextureList list_textures(const scene::Scene& scene) {
  protocol::TextureList list;
  for (const scene::TextureKind& kind : scene::texture_kinds()) list.slots.emplace_back(kind.name);
  const std::vector<std::string> labels = labels_of(scene);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    for (const scene::TextureKind& kind : scene::texture_kinds()) {
      TextureInfo info = describe_slot(scene, i, labels[i], kind);
      if (info.file_image || info.image || info.removed) list.textures.push_back(std::move(info));
    }
  }
  return list;
}

TextureInfo describe_texture(const scene::Scene& scene, const std::string& material,
                             const std::string& slot) {
  const std::vector<std::string> labels = labels_of(scene);
  const auto found = std::ranges::find(labels, material);
  const scene::TextureKind* const kind = scene::find_texture_kind(slot);
  if (found == labels.end() || !kind) return {.material = material, .slot = slot};
  return describe_slot(scene, static_cast<std::size_t>(found - labels.begin()), material, *kind);
}

Result<void> check_slot(const scene::Scene& scene, const std::string& material,
                        const std::string& slot) {
  const std::vector<std::string> labels = labels_of(scene);
  if (std::ranges::find(labels, material) == labels.end()) {
    return no_such_part("material", material, {labels.begin(), labels.end()});
  }
  if (scene::find_texture_kind(slot)) return {};
  std::vector<std::string_view> names;
  for (const scene::TextureKind& kind : scene::texture_kinds()) names.push_back(kind.name);
  return error::not_found("slot",
                          "materials have no such slot" + protocol::suggestion(slot, names));
}

Result<void> check_slots(const scene::Scene& scene, const protocol::EditDocument& document) {
  for (std::size_t i = 0; i < document.textures.size(); ++i) {
    const auto& [material, slot, image] = document.textures[i];
    const Result<void> fits = check_slot(scene, material, slot);
    if (!fits) return below(fits.error(), "edits.textures[" + std::to_string(i) + "]");
  }
  return {};
}

Result<TextureOverrides> with_change(TextureOverrides textures, const protocol::TextureSet& change,
                                     const SceneCatalogue& catalogue) {
  const bool asks = change.image.value || change.image.reset;
  if (asks == change.removed) {
    return error::invalid("image", asks ? "excludes removed"
                                        : "is missing: a name from "
                                          "images.list, null, or removed instead");
  }
  const Images images(catalogue);
  scene::TextureOverride texture{change.material, change.slot, {}, {}};
  if (change.image.value) {
    const Result<void> chosen = images.choose(*change.image.value, texture);
    if (!chosen) return chosen.error();
  }
  find_again(textures, images);
  std::erase_if(textures, [&](const scene::TextureOverride& other) {
    return is_of(other, change.material, change.slot);
  });
  if (!change.image.reset) textures.push_back(std::move(texture));
  return canonical(std::move(textures));
}

void describe_textures(const scene::Scene& scene, protocol::EditDocument& document) {
  for (const scene::TextureOverride& texture : overrides_of(scene)) {
    protocol::TextureEdit edit{.material = texture.material, .slot = texture.slot, .image = {}};
    if (!texture.image.empty()) edit.image = texture.name;
    document.textures.push_back(std::move(edit));
  }
}

bool has_textures(const scene::Scene& scene, const protocol::EditDocument& document) {
  protocol::EditDocument shown;
  describe_textures(scene, shown);
  const auto ordered = [](std::vector<protocol::TextureEdit> textures) {
    std::ranges::sort(textures, {}, [](const protocol::TextureEdit& texture) {
      return std::tie(texture.material, texture.slot);
    });
    return textures;
  };
  return ordered(shown.textures) == ordered(document.textures);
}

Result<TextureOverrides> overrides_of(const protocol::EditDocument& document,
                                      const SceneCatalogue& catalogue) {
  TextureOverrides textures;
  if (document.textures.empty()) return textures;
  const Images images(catalogue);
  std::set<std::pair<std::string_view, std::string_view>> slots;
  for (const protocol::TextureEdit& edit : document.textures) {
    const std::string entry = "edits.textures[" + std::to_string(textures.size()) + "]";
    if (!slots.emplace(edit.material, edit.slot).second) {
      return error::invalid(entry + ".slot", "is that of an earlier entry, too");
    }
    scene::TextureOverride& texture = textures.emplace_back();
    texture = {edit.material, edit.slot, {}, {}};
    if (!edit.image) continue;
    const Result<void> chosen = images.choose(*edit.image, texture);
    if (!chosen) return below(chosen.error(), entry);
  }
  return canonical(std::move(textures));
}

}  // namespace heliograph::session
