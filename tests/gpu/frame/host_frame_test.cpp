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

  static std::unique_ptr<FrameRig> frame(const protocol::Settings& settings) {
    SceneBuilder scene;
    scene.add_sun({0.3f, -0.5f, -1.0f}, {3, 2, 1});
    auto rig = std::make_unique<FrameRig>(
        scene.build(), look({0, 0.2f, 3}, {0, 0, 0}),
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

TEST_F(HostFrame, SubmitsNothingWithAutomaticExposure) {
  protocol::Settings settings;
  settings.exposure.mode = protocol::ExposureMode::automatic;
  EXPECT_EQ(frame(settings)->plan().submits(), 0u);
}

TEST_F(HostFrame, DenoisesOnlyWhatIsTraced) {
  protocol::Settings settings;
  settings.specular.enabled = false;
  EXPECT_TRUE(passes_that_ran(*frame(settings)).contains("visibility.temporal"));
  settings.shadows.enabled = settings.ambient.occlusion = false;
  const auto nothing_traced = passes_that_ran(*frame(settings));
  for (const char* pass : {"reproject", "visibility.combine", "visibility.temporal",
                           "visibility.variance", "visibility.atrous.0.first"}) {
    EXPECT_FALSE(nothing_traced.contains(pass)) << pass;
  }
  settings.ambient.occlusion = true;
  EXPECT_TRUE(passes_that_ran(*frame(settings)).contains("visibility.temporal"));
}

}  // namespace
}  // namespace heliograph::test
