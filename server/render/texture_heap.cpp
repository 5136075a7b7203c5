#include "render/texture_heap.hpp"

#include <algorithm>
#include <cstring>

namespace heliograph::render {
namespace {

constexpr std::uint32_t largest_side = 1024;

std::uint32_t side(std::uint32_t size, std::uint32_t level) {
  return std::max(size >> level, 1u);
}

std::uint64_t texels(const scene::Image& image, std::uint32_t first, std::uint32_t last) {
  std::uint64_t sum = 0;
  for (std::uint32_t level = first; level < last; ++level) {
    sum += std::uint64_t{side(image.width, level)} * side(image.height, level);
  }
  return sum;
}

/// The first level no side of which is longer than `longest`; the last where none is short enough.
std::uint32_t first_level(const scene::Image& image, std::uint32_t longest) {
  std::uint32_t level = 0;
  while (level + 1 < image.levels &&
         std::max(side(image.width, level), side(image.height, level)) > longest) {
    ++level;
  }
  return level;
}

std::uint32_t longest_side_that_fits(const scene::Scene& scene, std::uint64_t most_texels) {
  for (std::uint32_t longest = largest_side; longest > 1; longest /= 2) {
    std::uint64_t sum = 0;
    for (const scene::Image& image : scene.images) {
      sum += texels(image, first_level(image, longest), image.levels);
    }
    if (sum <= most_texels) return longest;
  }
  throw gpu::GpuError("the scene's " + std::to_string(scene.images.size()) +
                      " images do not fit into one buffer of this device, which holds " +
                      std::to_string(most_texels) + " texels");
}

std::uint32_t flags(const scene::Image& image, const scene::Sampler& sampler) {
  const auto bit = [](bool on, std::uint32_t flag) { return on ? flag : 0u; };
  return bit(image.srgb, shared::texture_srgb) |
         bit(sampler.magnify == scene::Filter::nearest, shared::texture_magnify_nearest) |
         bit(sampler.minify == scene::Filter::nearest, shared::texture_minify_nearest) |
         bit(sampler.mip_filter == scene::Filter::nearest, shared::texture_levels_nearest);
}

}  // namespace

PackedTextures pack_textures(const scene::Scene& scene, std::uint64_t most_texels) {
  const std::uint32_t longest = longest_side_that_fits(scene, most_texels);
  PackedTextures packed;
  std::vector<std::uint32_t> first_texel;
  for (const scene::Image& image : scene.images) {
    const std::uint32_t level = first_level(image, longest);
    const std::uint64_t skipped = texels(image, 0, level);
    const std::uint64_t kept = texels(image, level, image.levels);
    first_texel.push_back(static_cast<std::uint32_t>(packed.texels.size()));
    packed.texels.resize(packed.texels.size() + kept);
    std::memcpy(&packed.texels[first_texel.back()], &image.pixels[skipped * 4], kept * 4);
  }
  for (const scene::Texture& texture : scene.textures) {
    const scene::Image& image = scene.images[texture.image];
    const std::uint32_t level = first_level(image, longest);
    shared::HeapTexture entry{};
    entry.first_texel = first_texel[texture.image];
    entry.width = side(image.width, level);
    entry.height = side(image.height, level);
    entry.levels = texture.sampler.mipmapped ? image.levels - level : 1;
    entry.wrap_s = texture.sampler.wrap_s;
    entry.wrap_t = texture.sampler.wrap_t;
    entry.flags = flags(image, texture.sampler);
    packed.textures.push_back(entry);
  }
  return packed;
}

TextureHeap make_texture_heap(const gpu::Device& device, const scene::Scene& scene) {
  const PackedTextures packed = pack_textures(scene, device.limits().maxTexelBufferElements);
  return {gpu::upload_buffer(device, "texture heap", std::as_bytes(std::span(packed.texels)),
                             VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT),
          gpu::upload_buffer(device, "textures", std::as_bytes(std::span(packed.textures)),
                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT)};
}

}  // namespace heliograph::render
