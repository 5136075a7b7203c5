#include "render/resources/moving/scene_motion.hpp"

#include <gtest/gtest.h>

#include <glm/gtc/quaternion.hpp>

#include "tests/support/frame_rig.hpp"

namespace heliograph::test {
namespace {

TEST(SceneMotion, LightMotionIsRelativeToAngularSizeAndIntensity) {
  SceneBuilder builder;
  builder.add_quad({{{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}}}, surface(glm::vec3(1.0f)));
  builder.place(0).add_sun({0, -1, 0}, glm::vec3(3.0f), 4.0f).add_sun({0, -1, 0}, glm::vec3(1.0f));
  auto scene = std::make_shared<scene::Scene>(*builder.build());
  scene->lights[0].node = 1;
  scene->nodes.push_back({.name = "sun", .transform = scene::Transform{}});
  const glm::quat down = glm::angleAxis(glm::radians(-90.0f), glm::vec3(1, 0, 0));
  const glm::quat end = glm::angleAxis(glm::radians(-100.0f), glm::vec3(1, 0, 0));
  scene::Channel turn{{.width = 4, .times = {0, 10}}, 1, scene::Property::rotation};
  for (const glm::quat& q : {down, end})
    turn.values.insert(turn.values.end(), {q.x, q.y, q.z, q.w});
  scene->clips.push_back({"turn", 10.0f, {turn}});
  FrameRig rig(scene, look({0, 1, 3}, glm::vec3(0.0f)));
  const auto motion_at = [&](double seconds) {
    rig.moving().set_pose(&rig.scene().scene->clips[0], seconds);
    rig.moving().advance();
    return render::scene_motion(rig.moving(), rig.constants(), &rig.constants()).lights;
  };
  motion_at(0.0);
  EXPECT_NEAR(motion_at(1.0), 0.75f * 0.25f, 2e-3f) << "one of four degrees, three lights of four";
  EXPECT_EQ(motion_at(1.0), 0.0f) << "static again";
  EXPECT_NEAR(motion_at(9.0), 0.75f, 1e-5f) << "clamped to 1";
  EXPECT_EQ(render::scene_motion(rig.moving(), rig.constants(), nullptr).lights, 0.0f);
}

TEST(FramesUnderMotion, DecreaseFromInfinityToOne) {
  EXPECT_GT(render::frames_under_motion(0.0f), 1e6f);
  EXPECT_NEAR(render::frames_under_motion(0.1f), 3.29f, 0.01f);
  EXPECT_EQ(render::frames_under_motion(1.0f), 1.0f);
  EXPECT_EQ(render::frames_under_motion(5.0f), 1.0f);
}

}  // namespace
}  // namespace heliograph::test
