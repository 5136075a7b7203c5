#include <gtest/gtest.h>

#include "render/kernels/compose.hpp"
#include "render/passes/compose/compose.hpp"
#include "tests/gpu/support/kernel_comparison.hpp"

namespace heliograph::test {
namespace {

struct View {
  VkExtent2D extent{77, 45};
  bool denoised = true;
  bool reflections = true;
  bool orthographic = false;
  protocol::Settings settings = without_indirect();
};

std::shared_ptr<const scene::Scene> lit_scene() {
  SceneBuilder scene;
  scene.add_sun({0.3f, -0.5f, -1.0f}, {3, 2, 1});
  scene.add_point_light({0.5f, 1, 1}, {4, 5, 6}).add_point_light({-3, 0, -1}, {1, 0, 2});
  auto made = std::make_shared<scene::Scene>(*scene.build());
  made->lights.back().device.range = 3.0f;
  scene::Light spot = made->lights[1];
  spot.device.type = shared::light_spot;
  spot.device.position = {0, 0, 2};
  spot.device.direction = {0, 0, -1};
  spot.device.spot_scale = 4.0f;
  spot.device.spot_offset = -3.0f;
  made->lights.push_back(spot);
  return made;
}

scene::Camera camera(bool orthographic) {
  scene::Camera made = look({0, 0.2f, 3}, {0, 0, 0});
  if (orthographic) made.orthographic_height = 4.0f;
  return made;
}

/// Composition by the shader and by its host kernel.
class KernelComparison {
 public:
  explicit KernelComparison(const View& view)
      : rig_(lit_scene(), camera(view.orthographic),
             {.extent = view.extent,
              .environment = make_environment(
                  32, [](const glm::vec3& d) { return glm::vec3(1.0f + d.y, 0.5f, 1.0f - d.x); }),
              .settings = view.settings}) {
    RandomFrame random(rig_);
    const render::GBuffer gbuffer = random.gbuffer();
    render::NoisySignals raw{random.bits("shadow"), random.bits("ambient"), {}};
    if (view.reflections) raw.specular = random.four("specular", glm::vec4(0), glm::vec4(3));
    std::optional<render::DenoisedSignals> denoised;
    if (view.denoised) {
      denoised = {random.four("visibility", glm::vec4(0), glm::vec4(1)), raw.specular};
    }
    const auto background = random.four("background", glm::vec4(0), glm::vec4(2));
    const auto run = [&](bool host) {
      return render::compose(rig_.plan(), with_host_kernels(rig_, host), gbuffer, raw, denoised,
                             background);
    };
    shader_ = run(false);
    host_ = run(true);
  }

  FrameRig& rig() { return rig_; }
  ErrorStatistics hdr() { return compare(rig_.read(shader_.hdr), rig_.read(host_.hdr)); }
  ErrorStatistics hdr_noisy() { return compare(rig_.read(shader_.noisy), rig_.read(host_.noisy)); }

 private:
  FrameRig rig_;
  render::Composed shader_, host_;
};

class ComposeKernel : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_host_kernels()) GTEST_SKIP() << "host kernels run on CPU devices only";
  }
};

void expect_same(const View& view, const std::string& which) {
  KernelComparison comparison(view);
  comparison.rig().run();
  for (const ErrorStatistics& result : {comparison.hdr(), comparison.hdr_noisy()}) {
    EXPECT_LT(result.mean, 2e-5) << which;
    EXPECT_LT(result.max, 5e-3) << which;
    EXPECT_GT(result.magnitude, 0.1) << "image is nearly black: " << which;
  }
}

TEST_F(ComposeKernel, MatchesShader) {
  for (const bool denoised : {true, false}) {
    for (const bool reflections : {true, false}) {
      for (const bool orthographic : {true, false}) {
        View view{.denoised = denoised, .reflections = reflections, .orthographic = orthographic};
        expect_same(view, std::string(denoised ? "denoised " : "raw ") +
                              (reflections ? "reflections " : "") +
                              (orthographic ? "orthographic" : ""));
      }
    }
  }
}

TEST_F(ComposeKernel, MatchesShaderForEverySwitch) {
  for (int which = 0; which < 6; ++which) {
    View view;
    view.settings.lighting.direct = which != 0;
    view.settings.lighting.environment_diffuse = which != 1;
    view.settings.lighting.emissive = which != 2;
    view.settings.shadows.enabled = which != 3;
    view.settings.ambient.occlusion = which != 4;
    if (which == 5) {
      view.settings.specular.max_roughness = 0.3f;
      view.settings.lighting.environment_specular = false;
    }
    expect_same(view, "switch " + std::to_string(which));
  }
}

TEST_F(ComposeKernel, MatchesShaderWithPrefilteredEnvironment) {
  for (const bool reflections : {true, false}) {
    View view{.reflections = reflections};
    view.settings.specular.max_roughness = 0.3f;
    view.settings.environment.rotation = 50.0f;
    expect_same(view, reflections ? "rough surfaces" : "all surfaces");
    view.settings.lighting.environment_diffuse = false;
    expect_same(view, "specular alone");
  }
}

TEST_F(ComposeKernel, MatchesShaderAtAnySize) {
  for (const VkExtent2D extent : {VkExtent2D{1, 1}, {3, 5}, {16, 2}, {17, 31}, {130, 1}}) {
    for (const bool reflections : {true, false}) {
      expect_same({.extent = extent, .reflections = reflections},
                  std::to_string(extent.width) + " wide");
    }
  }
}

TEST_F(ComposeKernel, IsFasterThanShader) {
  KernelComparison comparison({.extent = {640, 360}});
  expect_faster(comparison.rig(), {"compose"}, 2.0);
}

}  // namespace
}  // namespace heliograph::test
