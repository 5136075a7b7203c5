#include "scene/gltf/materials/textures.hpp"

#include <algorithm>
#include <utility>

#include "scene/gltf/document/extension_value.hpp"

namespace heliograph::scene {
namespace {

std::uint32_t to_wrap(int mode) {
  switch (mode) {
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
      return shared::wrap_clamp;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
      return shared::wrap_mirror;
    default:
      return shared::wrap_repeat;
  }
}

Sampler to_sampler(const tinygltf::Sampler& document) {
  Sampler sampler;
  sampler.wrap_s = to_wrap(document.wrapS);
  sampler.wrap_t = to_wrap(document.wrapT);
  if (document.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST) sampler.magnify = Filter::nearest;
  const int minify =
      document.minFilter < 0 ? TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR : document.minFilter;
  // 9984 and up: bit 0 is the filter within a level, bit 1 the filter between levels.
  sampler.minify = minify % 2 == 0 ? Filter::nearest : Filter::linear;
  sampler.mipmapped = minify >= 9984;
  sampler.mip_filter = minify >= 9986 ? Filter::linear : Filter::nearest;
  return sampler;
}

}  // namespace

TextureTable::TextureTable(const tinygltf::Model& model) {
  for (const tinygltf::Texture& document : model.textures) {
    Declared& texture = textures_.emplace_back();
    texture.image = to_index(document.source);
    // The texture's own source is for readers that know neither.
    for (const char* const extension : {"KHR_texture_basisu", "EXT_texture_webp"}) {
      const auto other = find_extension(document.extensions, extension, "");
      if (!other || !other->has("source")) continue;
      texture.image = other->index("source");
      break;
    }
    if (const auto sampler = to_index(document.sampler)) {
      texture.sampler = to_sampler(model.samplers[*sampler]);
    }
  }
}

std::uint32_t TextureTable::use(std::uint32_t index, bool srgb) {
  const Declared& declared = textures_[index];
  if (!declared.image) return shared::no_texture;
  const std::uint32_t image = use_image(*declared.image, srgb);
  const auto [texture, new_texture] =
      texture_of_use_.try_emplace({index, srgb}, static_cast<std::uint32_t>(used_textures_.size()));
  if (new_texture) used_textures_.push_back({image, declared.sampler});
  return texture->second;
}

std::uint32_t TextureTable::use_image(std::uint32_t source, bool srgb) {
  const auto [image, is_new] =
      image_of_use_.try_emplace({source, srgb}, static_cast<std::uint32_t>(image_uses_.size()));
  if (is_new) image_uses_.push_back({source, srgb});
  return image->second;
}

std::uint32_t TextureTable::use_other(std::uint32_t source, bool srgb, const Sampler& sampler) {
  const Texture texture{use_image(source, srgb), sampler};
  const auto known = std::ranges::find_if(used_textures_, [&](const Texture& used) {
    return used.image == texture.image && used.sampler == texture.sampler;
  });
  if (known != used_textures_.end()) {
    return static_cast<std::uint32_t>(known - used_textures_.begin());
  }
  used_textures_.push_back(texture);
  return static_cast<std::uint32_t>(used_textures_.size() - 1);
}

void TextureTable::keep_only(std::span<shared::TextureSlot* const> slots) {
  std::map<std::uint32_t, std::uint32_t> textures;  // new numbers by old ones
  std::map<std::uint32_t, std::uint32_t> images;
  for (const shared::TextureSlot* const slot : slots) {
    if (slot->texture == shared::no_texture) continue;
    textures[slot->texture] = 0;
    images[used_textures_[slot->texture].image] = 0;
  }
  std::vector<ImageUse> kept_uses;
  for (auto& [before, now] : images) {
    now = static_cast<std::uint32_t>(kept_uses.size());
    kept_uses.push_back(image_uses_[before]);
  }
  std::vector<Texture> kept_textures;
  for (auto& [before, now] : textures) {
    now = static_cast<std::uint32_t>(kept_textures.size());
    const Texture& texture = used_textures_[before];
    kept_textures.push_back({images.at(texture.image), texture.sampler});
  }
  for (shared::TextureSlot* const slot : slots) {
    if (slot->texture != shared::no_texture) slot->texture = textures.at(slot->texture);
  }
  image_uses_ = std::move(kept_uses);
  used_textures_ = std::move(kept_textures);
  image_of_use_.clear();
  texture_of_use_.clear();
}

std::uint32_t TextureTable::use_converted(ConvertedImage kind, const SpecularGlossiness& factors,
                                          std::optional<std::uint32_t> diffuse,
                                          std::optional<std::uint32_t> specular) {
  const auto image_of = [&](std::optional<std::uint32_t> texture) {
    return texture ? textures_[*texture].image : std::nullopt;
  };
  const ImageConversion conversion{kind, factors, image_of(diffuse), image_of(specular)};
  if (!conversion.diffuse && !conversion.specular) return shared::no_texture;
  auto found = std::ranges::find(image_uses_, std::optional(conversion), &ImageUse::conversion);
  if (found == image_uses_.end()) {
    const std::uint32_t source = conversion.diffuse ? *conversion.diffuse : *conversion.specular;
    found = image_uses_.insert(
        found, {source, kind == ConvertedImage::base_color, std::optional(conversion)});
  }
  used_textures_.push_back({static_cast<std::uint32_t>(found - image_uses_.begin()),
                            textures_[diffuse ? *diffuse : *specular].sampler});
  return static_cast<std::uint32_t>(used_textures_.size() - 1);
}

}  // namespace heliograph::scene
