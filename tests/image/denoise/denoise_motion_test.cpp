// Ghosting of previous frames where objects and lights move.
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/gtx/quaternion.hpp>

#include "tests/image/denoise/spheres.hpp"

namespace heliograph::test {
namespace {

constexpr float clip_seconds = 1.0f;

scene::Channel channel(std::uint32_t node, scene::Property property, std::vector<float> values) {
  scene::Channel channel;
  channel.node = node;
  channel.property = property;
  channel.width = property == scene::Property::rotation ? 4 : 3;
  channel.times = {0.0f, clip_seconds};
  channel.values = std::move(values);
  return channel;
}

/// A red box over a glossy ground, under a sun of `sun_width` degrees. The clip "slide" moves the
/// box to the right, "swing" rotates the sun by 45 degrees.
std::shared_ptr<const scene::Scene> box_under_a_sun(float sun_width) {
  SceneBuilder builder;
  builder.place(builder.add_quad({{{-9, 0, 9}, {9, 0, 9}, {9, 0, -9}, {-9, 0, -9}}},
                                 surface({0.6f, 0.55f, 0.5f}, 0.4f)));
  const auto side = builder.add_quad(
      {{{-0.5f, -0.5f, 0.5f}, {0.5f, -0.5f, 0.5f}, {0.5f, 0.5f, 0.5f}, {-0.5f, 0.5f, 0.5f}}},
      surface({0.8f, 0.2f, 0.1f}, 0.8f));
  const auto turned = [](float degrees, const glm::vec3& axis) {
    return glm::rotate(glm::mat4(1.0f), glm::radians(degrees), axis);
  };
  const glm::vec3 start(-0.9f, 0.55f, 0.4f), way(1.8f, 0.0f, 0.0f);
  std::vector<glm::mat4> faces;
  for (int i = 0; i < 4; ++i) faces.push_back(turned(90.0f * static_cast<float>(i), {0, 1, 0}));
  for (const float degrees : {90.0f, -90.0f}) faces.push_back(turned(degrees, {1, 0, 0}));
  for (const glm::mat4& face : faces) {
    builder.place(side, glm::translate(glm::mat4(1.0f), start) * face);
  }
  builder.add_sun({-0.6f, -1, -0.4f}, glm::vec3(2.5f), sun_width);

  auto scene = std::make_shared<scene::Scene>(*builder.build());
  scene::Clip slide{"slide", clip_seconds, {}};
  for (std::uint32_t node = 1; node < scene->nodes.size(); ++node) {
    scene->nodes[node].transform =
        scene::Transform{start, glm::quat_cast(glm::mat3(faces[node - 1])), glm::vec3(1.0f)};
    const glm::vec3 end = start + way;
    slide.channels.push_back(channel(node, scene::Property::translation,
                                     {start.x, start.y, start.z, end.x, end.y, end.z}));
  }
  scene->lights[0].node = static_cast<std::uint32_t>(scene->nodes.size());
  const glm::quat facing = glm::rotation({0, 0, -1}, scene->lights[0].device.direction);
  const glm::quat swung = glm::angleAxis(glm::radians(45.0f), glm::vec3(0, 1, 0)) * facing;
  scene::Transform position;
  position.rotation = facing;
  scene->nodes.push_back({.name = "sun",
                          .parent = {},
                          .local = position.matrix(),
                          .world = position.matrix(),
                          .transform = position});
  const auto rotation =
      channel(*scene->lights[0].node, scene::Property::rotation,
              {facing.x, facing.y, facing.z, facing.w, swung.x, swung.y, swung.z, swung.w});
  scene->clips = {slide, {"swing", clip_seconds, {rotation}}};
  return scene;
}

/// Fraction of `before` that remains in `shown`, 0 to 1, where `reference` is correct: least
/// squares over the pixels that changed and for which `selected` is true.
template <class Selected>
double ghost(const render::Frame& before, const render::Frame& reference,
             const render::Frame& shown, Selected selected) {
  double along = 0.0, all = 0.0;
  for (std::size_t i = 0; i < reference.rgba.size(); ++i) {
    if (i % 4 == 3 || !selected(i / 4)) continue;
    const double change = double(before.rgba[i]) - double(reference.rgba[i]);
    if (std::abs(change) < 8.0) continue;
    along += change * (double(shown.rgba[i]) - double(reference.rgba[i]));
    all += change * change;
  }
  EXPECT_GT(all, 0.0) << "nothing changed";
  return along / all;
}

constexpr auto everywhere = [](std::size_t) { return true; };

/// Pixels that were darker before: a shadow has moved away.
auto lit_again(const render::Frame& before, const render::Frame& reference) {
  return
      [&](std::size_t pixel) { return before.rgba[4 * pixel + 1] < reference.rgba[4 * pixel + 1]; };
}

/// Ground reference at one time of a clip, with the instance of every pixel.
struct Moment {
  render::Frame frame;
  render::FloatImage instances;
};

Moment moment(const std::shared_ptr<const scene::Scene>& scene, const char* clip, double seconds) {
  SpheresRig rig(scene, noisy_only());
  EXPECT_TRUE(rig.renderer.set_pose(clip, seconds));
  Moment shown{rig.accumulate(128), {}};
  shown.instances = rig.capture("gbuffer.instance");
  return shown;
}

/// Renders 10 static frames, then `frames` of `clip` at 30 frames per second.
render::Frame played(const std::shared_ptr<const scene::Scene>& scene,
                     const protocol::Settings& settings, const char* clip, int frames) {
  SpheresRig rig(scene, settings);
  rig.renderer.set_frame_seconds(1.0f / 30.0f);
  render::Frame shown;
  for (int i = -10; i <= frames; ++i) {
    EXPECT_TRUE(rig.renderer.set_pose(clip, std::max(i, 0) / 30.0));
    shown = rig.renderer.render();
  }
  return shown;
}

TEST(MovingObject, LeavesNoGhost) {
  const auto scene = box_under_a_sun(4.0f);
  const int frames = 16;
  const render::Frame shown = played(scene, denoised_only(), "slide", frames);
  const Moment start = moment(scene, "slide", 0.0);
  const Moment before = moment(scene, "slide", (frames - 4) / 30.0);
  const Moment now = moment(scene, "slide", frames / 30.0);
  save_image("sliding_box", shown);
  save_image("sliding_box_ground_truth", now.frame);
  const auto is_box = [](const Moment& m, std::size_t pixel) {
    return m.instances.rgba[4 * pixel] > 1.5f;  // instance 1 is the ground
  };
  const auto uncovered = [&](std::size_t pixel) {
    return (is_box(start, pixel) || is_box(before, pixel)) && !is_box(now, pixel);
  };
  const auto lit_beside = [&](std::size_t pixel) {
    return !is_box(start, pixel) && !is_box(before, pixel) && !is_box(now, pixel) &&
           before.frame.rgba[4 * pixel + 1] < now.frame.rgba[4 * pixel + 1];
  };
  const double ghost_of_start = ghost(start.frame, now.frame, shown, uncovered);
  const double ghost_of_before = ghost(before.frame, now.frame, shown, uncovered);
  EXPECT_NEAR(ghost_of_start, 0.0, 0.03);
  EXPECT_NEAR(ghost_of_before, 0.0, 0.04);
  EXPECT_LT(ghost(before.frame, now.frame, shown, lit_beside), 0.25)
      << "ghost of the shadow four frames ago";
  EXPECT_LT(difference(now.frame, shown).mean, 1.1);

  protocol::Settings held = denoised_only();
  held.shadow_temporal.rectification = protocol::Rectification::fast_history;
  const render::Frame lagging = played(scene, held, "slide", frames);
  EXPECT_LT(difference(now.frame, shown).mean, 0.7 * difference(now.frame, lagging).mean);
}

class MovingSun : public testing::TestWithParam<float> {};
INSTANTIATE_TEST_SUITE_P(Widths, MovingSun, testing::Values(0.0f, 2.0f, 10.0f),
                         [](const auto& width) {
                           return "of_" + std::to_string(int(width.param)) + "_degrees";
                         });

TEST_P(MovingSun, ShadowLeavesNoGhost) {
  const auto scene = box_under_a_sun(GetParam());
  const int frames = 16;
  const render::Frame before = moment(scene, "swing", (frames - 8) / 30.0).frame;
  const render::Frame now = moment(scene, "swing", frames / 30.0).frame;
  protocol::Settings settings = denoised_only();
  const render::Frame shown = played(scene, settings, "swing", frames);
  settings.shadow_temporal.follow_lights = settings.specular_temporal.follow_lights = false;
  const render::Frame lagging = played(scene, settings, "swing", frames);
  const std::string name = "swinging_sun_" + std::to_string(int(GetParam()));
  save_image(name, shown);
  save_image(name + "_lagging", lagging);
  save_image(name + "_ground_truth", now);
  const double left = ghost(before, now, shown, lit_again(before, now));
  const double unfollowed = ghost(before, now, lagging, lit_again(before, now));
  EXPECT_LT(left, 0.1) << "ghost of the shadow eight frames ago";
  EXPECT_LT(left, unfollowed - 0.2);
}

struct Sky {
  double ghost;
  double error;
};

/// Ghost and error after the sky has rotated for 12 frames.
Sky rotated_sky(const protocol::Settings& requested, const std::string& name) {
  protocol::Settings settings = requested;
  SpheresRig rig(settings);
  render::Frame shown;
  const auto turned = [](int frame) { return static_cast<float>(std::max(frame - 12, 0)) * 8.0f; };
  for (int i = 0; i < 24; ++i) {
    settings.environment.rotation = turned(i);
    rig.apply(settings);
    shown = rig.renderer.render();
  }
  save_image(name, shown);
  const render::Frame reference = ground_truth_from(spheres_camera(), turned(23));
  return {ghost(ground_truth_from(spheres_camera(), turned(19)), reference, shown, everywhere),
          difference(reference, shown).mean};
}

TEST(RotatingEnvironment, ReflectionsLeaveLittleGhost) {
  protocol::Settings settings = denoised_only();
  const Sky compensated = rotated_sky(settings, "rotating_compensated");
  settings.specular_temporal.rectification = protocol::Rectification::fast_history;
  const Sky by_fast_history = rotated_sky(settings, "rotating_fast_history");
  settings.specular_temporal.rectification = protocol::Settings{}.specular_temporal.rectification;
  settings.shadow_temporal.follow_lights = settings.specular_temporal.follow_lights = false;
  const Sky rectified = rotated_sky(settings, "rotating_rectified");
  settings.shadow_temporal.rectification = settings.specular_temporal.rectification =
      protocol::Rectification::off;
  const Sky off = rotated_sky(settings, "rotating_off");
  EXPECT_LT(compensated.ghost, 0.05);
  EXPECT_LT(rectified.error, 0.5 * off.error);
  EXPECT_LT(compensated.error, 0.8 * rectified.error);
  EXPECT_LT(compensated.error, by_fast_history.error);
}

}  // namespace
}  // namespace heliograph::test
