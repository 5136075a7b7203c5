#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gpu/memory/buffer.hpp"
#include "gpu/memory/image.hpp"

namespace heliograph::gpu {

/// Brings one layer of images of one size and format to the host, again and again through the same
/// memory: allocating such memory costs more than the copy.
class Readback {
 public:
  Readback() = default;
  /// For images like `image`, which need not be the one that is read.
  Readback(const Device& device, const Image& image);

  explicit operator bool() const { return size_ > 0; }
  std::size_t size() const { return size_; }  // bytes, tightly packed
  /// Whether the device has to copy: layers of mapped images are read where they lie.
  bool copies() const { return static_cast<bool>(staging_); }

  /// Records the copy of level 0 of `layer`, behind all commands before it. Nothing to do for layer
  /// 0 of mapped images.
  void record(VkCommandBuffer commands, const Image& image, std::uint32_t layer = 0) const;
  /// What record() copied, once its commands are done; size() bytes, as std::uint8_t or std::byte.
  template <typename Byte>
  std::vector<Byte> read(const Image& image, std::uint32_t layer = 0) const;

 private:
  std::size_t size_ = 0;
  Buffer staging_;  // none while only mapped images are read
};

}  // namespace heliograph::gpu
