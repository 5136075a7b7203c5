#pragma once

#include <cstring>
#include <span>

#include "gpu/memory/buffer.hpp"

namespace heliograph::render {

/// A table on the device that the host may write, with these elements.
template <typename Element>
gpu::Buffer writable_table(const gpu::Device& device, const char* name,
                           std::span<const Element> elements, VkBufferUsageFlags usage) {
  gpu::Buffer table(device, name, elements.size_bytes(), usage, gpu::Memory::upload);
  std::memcpy(table.mapped(), elements.data(), elements.size_bytes());
  return table;
}

}  // namespace heliograph::render
