#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "render/passes/compose/compose.hpp"
#include "render/passes/gbuffer/trace_gbuffer.hpp"
#include "render/passes/indirect/trace_indirect.hpp"
#include "render/passes/reflections/trace_specular.hpp"
#include "render/passes/visibility/trace_visibility.hpp"
#include "tests/gpu/support/kernel_comparison.hpp"

namespace heliograph::test {
namespace {

/// A corner with spheres, lit by 200 lights of every kind. None is so near to a wall that a small
/// part of a cell has most of the light. `curtain`: before them hangs one that lets light through.
std::shared_ptr<const scene::Scene> lit_corner(bool curtain) {
  SceneBuilder builder;
  if (curtain) {
    const auto cloth = builder.with_layers(
        surface({0.8f, 0.7f, 0.6f}),
        {.diffuse_transmission = 0.7f, .diffuse_transmission_color = {0.9f, 0.6f, 0.5f}});
    builder.place(builder.add_quad({{{-2, 0, 3}, {2, 0, 3}, {2, 4, 3}, {-2, 4, 3}}}, cloth));
  }
  const auto wall = surface({0.8f, 0.7f, 0.6f}, 0.4f, 0.3f);
  builder.place(builder.add_quad({{{-6, 0, 6}, {6, 0, 6}, {6, 0, -6}, {-6, 0, -6}}}, wall));
  builder.place(builder.add_quad({{{-6, 0, -6}, {6, 0, -6}, {6, 6, -6}, {-6, 6, -6}}}, wall));
  const auto sphere = builder.add_sphere(0.7f, surface(glm::vec3(0.9f), 0.2f, 1.0f));
  for (int i = 0; i < 4; ++i) {
    builder.place(sphere, glm::translate(glm::mat4(1.0f), glm::vec3(2.5f * (i - 1.5f), 0.7f, 0)));
  }
  auto scene = std::make_shared<scene::Scene>(*builder.build());
  std::mt19937 generator(23);
  std::uniform_real_distribution<float> place(-6.0f, 6.0f), unit(0.0f, 1.0f);
  for (int i = 0; i < 200; ++i) {
    shared::Light light{};
    light.type = i % 3 == 0 ? shared::light_spot : shared::light_point;
    if (i == 100) light.type = shared::light_directional;
    if (i == 150) light.type = shared::light_disk;
    light.position = {place(generator), 2.0f + 3.0f * unit(generator),
                      std::max(place(generator), -4.0f)};
    light.direction = glm::normalize(glm::vec3(unit(generator) - 0.5f, -1.0f, -unit(generator)));
    light.tangent = {1, 0, 0};
    light.color = glm::vec3(unit(generator), unit(generator), unit(generator)) * 0.12f;
    light.range = i % 2 ? 5.0f : 0.0f;
    light.radius = 0.05f;
    light.spot_scale = 4.0f;
    light.spot_offset = -2.0f;
    scene->lights.push_back({"light", light});
  }
  return scene;
}

const scene::Camera camera = look({1, 3, 8}, {0, 1, 0});

/// What lights do, by the shaders and by the host kernels.
class KernelComparison {
 public:
  explicit KernelComparison(VkExtent2D extent, bool indirect = false, bool by_grid = true,
                            bool curtain = false)
      : rig_(lit_corner(curtain), camera,
             {.extent = extent,
              .environment = make_environment(16, [](const glm::vec3&) { return glm::vec3(0.0f); }),
              .settings = settings(indirect, by_grid)}) {
    const auto gbuffer = render::trace_gbuffer(rig_.plan(), with_host_kernels(rig_, true));
    RandomFrame random(rig_);
    const auto background = random.four("background", glm::vec4(0), glm::vec4(0));
    for (const bool host : {false, true}) {
      const auto& in = with_host_kernels(rig_, host);
      auto& plan = rig_.plan();
      Signals made;
      if (indirect) {
        const auto cache = render::update_radiance_cache(plan, in);
        made.indirect = render::trace_indirect(plan, in, gbuffer, cache, {});
      } else {
        made.shadows = render::trace_shadows(plan, in, gbuffer, {});
        made.specular = render::trace_specular(plan, in, gbuffer);
        const render::NoisySignals noisy{made.shadows, made.shadows, made.specular, {}};
        made.hdr = render::compose(plan, in, gbuffer, noisy, {}, background).hdr;
      }
      signals_.push_back(made);
    }
    rig_.invalidate_history();
  }

