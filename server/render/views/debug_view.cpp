#include "render/views/debug_view.hpp"

#include <cstring>
#include <glm/gtc/packing.hpp>

namespace heliograph::render {
namespace {

float channel(const std::byte* texel, VkFormat format, std::uint32_t index) {
  const auto load = [&]<typename T>(T, std::uint32_t count, float scale) {
    if (index >= count) return index == 3 ? 1.0f : 0.0f;
    T value;
    std::memcpy(&value, texel + index * sizeof(T), sizeof(T));
    return static_cast<float>(value) * scale;
  };
  switch (format) {
    case VK_FORMAT_R32G32B32A32_SFLOAT:
      return load(0.0f, 4, 1.0f);
    case VK_FORMAT_R32G32_SFLOAT:
      return load(0.0f, 2, 1.0f);
    case VK_FORMAT_R32_SFLOAT:
      return load(0.0f, 1, 1.0f);
    case VK_FORMAT_R32_UINT:
      return load(std::uint32_t{}, 1, 1.0f);
    case VK_FORMAT_R8G8B8A8_UNORM:
      return load(std::uint8_t{}, 4, 1.0f / 255.0f);
    case VK_FORMAT_R16G16B16A16_UNORM:
      return load(std::uint16_t{}, 4, 1.0f / 65535.0f);
    case VK_FORMAT_R16G16_SFLOAT:
      if (index >= 2) return load(0.0f, 0, 1.0f);
      [[fallthrough]];
    case VK_FORMAT_R16G16B16A16_SFLOAT: {
      std::uint16_t half;
      std::memcpy(&half, texel + index * 2, 2);
      return glm::unpackHalf1x16(half);
    }
    default:
      throw gpu::GpuError(std::string("no view of ") + gpu::format_name(format));
  }
}

std::uint32_t channels_of(VkFormat format) {
  switch (format) {
    case VK_FORMAT_R32_SFLOAT:
    case VK_FORMAT_R32_UINT:
      return 1;
    case VK_FORMAT_R16G16_SFLOAT:
    case VK_FORMAT_R32G32_SFLOAT:
      return 2;
    default:
      return 4;
  }
}

FloatImage shape_of(VkFormat format, std::uint32_t width, std::uint32_t height) {
  FloatImage values{.width = width, .height = height, .channels = channels_of(format)};
  values.integers = format == VK_FORMAT_R32_UINT;
  values.rgba.resize(std::size_t{width} * height * 4);
  return values;
}

}  // namespace

FloatImage read_texel(const gpu::Image& image, std::uint32_t x, std::uint32_t y) {
  const auto& desc = image.desc();
  const std::uint32_t stride = gpu::texel_bytes(desc.format);
  FloatImage value = shape_of(desc.format, 1, 1);
  const auto read = [&](const std::byte* texel) {
    for (std::uint32_t c = 0; c < 4; ++c) value.rgba[c] = channel(texel, desc.format, c);
  };
  if (const gpu::HostView host = image.host(); host.data) {
    read(host.data + y * host.row_pitch + std::size_t{x} * stride);
  } else {
    read(image.download().data() + (std::size_t{y} * desc.extent.width + x) * stride);
  }
  return value;
}

FloatImage read_image(const gpu::Image& image, VkExtent2D size) {
  const auto& desc = image.desc();
  const std::vector<std::byte> bytes = image.download();
  const std::uint32_t stride = gpu::texel_bytes(desc.format);
  FloatImage values = shape_of(desc.format, size.width, size.height);
  float* value = values.rgba.data();
  for (std::size_t y = 0; y < size.height; ++y) {
    const std::byte* const row = bytes.data() + y * desc.extent.width * stride;
    for (std::size_t x = 0; x < size.width; ++x) {
      for (std::uint32_t c = 0; c < 4; ++c) *value++ = channel(row + x * stride, desc.format, c);
    }
  }
  return values;
}

}  // namespace heliograph::render
