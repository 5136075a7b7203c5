// Frames that begin while the device works on the one before, as a viewer who moves the camera gets
// them from a GPU.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <string>

#include "tests/support/frame_rig.hpp"
#include "tests/support/similarity.hpp"

namespace heliograph::test {
namespace {

constexpr int moves = 12;

/// An engine that treats its device as a GPU.
class OverlappingFrames : public testing::Test {
 protected:
  OverlappingFrames()
      : engine_(render::EngineOptions{
            .device = device().report().name, .validation = true, .as_gpu = true}) {
    SceneBuilder scene;
    scene.place(scene.add_sphere(0.8f, surface({0.9f, 0.3f, 0.2f}, 0.3f)),
                glm::translate(glm::mat4(1.0f), glm::vec3(0, 0.8f, 0)));
    scene.add_sun({0.3f, -1.0f, -0.5f}, {3, 2, 1}, 2.0f);
    scene_ =
        engine_.upload(scene.build(), heliograph::scene::constant_environment(glm::vec3(0.5f)));
  }
  void TearDown() override { EXPECT_EQ(engine_.validation_messages(), 0u); }

  /// The last frame of a camera that moves. `together`: each begins before the one before is
  /// finished, where that can be.
  render::Frame move(const protocol::Settings& settings, bool together) {
    render::Renderer renderer(engine_);
    EXPECT_TRUE(renderer.set_settings(settings));
    renderer.keep_buffers(false);
    renderer.set_size(160, 90);
    renderer.set_scene(scene_);
    render::Frame frame;
    int overlapped = 0;
    for (int i = 0; i < moves; ++i) {
      const bool follows = together && renderer.can_begin_another();
      if (renderer.in_flight() && !follows) frame = renderer.finish();
      renderer.set_camera(look({0.1f * static_cast<float>(i), 2, 3}, {0, 0.5f, 0}));
      EXPECT_TRUE(renderer.begin({}));
      if (follows) frame = renderer.finish();
      overlapped += follows;
    }
    frame = renderer.finish();
    EXPECT_EQ(overlapped >= moves / 2, together) << overlapped;
    return frame;
  }

  render::Engine engine_;
  std::shared_ptr<const render::SceneResources> scene_;
};

// Light that bounces depends on the order in which the device's threads come to its cache.
TEST_F(OverlappingFrames, AreThoseDrawnOneAfterTheOther) {
  using Source = protocol::PrimaryVisibility;
  for (const auto ground : {protocol::GroundUse::off, protocol::GroundUse::on}) {
    for (const Source source : {Source::automatic, Source::raster, Source::rays}) {
      protocol::Settings settings = without_indirect();
      settings.background.ground = ground;
      settings.gbuffer.source = source;
      const std::string name = "overlapping_" + std::string(protocol::enum_name(source)) +
                               (ground == protocol::GroundUse::on ? "_ground" : "");
      SCOPED_TRACE(name);
      const render::Frame alone = move(settings, false), together = move(settings, true);
      EXPECT_LT(difference(alone, together).mean, 0.01);
      save_image(name, together);
    }
  }
}

}  // namespace
}  // namespace heliograph::test
