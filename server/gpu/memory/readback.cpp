#include "gpu/memory/readback.hpp"

namespace heliograph::gpu {
namespace {

bool is_mapped(const Image& image, std::uint32_t layer) {
  return image.host().data && layer == 0;
}

std::size_t row_bytes(const ImageDesc& desc) {
  return std::size_t{desc.extent.width} * texel_bytes(desc.format);
}

}  // namespace

Readback::Readback(const Device& device, const Image& image)
    : size_(row_bytes(image.desc()) * image.desc().extent.height) {
  if (is_mapped(image, 0) && image.desc().layers == 1) return;
  staging_ = Buffer(device, image.desc().name + " readback", size_, 0, Memory::readback);
}

void Readback::record(VkCommandBuffer commands, const Image& image, std::uint32_t layer) const {
  if (is_mapped(image, layer)) return;
  full_barrier(commands);
  VkBufferImageCopy region{};
  region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, layer, 1};
  if (is_depth(image.desc().format)) {
    region.imageSubresource.aspectMask = VK_IMAGE_ASPECT_DEPTH_BIT;
  }
  region.imageExtent = {image.desc().extent.width, image.desc().extent.height, 1};
  vkCmdCopyImageToBuffer(commands, image.handle(), VK_IMAGE_LAYOUT_GENERAL, staging_.handle(), 1,
                         &region);
  full_barrier(commands);
}

template <typename Byte>
std::vector<Byte> Readback::read(const Image& image, std::uint32_t layer) const {
  std::vector<Byte> bytes;
  bytes.reserve(size_);  // not filled first: that takes as long as the copy
  const auto append = [&](const Byte* from, std::size_t count) {
    bytes.insert(bytes.end(), from, from + count);
  };
  if (!is_mapped(image, layer)) {
    append(reinterpret_cast<const Byte*>(staging_.mapped()), size_);
    return bytes;
  }
  for (std::uint32_t y = 0; y < image.desc().extent.height; ++y) {
    append(image.host().row<const Byte>(y), row_bytes(image.desc()));
  }
  return bytes;
}

template std::vector<std::uint8_t> Readback::read(const Image&, std::uint32_t) const;
template std::vector<std::byte> Readback::read(const Image&, std::uint32_t) const;

}  // namespace heliograph::gpu
