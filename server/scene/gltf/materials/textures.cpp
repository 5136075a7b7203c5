#include "scene/gltf/materials/textures.hpp"

namespace heliograph::scene {
namespace {

std::uint32_t read_wrap(const JsonValue& sampler, std::string_view key) {
  switch (sampler.integer(key, 10497)) {
    case 10497:
      return shared::wrap_repeat;
    case 33071:
      return shared::wrap_clamp;
    case 33648:
      return shared::wrap_mirror;
    default:
      sampler.refuse(key, "is not a wrapping mode");
  }
}

Sampler read_sampler(const JsonValue& json) {
  Sampler sampler;
  sampler.wrap_s = read_wrap(json, "wrapS");
  sampler.wrap_t = read_wrap(json, "wrapT");
  switch (json.integer("magFilter", 9729)) {
    case 9728:
      sampler.magnify = Filter::nearest;
      break;
    case 9729:
      break;
    default:
      json.refuse("magFilter", "is not a magnification filter");
  }
  const std::uint64_t minify = json.integer("minFilter", 9987);
  switch (minify) {
    case 9728:
    case 9729:
    case 9984:
    case 9985:
    case 9986:
    case 9987:
      break;
    default:
      json.refuse("minFilter", "is not a minification filter");
  }
  // 9984 and up: bit 0 is the filter within a level, bit 1 the filter between levels.
  sampler.minify = minify % 2 == 0 ? Filter::nearest : Filter::linear;
  sampler.mipmapped = minify >= 9984;
  sampler.mip_filter = minify >= 9986 ? Filter::linear : Filter::nearest;
  return sampler;
}

}  // namespace

TextureTable::TextureTable(const JsonValue& root) {
  std::vector<Sampler> samplers;
  for (const JsonValue& json : root.objects("samplers")) samplers.push_back(read_sampler(json));
  const std::size_t image_count = root.objects("images").size();
  for (const JsonValue& json : root.objects("textures")) {
    Declared& texture = textures_.emplace_back();
    texture.image = json.index("source", image_count, "images");
    if (const auto webp = json.object("extensions", "EXT_texture_webp")) {
      texture.image = webp->required_index("source", image_count, "images");
    }
    if (const auto sampler = json.index("sampler", samplers.size(), "samplers")) {
      texture.sampler = samplers[*sampler];
    }
  }
}

std::uint32_t TextureTable::use(std::uint32_t index, bool srgb) {
  const Declared& declared = textures_[index];
  if (!declared.image) return shared::no_texture;
  const auto [image, new_image] = image_of_use_.try_emplace(
      {*declared.image, srgb}, static_cast<std::uint32_t>(image_uses_.size()));
  if (new_image) image_uses_.push_back({*declared.image, srgb});
  const auto [texture, new_texture] =
      texture_of_use_.try_emplace({index, srgb}, static_cast<std::uint32_t>(used_textures_.size()));
  if (new_texture) used_textures_.push_back({image->second, declared.sampler});
  return texture->second;
}

}  // namespace heliograph::scene
