#include <gtest/gtest.h>

#include "tests/image/support/renderer_rig.hpp"

namespace heliograph::test {
namespace {

constexpr std::uint32_t exposure_width = 64, exposure_height = 40;

/// A ground under uniform light of adjustable intensity, with automatic exposure.
class ExposureRig : public RendererRig {
 public:
  ExposureRig()
      : RendererRig(ground(), scene::constant_environment(glm::vec3(0.3f)),
                    look({0, 1, 3}, {0, 0, 0}), exposure_width, exposure_height) {
    settings.exposure.mode = protocol::ExposureMode::automatic;
    settings.exposure.adaptation = 0.5f;
    settings.accumulation.max_samples = 4;
    apply(settings);
    renderer.set_frame_seconds(0.1f);
  }
  /// Renders until the frame is converged and returns the number of frames.
  int render_until_converged() {
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
  ExposureRig rig;
  rig.render_until_converged();
  const double before = rig.brightness();
  rig.settings.environment.intensity = 30.0f;
  rig.apply(rig.settings);
  rig.last = rig.renderer.render();
  const double overexposed = rig.brightness();
  EXPECT_GT(overexposed, before + 60.0) << "adaptation must not be immediate";
  const int frames = rig.render_until_converged();
  EXPECT_NEAR(rig.brightness(), before, 3.0) << "code values";
  // log2(30) stops decay to 0.01 with a time constant of 0.5 s at 10 frames per second.
  EXPECT_NEAR(frames, 31, 4) << "convergence must wait for exposure";
  EXPECT_TRUE(rig.last.converged);
}

TEST(AutomaticExposure, ConvergesWithoutElapsedTime) {
  ExposureRig rig;
  rig.render_until_converged();
  rig.settings.environment.intensity = 30.0f;
  rig.apply(rig.settings);
  rig.renderer.set_frame_seconds(0.0f);
  EXPECT_LE(rig.render_until_converged(), 5);
}

}  // namespace
}  // namespace heliograph::test