  void run(std::uint32_t first, std::uint32_t last) {
    for (std::uint32_t i = first; i < last; ++i) {
      rig_.set_view(camera, i);
      rig_.run();
    }
  }
  struct Signals {
    gpu::ImageRef shadows, specular, hdr, indirect;
  };
  ErrorStatistics error(gpu::ImageRef Signals::*signal) const {
    return compare(rig_.read(signals_[0].*signal), rig_.read(signals_[1].*signal));
  }
  double mean(std::size_t which, gpu::ImageRef Signals::*signal) const {
    const render::FloatImage image = rig_.read(signals_[which].*signal);
    double sum = 0.0;
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) sum += image.rgba[i];
    return 4.0 * sum / double(image.rgba.size());
  }

 private:
  static protocol::Settings settings(bool indirect, bool by_grid) {
    protocol::Settings made;
    made.lighting.light_grid = by_grid;
    made.indirect.enabled = indirect;
    // Many small cells, all of them updated in each frame: little noise in their mean.
    made.indirect.cell_angle = 0.02f;
    made.indirect.updates = 65536;
    return made;
  }

  FrameRig rig_;
  std::vector<Signals> signals_;
};

using Signals = KernelComparison::Signals;

class LightGridKernel : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_host_kernels()) GTEST_SKIP() << "host kernels run on CPU devices only";
  }
};

void expect_equal(VkExtent2D extent, bool curtain) {
  KernelComparison comparison(extent, false, true, curtain);
  comparison.run(5, 6);
  for (const auto signal : {&Signals::shadows, &Signals::specular, &Signals::hdr}) {
    const ErrorStatistics error = comparison.error(signal);
    EXPECT_GT(error.magnitude, 0.05);
    EXPECT_LT(error.outliers, 0.015) << extent.width;
    EXPECT_LT(error.mean, 5e-3) << extent.width;
  }
}

// Rounding may put a place into the next cell, or choose another light, here and there.
TEST_F(LightGridKernel, MatchesShaders) {
  for (const VkExtent2D extent : {VkExtent2D{177, 95}, {3, 5}}) expect_equal(extent, false);
}

// Lights behind the curtain count, too.
TEST_F(LightGridKernel, MatchesShadersBehindACurtain) {
  expect_equal({177, 95}, true);
}

/// Mean of the light that cells send on, by the shaders and by the host kernels.
std::array<double, 2> gathered(bool by_grid) {
  KernelComparison comparison({96, 64}, true, by_grid);
  comparison.run(0, 24);
  std::array<double, 2> sums{};
  for (std::uint32_t frame = 24; frame < 72; ++frame) {
    comparison.run(frame, frame + 1);
    for (std::size_t i = 0; i < 2; ++i) sums[i] += comparison.mean(i, &Signals::indirect) / 48.0;
  }
  return sums;
}

// Which place of a cell is updated depends on the order of the shaders' threads: the sums of runs
// with the same numbers have a standard deviation of 0.4 %, their ratios one of 0.55 %. Those of
// the kernels are always the same.
TEST_F(LightGridKernel, CellsOfTheRadianceCacheGatherTheLightOfAllLights) {
  const auto exact = gathered(false), by_grid = gathered(true);
  EXPECT_GT(exact[0], 0.004);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(by_grid[i] / exact[i], 1.0, 0.02)
        << (i ? "kernels" : "shaders") << ' ' << exact[0] << ' ' << exact[1] << ' ' << by_grid[i];
  }
}

}  // namespace
}  // namespace heliograph::test
