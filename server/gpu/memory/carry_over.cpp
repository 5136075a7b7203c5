#include "gpu/memory/carry_over.hpp"

#include <cstring>

namespace heliograph::gpu {
namespace {

/// The texel of `in` that lies nearest to texel `at` of `of`, along one axis.
std::uint32_t nearest(std::uint32_t at, std::uint32_t of, std::uint32_t in) {
  return static_cast<std::uint32_t>((2ull * at + 1) * in / (2ull * of));
}

void carry_over_on_host(const Image& from, const Image& to) {
  const VkExtent2D source = from.desc().extent, target = to.desc().extent;
  const std::size_t bytes = texel_bytes(to.desc().format);
  for (std::uint32_t y = 0; y < target.height; ++y) {
    const auto* const texels = from.host().row<std::byte>(nearest(y, target.height, source.height));
    auto* const row = to.host().row<std::byte>(y);
    if (source.width == target.width) {
      std::memcpy(row, texels, bytes * target.width);
      continue;
    }
    for (std::uint32_t x = 0; x < target.width; ++x) {
      std::memcpy(row + bytes * x, texels + bytes * nearest(x, target.width, source.width), bytes);
    }
  }
}

}  // namespace

void carry_over(const Device& device, const Image& from, const Image& to) {
  if (from.host() && to.host()) return carry_over_on_host(from, to);
  const auto corner = [](const Image& image) {
    const VkExtent2D extent = image.desc().extent;
    return VkOffset3D{static_cast<int>(extent.width), static_cast<int>(extent.height), 1};
  };
  VkImageBlit region{};
  region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  region.srcOffsets[1] = corner(from);
  region.dstOffsets[1] = corner(to);
  device.submit_once([&](VkCommandBuffer commands) {
    full_barrier(commands);
    vkCmdBlitImage(commands, from.handle(), VK_IMAGE_LAYOUT_GENERAL, to.handle(),
                   VK_IMAGE_LAYOUT_GENERAL, 1, &region, VK_FILTER_NEAREST);
    full_barrier(commands);
  });
}

void carry_over(const Device& device, const Buffer& from, const Buffer& to) {
  device.submit_once([&](VkCommandBuffer commands) {
    full_barrier(commands);
    const VkBufferCopy region{0, 0, to.size()};
    vkCmdCopyBuffer(commands, from.handle(), to.handle(), 1, &region);
    full_barrier(commands);
  });
}

}  // namespace heliograph::gpu
