#include "scene/gltf/materials/texture_overrides.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "scene/confined_folder.hpp"
#include "scene/gltf/materials/texture_kinds.hpp"
#include "scene/image/image_decoder.hpp"
#include "scene/import_error.hpp"
#include "scene/quote.hpp"
#include "scene/unique_names.hpp"

namespace heliograph::scene {
namespace {

class Overriding {
 public:
  Overriding(Scene& scene, TextureTable& textures, std::vector<ImageSource>& images,
             const ImportLimits& limits, const std::stop_token& stop)
      : scene_(scene),
        textures_(textures),
        images_(images),
        limits_(limits),
        stop_(stop),
        labels_(material_labels(scene.material_names, scene.materials.size())) {}

  void replace(const TextureOverride& by, std::size_t number) {
    const auto material = std::ranges::find(labels_, by.material);
    if (material == labels_.end()) throw NoSuchSlot(number, "material", by.material, labels_);
    const TextureKind* const kind = find_texture_kind(by.slot);
    if (!kind) throw NoSuchSlot(number, "slot", by.slot, slot_names());
    ReplacedTexture replaced{.material = static_cast<std::uint32_t>(material - labels_.begin()),
                             .by = by};
    shared::TextureSlot& slot =
        kind->of(scene_.materials[replaced.material], scene_.material_layers[replaced.material]);
    Sampler sampler;
    if (slot.texture != shared::no_texture) {
      const Texture& before = textures_.used_textures()[slot.texture];
      sampler = before.sampler;
      describe(images_[textures_.image_uses()[before.image].source], replaced);
    }
    if (by.image.empty()) {
      slot = no_texture_slot();
    } else {
      slot.texture = textures_.use_other(source_of(by), kind->srgb, sampler);
    }
    scene_.replaced_textures.push_back(std::move(replaced));
  }

  void drop_unused() {
    std::vector<shared::TextureSlot*> slots;
    for (std::size_t i = 0; i < scene_.materials.size(); ++i) {
      for (const TextureKind& kind : texture_kinds()) {
        slots.push_back(&kind.of(scene_.materials[i], scene_.material_layers[i]));
      }
    }
    textures_.keep_only(slots);
  }

  std::vector<SourceFile> take_files() { return std::move(files_); }

 private:
  static std::vector<std::string> slot_names() {
    std::vector<std::string> names;
    for (const TextureKind& kind : texture_kinds()) names.emplace_back(kind.name);
    return names;
  }

  static void describe(const ImageSource& image, ReplacedTexture& replaced) {
    replaced.file_image = image.name;
    if (!image.problem.empty()) return;
    try {
      const ImageSize size = probe_image(image.bytes);
      replaced.file_width = size.width;
      replaced.file_height = size.height;
    } catch (const ImportError&) {
      // Replaced because it is damaged: its size stays unknown.
    }
  }

  std::uint32_t source_of(const TextureOverride& by) {
    const auto [known, is_new] =
        source_of_file_.try_emplace(by.image, static_cast<std::uint32_t>(images_.size()));
    if (!is_new) return known->second;
    files_.push_back(examine_file(by.image));
    ImageSource source{.path = "the image",
                       .name = by.name,
                       .file = {},
                       .bytes = {},
                       .problem = {},
                       .required = true};
    source.file = std::make_shared<const std::vector<std::uint8_t>>(
        read_regular_file(by.image, limits_.file_bytes, "the image " + in_quotes(by.name), stop_));
    source.bytes = *source.file;
    try {
      (void)probe_image(source.bytes);
    } catch (const ImportError& failure) {
      throw ImportError("the image " + in_quotes(by.name) + " " + failure.what());
    }
    images_.push_back(std::move(source));
    return known->second;
  }

  Scene& scene_;
  TextureTable& textures_;
  std::vector<ImageSource>& images_;
  const ImportLimits& limits_;
  const std::stop_token& stop_;
  const std::vector<std::string> labels_;
  std::map<std::filesystem::path, std::uint32_t> source_of_file_;
  std::vector<SourceFile> files_;
};

}  // namespace

NoSuchSlot::NoSuchSlot(std::size_t number, std::string member, std::string requested,
                       std::vector<std::string> names)
    : ImportError(member + ": there is no " + in_quotes(requested)),
      number_(number),
      member_(std::move(member)),
      requested_(std::move(requested)),
      names_(std::move(names)) {}

std::vector<std::string> material_labels(const std::vector<std::string>& names, std::size_t count) {
  UniqueNames unique("material");
  std::vector<std::string> labels;
  for (std::size_t i = 0; i < count; ++i) {
    labels.push_back(unique.next(i < names.size() ? names[i] : std::string()));
  }
  return labels;
}

std::vector<SourceFile> override_textures(std::span<const TextureOverride> overrides, Scene& scene,
                                          TextureTable& textures, std::vector<ImageSource>& images,
                                          const ImportLimits& limits, const std::stop_token& stop) {
  if (overrides.empty()) return {};
  Overriding overriding(scene, textures, images, limits, stop);
  for (std::size_t i = 0; i < overrides.size(); ++i) overriding.replace(overrides[i], i);
  overriding.drop_unused();
  return overriding.take_files();
}

}  // namespace heliograph::scene
