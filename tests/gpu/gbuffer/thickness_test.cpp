// What the scale of instances makes of the thickness of volumes (KHR_materials_volume), in every
// way to find a G-buffer.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <iostream>
#include <stdexcept>

#include "render/passes/gbuffer/draw_gbuffer.hpp"
#include "render/passes/gbuffer/gbuffer.hpp"
#include "render/passes/gbuffer/trace_gbuffer.hpp"
#include "tests/gpu/support/kernel_comparison.hpp"

namespace heliograph::test {
namespace {

constexpr VkExtent2D extent{16, 16};
constexpr glm::vec3 after_a_metre{0.8f, 0.5f, 0.2f};  // colour of white light

enum class Way { raster, ray_shaders, ray_kernels, drawing_kernels };

render::GBuffer gbuffer_of(FrameRig& rig, Way way) {
  switch (way) {
    case Way::raster:
      return render::rasterize_gbuffer(rig.plan(), rig.inputs());
    case Way::ray_shaders:
      return render::trace_gbuffer(rig.plan(), with_host_kernels(rig, false));
    case Way::ray_kernels:
      return render::trace_gbuffer(rig.plan(), with_host_kernels(rig, true));
    case Way::drawing_kernels:
      return render::draw_gbuffer(rig.plan(), with_host_kernels(rig, true));
  }
  throw std::logic_error("no such way");
}

/// The tint of the light that scatters through a wall which is a metre thick in mesh space, divided
/// by `modelled`, and whose instance has the scale `placed`. It fills the frame.
glm::vec3 seen_tint(Way way, float modelled, float placed) {
  SceneBuilder builder;
  const scene::MaterialLayers layers{.thickness = 1.0f / modelled,
                                     .attenuation_distance = 1.0f,
                                     .attenuation_color = after_a_metre,
                                     .diffuse_transmission = 1.0f};
  const float h = 8.0f / modelled;
  const auto wall = builder.add_quad({{{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}}},
                                     builder.with_layers(surface(glm::vec3(1.0f)), layers));
  builder.place(wall, glm::scale(glm::mat4(1.0f), glm::vec3(placed)));
  FrameRig rig(builder.build(), look({0, 0, 2}, {0, 0, 0}), {.extent = extent});
  const render::GBuffer gbuffer = gbuffer_of(rig, way);
  rig.run();
  const auto bytes = rig.plan().latest(gbuffer.layers).download();
  glm::uvec4 word(0);
  const std::size_t middle = (extent.height / 2) * extent.width + extent.width / 2;
  std::memcpy(&word, bytes.data() + middle * sizeof word, sizeof word);
  // pack_layer() of shaders/lib/scene/layers.glsl
  const glm::vec3 root = glm::vec3(glm::uvec3(word.y, word.y >> 8u, word.y >> 16u) & 255u) / 255.0f;
  return root * root;
}

/// The software device of Debian 12's Mesa (22.3) ends the process when it rasterises to eight
/// images, where kernels draw otherwise; that of newer_mesa.sh does not.
bool can_rasterise() {
  return !has_host_kernels() || std::getenv("HELIOGRAPH_TEST_ALL_TRACERS") != nullptr;
}

TEST(Thickness, GrowsWithTheScaleOfTheInstance) {
  if (!can_rasterise()) std::cout << "the rasteriser is left out: Mesa's may end the process\n";
  for (const Way way : {Way::raster, Way::ray_shaders, Way::ray_kernels, Way::drawing_kernels}) {
    if (way >= Way::ray_kernels && !has_host_kernels()) continue;
    if (way == Way::raster && !can_rasterise()) continue;
    const auto expect_tint = [&](float modelled, float placed) {
      const glm::vec3 tint = seen_tint(way, modelled, placed);
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(tint[c], std::pow(after_a_metre[c], placed / modelled), 0.005f)
            << "way " << static_cast<int>(way) << ", scale " << placed << " / " << modelled;
      }
    };
    expect_tint(1.0f, 1.0f);
    expect_tint(10.0f, 10.0f);
    expect_tint(1.0f, 2.0f);
    expect_tint(1.0f, 0.5f);
  }
}

}  // namespace
}  // namespace heliograph::test
