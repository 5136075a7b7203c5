#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "scene/gltf/document/gltf_file.hpp"
#include "scene/gltf/materials/images.hpp"
#include "scene/scene.hpp"

namespace heliograph::scene {

/// The document's textures, and the scene textures that materials use: as color (sRGB), as data, or
/// both, without duplicates.
class TextureTable {
 public:
  explicit TextureTable(const tinygltf::Model& model);

  std::size_t size() const { return textures_.size(); }

  /// The scene texture for one use of document texture `index`, or shared::no_texture when its
  /// image requires an unsupported extension.
  std::uint32_t use(std::uint32_t index, bool srgb);

  /// The scene texture of an image converted from those of two textures, with the sampler of the
  /// first that there is; shared::no_texture where neither has an image.
  std::uint32_t use_converted(ConvertedImage kind, const SpecularGlossiness& factors,
                              std::optional<std::uint32_t> diffuse,
                              std::optional<std::uint32_t> specular);

  /// A scene texture of an image that is not the document's: `source` is behind its images.
  std::uint32_t use_other(std::uint32_t source, bool srgb, const Sampler& sampler);

  /// Drops textures and images that no slot uses any more; `slots` are all that there are.
  void keep_only(std::span<shared::TextureSlot* const> slots);

  const std::vector<ImageUse>& image_uses() const { return image_uses_; }
  const std::vector<Texture>& used_textures() const { return used_textures_; }

 private:
  struct Declared {
    std::optional<std::uint32_t> image;
    Sampler sampler;
  };

  std::vector<Declared> textures_;
  std::uint32_t use_image(std::uint32_t source, bool srgb);

  std::map<std::pair<std::uint32_t, bool>, std::uint32_t> image_of_use_;
  std::map<std::pair<std::uint32_t, bool>, std::uint32_t> texture_of_use_;
  std::vector<ImageUse> image_uses_;
  std::vector<Texture> used_textures_;
};

}  // namespace heliograph::scene
