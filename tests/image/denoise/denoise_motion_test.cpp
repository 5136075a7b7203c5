// What is left of an old picture where things and lights went on.
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

/// A red box over a ground that mirrors a little, under a sun of `sun_width` degrees. The clip
/// "slide" takes the box to the right, "swing" turns the sun by half a right angle.
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
  scene::Transform place;
  place.rotation = facing;
  scene->nodes.push_back({.name = "sun",
                          .parent = {},
                          .local = place.matrix(),
                          .world = place.matrix(),
                          .transform = place});
  const auto rotation =
      channel(*scene->lights[0].node, scene::Property::rotation,
              {facing.x, facing.y, facing.z, facing.w, swung.x, swung.y, swung.z, swung.w});
  scene->clips = {slide, {"swing", clip_seconds, {rotation}}};
  return scene;
}

/// Which part of `before` shows in `shown` that should be `truth`: 0 none, 1 all of it. By least
/// squares over the pixels that changed and that `counts` lets through.
template <class Counts>
double ghost(const render::Frame& before, const render::Frame& truth, const render::Frame& shown,
             Counts counts) {
  double along = 0.0, all = 0.0;
  for (std::size_t i = 0; i < truth.rgba.size(); ++i) {
    if (i % 4 == 3 || !counts(i / 4)) continue;
    const double change = double(before.rgba[i]) - double(truth.rgba[i]);
    if (std::abs(change) < 8.0) continue;
    along += change * (double(shown.rgba[i]) - double(truth.rgba[i]));
    all += change * change;
  }
  EXPECT_GT(all, 0.0) << "nothing changed";
  return along / all;
}

constexpr auto everywhere = [](std::size_t) { return true; };

/// Where the picture was darker before: a shadow has left.
auto lit_again(const render::Frame& before, const render::Frame& truth) {
  return [&](std::size_t pixel) { return before.rgba[4 * pixel + 1] < truth.rgba[4 * pixel + 1]; };
}

/// The truth of a moment, and the instance that every pixel of it shows.
struct Moment {
  render::Frame picture;
  render::FloatImage instances;
};

Moment moment(const std::shared_ptr<const scene::Scene>& scene, const char* clip, double seconds) {
  Things still(scene, raw_alone());
  EXPECT_TRUE(still.renderer.set_pose(clip, seconds));
  Moment shown{still.accumulate(128), {}};
  shown.instances = still.capture("gbuffer.instance");
  return shown;
}

/// Rests for a while, then plays `clip` up to `seconds` in steps of a thirtieth.
render::Frame played(const std::shared_ptr<const scene::Scene>& scene,
                     const protocol::Settings& settings, const char* clip, int frames) {
  Things still(scene, settings);
  still.renderer.set_frame_seconds(1.0f / 30.0f);
  render::Frame shown;
  for (int i = -10; i <= frames; ++i) {
    EXPECT_TRUE(still.renderer.set_pose(clip, std::max(i, 0) / 30.0));
    shown = still.renderer.render();
  }
  return shown;
}

