#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "gpu/memory/buffer.hpp"

namespace heliograph::gpu {

struct ImageDesc {
  std::string name;
  VkExtent2D extent{1, 1};
  VkFormat format = VK_FORMAT_R32G32B32A32_SFLOAT;
  VkImageUsageFlags usage = VK_IMAGE_USAGE_STORAGE_BIT;  // transfers are always allowed
  std::uint32_t levels = 1;
  std::uint32_t layers = 1;
  bool cube = false;
  bool mapped = false;  // linear tiling in host memory, reachable through host()
};

/// Bytes of a mapped image; rows are `row_pitch` bytes apart.
struct HostView {
  std::byte* data = nullptr;
  std::size_t row_pitch = 0;
  explicit operator bool() const { return data != nullptr; }
  template <typename Texel>
  Texel* row(std::uint32_t y) const {
    return reinterpret_cast<Texel*>(data + y * row_pitch);
  }
};

/// A 2D or cube image with its own memory, or, if mapped, in a block of several. It is moved to
/// GENERAL when made and stays there.
class Image {
 public:
  Image() = default;
  /// Its first commands go into `setup`, if given, which runs before anything else uses the image;
  /// otherwise they run at once.
  Image(const Device& device, ImageDesc desc, MemoryPlace place = {},
        VkCommandBuffer setup = VK_NULL_HANDLE);
  ~Image();
  Image(Image&& other) noexcept { swap(other); }
  Image& operator=(Image&& other) noexcept {
    swap(other);
    return *this;
  }

  /// What a block needs to hold such an image.
  static VkMemoryRequirements requirements(const Device& device, const ImageDesc& desc);

  VkImage handle() const { return handle_; }
  VkImageView view() const { return view_; }
  /// One mip level with all its layers, for storage access.
  VkImageView level_view(std::uint32_t level) const { return level_views_.at(level); }
  const ImageDesc& desc() const { return desc_; }
  HostView host() const { return host_; }
  /// The block in which the image lies, or null, and bytes of memory that it has for itself.
  const MemoryBlock* block() const { return block_.get(); }
  VkDeviceSize own_bytes() const { return own_bytes_; }
  explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }

  /// Zeroes every level and layer, in `setup`, if given; otherwise waits.
  void clear(VkCommandBuffer setup = VK_NULL_HANDLE) const;
  /// Copies tightly packed levels, level 0 first; waits.
  void upload(std::span<const std::byte> bytes) const;
  /// Level 0, layer `layer`, tightly packed; waits.
  std::vector<std::byte> download(std::uint32_t layer = 0) const;
  /// The same of any level.
  std::vector<std::byte> download_level(std::uint32_t level, std::uint32_t layer) const;

 private:
  void swap(Image& other) noexcept;
  VkImageView make_view(std::uint32_t first_level, std::uint32_t levels, bool storage) const;
  /// Binds memory and maps it, where the image is to be mapped.
  void bind_memory(MemoryPlace place);
  void initialise_layout(VkCommandBuffer commands) const;
  void record_now_or_into(VkCommandBuffer setup,
                          const std::function<void(VkCommandBuffer)>& record) const;

  const Device* device_ = nullptr;
  ImageDesc desc_;
  VkImage handle_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;  // its own
  VkDeviceSize own_bytes_ = 0;
  std::shared_ptr<const MemoryBlock> block_;
  VkImageView view_ = VK_NULL_HANDLE;
  std::vector<VkImageView> level_views_;
  HostView host_;
};

/// Bytes per texel of the formats this renderer uses, but for compressed ones. @throws GpuError for
/// any other
std::uint32_t texel_bytes(VkFormat format);
/// Bytes of a tightly packed level of that size. BC7 has 16 for each 4 x 4 texels, cut ones too.
/// @throws GpuError as texel_bytes() does
VkDeviceSize level_bytes(VkFormat format, VkExtent2D size);
/// Bytes of all levels and layers, tightly packed. @throws GpuError as texel_bytes() does
VkDeviceSize packed_bytes(const ImageDesc& desc);
const char* format_name(VkFormat format);
bool is_depth(VkFormat format);

class Sampler {
 public:
  Sampler() = default;
  Sampler(const Device& device, const VkSamplerCreateInfo& info);
  ~Sampler();
  Sampler(Sampler&& other) noexcept { swap(other); }
  Sampler& operator=(Sampler&& other) noexcept {
    swap(other);
    return *this;
  }
  VkSampler handle() const { return handle_; }

 private:
  void swap(Sampler& other) noexcept;
  const Device* device_ = nullptr;
  VkSampler handle_ = VK_NULL_HANDLE;
};

}  // namespace heliograph::gpu
