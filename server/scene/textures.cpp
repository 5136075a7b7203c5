#include "scene/textures.hpp"

#include <algorithm>

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
  // 9984 and up: bit 0 is the filter within a level, bit 1 the one between levels.
  sampler.minify = minify % 2 == 0 ? Filter::nearest : Filter::linear;
  sampler.mipmapped = minify >= 9984;
  sampler.mip_filter = minify >= 9986 ? Filter::linear : Filter::nearest;
  return sampler;
}

template <typename T>
std::uint32_t find_or_add(std::vector<T>& items, const T& item) {
  const auto found = std::find(items.begin(), items.end(), item);
  if (found != items.end()) return static_cast<std::uint32_t>(found - items.begin());
  items.push_back(item);
  return static_cast<std::uint32_t>(items.size() - 1);
}

}  // namespace

TextureTable::TextureTable(const JsonValue& root) {
  std::vector<Sampler> samplers;
  for (const JsonValue& json : root.objects("samplers")) samplers.push_back(read_sampler(json));
  const std::size_t image_count = root.objects("images").size();
  for (const JsonValue& json : root.objects("textures")) {
    Declared& texture = textures_.emplace_back();
    texture.image = json.index("source", image_count, "images");
    if (const auto sampler = json.index("sampler", samplers.size(), "samplers")) {
      texture.sampler = samplers[*sampler];
    }
  }
}

std::uint32_t TextureTable::use(std::uint32_t index, bool srgb) {
  const Declared& declared = textures_[index];
  if (!declared.image) return shared::no_texture;
  const std::uint32_t image = find_or_add(image_uses_, ImageUse{*declared.image, srgb});
  return find_or_add(used_textures_, Texture{image, declared.sampler});
}

}  // namespace heliograph::scene
