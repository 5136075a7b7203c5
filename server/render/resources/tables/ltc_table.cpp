#include "render/resources/tables/ltc_table.hpp"

#include <glm/gtc/packing.hpp>
#include <span>
#include <vector>

namespace heliograph::render {
namespace {

constexpr std::array<std::uint64_t, ltc_table_size * ltc_table_size> ltc_table{
#include "render/resources/tables/ltc_table.inc"
};

}  // namespace

gpu::Image make_ltc_image(const gpu::Device& device) {
  std::vector<glm::vec4> texels;
  for (const std::uint64_t packed : ltc_table) texels.push_back(glm::unpackHalf4x16(packed));
  gpu::ImageDesc desc{.name = "linearly transformed cosines"};
  desc.extent = {ltc_table_size, ltc_table_size};
  desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  desc.mapped = device.is_cpu();  // host kernels read it
  gpu::Image image(device, desc);
  image.upload(std::as_bytes(std::span(texels)));
  return image;
}

}  // namespace heliograph::render
