#include "render/resources/sampled_texture.hpp"

#include "scene/image/bc7/bc7_image.hpp"
#include "scene/image/ktx2/ktx2_decoder.hpp"

namespace heliograph::render {
namespace {

// Signal to noise, in dB, from which on a texture stays compressed. Errors of normals and roughness
// show in reflections long before those of colours do: 42 dB are two steps of 255, of a normal
// about a degree. Most textures have 45 and more; noise in three channels has less.
constexpr double least_of_colors = 38.0;
constexpr double least_of_data = 42.0;

}  // namespace

gpu::Image make_sampled_texture(const gpu::Device& device, const scene::Image& from,
                                std::span<const std::uint8_t> pixels, bool compressed) {
  gpu::ImageDesc desc{.name = from.name.empty() ? "texture" : from.name};
  desc.extent = {from.width, from.height};
  desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  desc.levels = from.levels;
  const auto upload = [&](VkFormat format, std::span<const std::uint8_t> levels) {
    desc.format = format;
    gpu::Image image(device, desc);
    image.upload(std::as_bytes(levels));
    return image;
  };
  if (compressed && from.file && scene::is_ktx2(*from.file)) {
    const scene::Bc7Levels bc7 = scene::encode_bc7(from, pixels);
    if (bc7.signal_to_noise >= (from.srgb ? least_of_colors : least_of_data)) {
      return upload(from.srgb ? VK_FORMAT_BC7_SRGB_BLOCK : VK_FORMAT_BC7_UNORM_BLOCK, bc7.blocks);
    }
  }
  return upload(from.srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM, pixels);
}

}  // namespace heliograph::render
