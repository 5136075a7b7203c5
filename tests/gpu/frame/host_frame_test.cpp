#include <gtest/gtest.h>

#include <set>

#include "render/frame/frame.hpp"
#include "tests/gpu/support/kernel_comparison.hpp"

namespace heliograph::test {
namespace {

/// Whole frames on devices that are processors, with the tracer that runs on the host.
class HostFrame : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_host_kernels()) GTEST_SKIP() << "host kernels run on CPU devices only";
  }

  static std::shared_ptr<const scene::Scene> sunny_scene() {
    SceneBuilder scene;
    scene.add_sun({0.3f, -0.5f, -1.0f}, {3, 2, 1});
    return scene.build();
  }

  static std::unique_ptr<FrameRig> frame(
      const protocol::Settings& settings,
      std::shared_ptr<const scene::Scene> scene = sunny_scene()) {
    auto rig = std::make_unique<FrameRig>(
        std::move(scene), look({0, 0.2f, 3}, {0, 0, 0}),
        RigOptions{.extent = {48, 32}, .settings = settings, .tracer = "embree"});
    const auto outputs = render::declare_frame(rig->plan(), rig->inputs());
    rig->plan().read_back(outputs.output);
    rig->run();
    return rig;
  }

  static std::set<std::string> passes_that_ran(FrameRig& rig) {
    std::set<std::string> names;
    for (const auto& timing : rig.plan().timings()) {
      if (timing.milliseconds >= 0.0f) names.insert(timing.name);
    }
    return names;
  }
};

TEST_F(HostFrame, SubmitsNothingWithDefaultSettings) {
  const auto rig = frame({});
  EXPECT_EQ(rig->plan().submits(), 0u);
  for (const auto& timing : rig->plan().timings()) EXPECT_TRUE(timing.host) << timing.name;
  EXPECT_EQ(rig->plan().read().size(), 4u * 48 * 32);
}

TEST_F(HostFrame, SubmitsNothingWithIndirectLight) {
  protocol::Settings settings;
  settings.indirect.enabled = true;
  const auto rig = frame(settings);
  EXPECT_EQ(rig->plan().submits(), 0u);
  EXPECT_TRUE(passes_that_ran(*rig).contains("indirect.atrous.0"));
}

TEST_F(HostFrame, SubmitsNothingWithAutomaticExposure) {
  protocol::Settings settings;
  settings.exposure.mode = protocol::ExposureMode::automatic;
  EXPECT_EQ(frame(settings)->plan().submits(), 0u);
}

TEST_F(HostFrame, SubmitsNothingForLayersBlendsAndAreaLights) {
  SceneBuilder builder;
  shared::Material coated = builder.with_layers(
      surface({0.8f, 0.4f, 0.2f}, 0.5f), {.clearcoat = 0.8f, .sheen_color = glm::vec3(0.5f)});
  coated.base_color.w = 0.6f;
  coated.flags |= shared::material_alpha_blend;
  builder.place(builder.add_sphere(0.5f, coated));
  auto scene = std::make_shared<scene::Scene>(*builder.build());
  shared::Light light{};
  light.type = shared::light_disk;
  light.position = {0, 2, 0};
  light.direction = {0, -1, 0};
  light.tangent = {1, 0, 0};
  light.color = {5, 5, 5};
  light.radius = 0.5f;
  scene->lights.push_back({"disk", light, 0.0f});
  const auto rig = frame({}, scene);
  EXPECT_EQ(rig->plan().submits(), 0u);
  for (const auto& timing : rig->plan().timings()) EXPECT_TRUE(timing.host) << timing.name;
}

TEST_F(HostFrame, DenoisesOnlyWhatIsTraced) {
  protocol::Settings settings = without_indirect();
  settings.specular.enabled = false;
  EXPECT_TRUE(passes_that_ran(*frame(settings)).contains("visibility.temporal"));
  settings.shadows.enabled = settings.ambient.occlusion = false;
  const auto nothing_traced = passes_that_ran(*frame(settings));
  for (const char* pass : {"reproject", "visibility.combine", "visibility.temporal",
                           "visibility.variance", "visibility.atrous.0"}) {
    EXPECT_FALSE(nothing_traced.contains(pass)) << pass;
  }
  settings.ambient.occlusion = true;
  EXPECT_TRUE(passes_that_ran(*frame(settings)).contains("visibility.temporal"));
}

}  // namespace
}  // namespace heliograph::test