TEST(MovingObject, LeavesNoGhost) {
  const auto scene = box_under_a_sun(4.0f);
  const int frames = 16;
  const render::Frame shown = played(scene, denoised_alone(), "slide", frames);
  const Moment start = moment(scene, "slide", 0.0);
  const Moment before = moment(scene, "slide", (frames - 4) / 30.0);
  const Moment now = moment(scene, "slide", frames / 30.0);
  save_picture("sliding_box", shown);
  save_picture("sliding_box_truth", now.picture);
  const auto is_box = [](const Moment& m, std::size_t pixel) {
    return m.instances.rgba[4 * pixel] > 1.5f;  // after the ground
  };
  const auto uncovered = [&](std::size_t pixel) {
    return (is_box(start, pixel) || is_box(before, pixel)) && !is_box(now, pixel);
  };
  const auto lit_beside = [&](std::size_t pixel) {
    return !is_box(start, pixel) && !is_box(before, pixel) && !is_box(now, pixel) &&
           before.picture.rgba[4 * pixel + 1] < now.picture.rgba[4 * pixel + 1];
  };
  const double trail_start = ghost(start.picture, now.picture, shown, uncovered);
  const double trail = ghost(before.picture, now.picture, shown, uncovered);
  EXPECT_NEAR(trail_start, 0.0, 0.03);
  EXPECT_NEAR(trail, 0.0, 0.04);
  EXPECT_LT(ghost(before.picture, now.picture, shown, lit_beside), 0.25)
      << "of the shadow four frames ago";
  EXPECT_LT(difference(now.picture, shown).mean, 1.1);

  protocol::Settings held = denoised_alone();
  held.shadow_temporal.rectification = protocol::Rectification::fast_history;
  const render::Frame dragging = played(scene, held, "slide", frames);
  EXPECT_LT(difference(now.picture, shown).mean, 0.7 * difference(now.picture, dragging).mean);
}

class MovingSun : public testing::TestWithParam<float> {};
INSTANTIATE_TEST_SUITE_P(Widths, MovingSun, testing::Values(0.0f, 2.0f, 10.0f),
                         [](const auto& width) {
                           return "of_" + std::to_string(int(width.param)) + "_degrees";
                         });

TEST_P(MovingSun, ShadowLeavesNoGhost) {
  const auto scene = box_under_a_sun(GetParam());
  const int frames = 16;
  const render::Frame before = moment(scene, "swing", (frames - 8) / 30.0).picture;
  const render::Frame now = moment(scene, "swing", frames / 30.0).picture;
  protocol::Settings settings = denoised_alone();
  const render::Frame shown = played(scene, settings, "swing", frames);
  settings.shadow_temporal.follow_lights = settings.specular_temporal.follow_lights = false;
  const render::Frame dragging = played(scene, settings, "swing", frames);
  const std::string name = "swinging_sun_" + std::to_string(int(GetParam()));
  save_picture(name, shown);
  save_picture(name + "_dragging", dragging);
  save_picture(name + "_truth", now);
  const double left = ghost(before, now, shown, lit_again(before, now));
  const double unfollowed = ghost(before, now, dragging, lit_again(before, now));
  EXPECT_LT(left, 0.1) << "of the shadow eight frames ago";
  EXPECT_LT(left, unfollowed - 0.2);
}

struct Sky {
  double ghost;
  double error;
};

/// After the sky has turned for some frames, against the truth.
Sky turned_sky(const protocol::Settings& wanted, const std::string& name) {
  protocol::Settings settings = wanted;
  Things still(settings);
  render::Frame shown;
  const auto turned = [](int frame) { return static_cast<float>(std::max(frame - 12, 0)) * 8.0f; };
  for (int i = 0; i < 24; ++i) {
    settings.environment.rotation = turned(i);
    still.apply(settings);
    shown = still.renderer.render();
  }
  save_picture(name, shown);
  const render::Frame truth = truth_from(eye(), turned(23));
  return {ghost(truth_from(eye(), turned(19)), truth, shown, everywhere),
          difference(truth, shown).mean};
}

TEST(RotatingEnvironment, ReflectionsLeaveLittleGhost) {
  protocol::Settings settings = denoised_alone();
  const Sky followed = turned_sky(settings, "turning_followed");
  settings.shadow_temporal.follow_lights = settings.specular_temporal.follow_lights = false;
  const Sky rectified = turned_sky(settings, "turning_fast_history");
  settings.shadow_temporal.rectification = settings.specular_temporal.rectification =
      protocol::Rectification::off;
  const Sky off = turned_sky(settings, "turning_off");
  EXPECT_LT(followed.ghost, 0.05);
  EXPECT_LT(rectified.error, 0.95 * off.error);
  EXPECT_LT(followed.error, 0.6 * rectified.error);
}

}  // namespace
}  // namespace heliograph::test
