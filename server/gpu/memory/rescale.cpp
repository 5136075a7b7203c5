#include "gpu/memory/rescale.hpp"

#include <cstring>
#include <vector>

namespace heliograph::gpu {
namespace {

/// For each texel of `to` the nearest of `from`, along one axis.
std::vector<std::uint32_t> nearest_texels(std::uint32_t from, std::uint32_t to) {
  std::vector<std::uint32_t> nearest(to);
  for (std::uint32_t at = 0; at < to; ++at) {
    nearest[at] = static_cast<std::uint32_t>((2ull * at + 1) * from / (2ull * to));
  }
  return nearest;
}

/// Texels move toward the first one where the image shrinks and away from it where it grows: in
/// that order each is read before another takes its place.
template <typename Visit>
void in_order(std::size_t count, bool shrinks, const Visit& visit) {
  for (std::size_t i = 0; i < count; ++i) visit(shrinks ? i : count - 1 - i);
}

template <std::size_t bytes>
void rescale_texels(const HostView& texels, VkExtent2D from, VkExtent2D to) {
  const std::vector<std::uint32_t> columns = nearest_texels(from.width, to.width);
  const std::vector<std::uint32_t> rows = nearest_texels(from.height, to.height);
  in_order(rows.size(), to.height <= from.height, [&](std::size_t y) {
    const auto* const source = texels.row<std::byte>(rows[y]);
    auto* const target = texels.row<std::byte>(static_cast<std::uint32_t>(y));
    in_order(columns.size(), to.width <= from.width, [&](std::size_t x) {
      std::memmove(target + bytes * x, source + bytes * columns[x], bytes);
    });
  });
}

void rescale_on_host(const Image& image, VkExtent2D from, VkExtent2D to) {
  switch (texel_bytes(image.desc().format)) {
    case 4:
      return rescale_texels<4>(image.host(), from, to);
    case 8:
      return rescale_texels<8>(image.host(), from, to);
    case 16:
      return rescale_texels<16>(image.host(), from, to);
    default:
      throw GpuError("no scaling of " + image.desc().name);
  }
}

}  // namespace

void rescale(const Device& device, const Image& image, const Image& scratch, VkExtent2D from,
             VkExtent2D to) {
  if (image.host()) return rescale_on_host(image, from, to);
  const auto corner = [](VkExtent2D extent) {
    return VkOffset3D{static_cast<int>(extent.width), static_cast<int>(extent.height), 1};
  };
  const VkImageSubresourceLayers layer{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  VkImageBlit scaled{};
  scaled.srcSubresource = scaled.dstSubresource = layer;
  scaled.srcOffsets[1] = corner(from);
  scaled.dstOffsets[1] = corner(to);
  VkImageCopy back{};
  back.srcSubresource = back.dstSubresource = layer;
  back.extent = {to.width, to.height, 1};
  device.submit_once([&](VkCommandBuffer commands) {
    full_barrier(commands);
    vkCmdBlitImage(commands, image.handle(), VK_IMAGE_LAYOUT_GENERAL, scratch.handle(),
                   VK_IMAGE_LAYOUT_GENERAL, 1, &scaled, VK_FILTER_NEAREST);
    full_barrier(commands);
    vkCmdCopyImage(commands, scratch.handle(), VK_IMAGE_LAYOUT_GENERAL, image.handle(),
                   VK_IMAGE_LAYOUT_GENERAL, 1, &back);
    full_barrier(commands);
  });
}

}  // namespace heliograph::gpu
