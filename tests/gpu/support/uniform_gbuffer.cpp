#include "tests/gpu/support/uniform_gbuffer.hpp"

#include <glm/gtc/packing.hpp>

#include "render/resources/gbuffer_formats.hpp"

namespace heliograph::test {

render::GBuffer make_uniform_gbuffer(FrameRig& rig, const SurfacePixel& pixel) {
  const std::size_t count = std::size_t{rig.plan().extent().width} * rig.plan().extent().height;
  const auto everywhere = [&]<typename Texel>(const char* name, std::size_t signal, Texel texel) {
    return rig.input(name, render::gbuffer_formats[signal], std::vector(count, texel));
  };
  const glm::vec2 code = octahedral(pixel.normal);
  render::GBuffer gbuffer;
  gbuffer.normals = everywhere("normals", 0, glm::vec4(code, code));
  gbuffer.base_color = everywhere(
      "base_color", 1, glm::packUnorm4x8(glm::vec4(glm::sqrt(pixel.color), pixel.occlusion)));
  gbuffer.surface = everywhere(
      "surface", 2,
      glm::packUnorm4x8({pixel.roughness, pixel.metallic, pixel.unlit ? 1.0f : 0.0f, 0.0f}));
  gbuffer.layers = rig.plan().image("layers", render::gbuffer_layers_format, 0, VkExtent2D{1, 1});
  gbuffer.motion = everywhere("motion", 3, glm::vec4(0, 0, 0, pixel.view_z));
  gbuffer.emissive = everywhere("emissive", 4, glm::packHalf4x16(glm::vec4(pixel.emissive, 1)));
  gbuffer.depth_slope = everywhere("depth_slope", 5, glm::vec2(0.0f));
  gbuffer.instance = everywhere("instance", 6, pixel.view_z > 0.0f ? 1u : 0u);
  return gbuffer;
}

}  // namespace heliograph::test
