#include <gtest/gtest.h>

#include "tests/image/support/scene_renderer.hpp"

namespace heliograph::test {
namespace {

constexpr std::uint32_t width = 64, height = 40;

/// A room's worth of light, or a sunny day's.
class Lit : public Still {
 public:
  Lit()
      : Still(ground(), scene::constant_environment(glm::vec3(0.3f)), look({0, 1, 3}, {0, 0, 0}),
              width, height) {
    settings.exposure.mode = protocol::ExposureMode::automatic;
    settings.exposure.adaptation = 0.5f;
    settings.accumulation.max_samples = 4;
    apply(settings);
    renderer.set_frame_seconds(0.1f);
  }
  /// Frames until the picture is finished.
  int finish() {
    int frames = 0;
    while (renderer.needs_frame() && frames < 300) {
      last = renderer.render();
      ++frames;
    }
    return frames;
  }
  double brightness() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < last.rgba.size(); i += 4) sum += last.rgba[i + 1];
    return sum / static_cast<double>(last.rgba.size() / 4);
  }

  protocol::Settings settings;
  render::Frame last;

 private:
  static std::shared_ptr<const scene::Scene> ground() {
    SceneBuilder builder;
    builder.place(builder.add_quad({{{-9, 0, 9}, {9, 0, 9}, {9, 0, -9}, {-9, 0, -9}}},
                                   surface({0.5f, 0.5f, 0.5f})));
    return builder.build();
  }
};

TEST(AutomaticExposure, AdaptsToBrighterLight) {
  Lit lit;
  lit.finish();
  const double before = lit.brightness();
  lit.settings.environment.intensity = 30.0f;
  lit.apply(lit.settings);
  lit.last = lit.renderer.render();
  const double dazzled = lit.brightness();
  EXPECT_GT(dazzled, before + 60.0) << "the eye needs its time";
  const int frames = lit.finish();
  EXPECT_NEAR(lit.brightness(), before, 3.0) << "code values";
  // log2(30) stops, down to a hundredth, half a second each e-fold, ten frames a second.
  EXPECT_NEAR(frames, 31, 4) << "the picture is finished when its exposure is, not sooner";
  EXPECT_TRUE(lit.last.converged);
}

TEST(AutomaticExposure, ConvergesWithoutElapsedTime) {
  Lit lit;
  lit.finish();
  lit.settings.environment.intensity = 30.0f;
  lit.apply(lit.settings);
  lit.renderer.set_frame_seconds(0.0f);
  EXPECT_LE(lit.finish(), 5);
}

}  // namespace
}  // namespace heliograph::test
