#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "tests/image/support/renderer_rig.hpp"

namespace heliograph::test {
namespace {

using Corners = std::array<glm::vec3, 4>;

/// The six walls of a box from -1 to 1 on every axis, seen from inside.
std::array<Corners, 6> box_walls() {
  return {{{{{-1, -1, 1}, {1, -1, 1}, {1, -1, -1}, {-1, -1, -1}}},
           {{{-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}}},
           {{{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}}},
           {{{1, -1, 1}, {-1, -1, 1}, {-1, 1, 1}, {1, 1, 1}}},
           {{{-1, -1, 1}, {-1, -1, -1}, {-1, 1, -1}, {-1, 1, 1}}},
           {{{1, -1, -1}, {1, -1, 1}, {1, 1, 1}, {1, 1, -1}}}}};
}

/// Mean radiance of a rectangle of the accumulated image, pixels from `from` to before `to`.
glm::dvec3 mean_of(const render::FloatImage& image, glm::uvec2 from, glm::uvec2 to) {
  glm::dvec3 sum(0.0);
  for (std::uint32_t y = from.y; y < to.y; ++y) {
    for (std::uint32_t x = from.x; x < to.x; ++x) sum += glm::dvec3(rgb(image, x, y));
  }
  return sum / (double(to.x - from.x) * double(to.y - from.y));
}

protocol::Settings gathered() {
  protocol::Settings settings;
  settings.indirect.enabled = true;
  settings.accumulation.max_samples = 4096;
  settings.antialiasing.temporal = false;
  return settings;
}

protocol::Settings full_reference() {
  protocol::Settings settings = undenoised();
  settings.reference.use = protocol::ReferenceUse::always;
  settings.reference.scope = protocol::ReferenceScope::full;
  settings.reference.bounces = 16;
  return settings;
}

// Every wall of a closed room shines with radiance e and reflects the fraction a of all light: the
// room is as bright everywhere as e / (1 - a).
TEST(Indirect, ClosedFurnaceHasTheLightOfAllBounces) {
  constexpr float albedo = 0.6f, emission = 0.25f;
  SceneBuilder builder;
  shared::Material wall = surface(glm::vec3(albedo), 1.0f);
  wall.emissive = glm::vec3(emission);
  builder.place(builder.add_quads(box_walls(), wall));
  RendererRig rig(builder.build(), scene::constant_environment(glm::vec3(0.0f)),
                  look({0, 0, 0.9f}, {0, 0, -1}, 60.0f), 64, 48);
  rig.apply(full_reference());
  rig.accumulate(64);
  const double expected = mean_of(rig.capture("accumulated"), {0, 0}, {64, 48}).x;
  // The material's specular lobe reflects, too: a is a little more than the base colour.
  EXPECT_NEAR(expected, emission / (1.0f - albedo), 0.1);
  rig.apply(gathered());
  rig.accumulate(128);
  // Whose mean has samples of the time when the cache knew few bounces.
  rig.renderer.set_camera(look({0, 0, 0.89f}, {0, 0, -1}, 60.0f));
  save_image("indirect_furnace", rig.accumulate(128));
  const render::FloatImage radiance = rig.capture("accumulated");
  for (std::uint32_t x = 0; x < 64; x += 16) {
    EXPECT_NEAR(mean_of(radiance, {x, 0}, {x + 16, 48}).x / expected, 1.0, 0.02) << x;
  }
}

/// A room with a red and a green wall and a light whose shade keeps it from the ceiling.
std::shared_ptr<const scene::Scene> cornell_box() {
  SceneBuilder builder;
  const auto walls = box_walls();
  const shared::Material white = surface(glm::vec3(0.73f));
  const std::array<Corners, 3> plain{walls[0], walls[1], walls[2]};
  builder.place(builder.add_quads(plain, white));
  builder.place(builder.add_quad(walls[4], surface({0.65f, 0.05f, 0.05f})));
  builder.place(builder.add_quad(walls[5], surface({0.12f, 0.45f, 0.15f})));
  builder.place(builder.add_sphere(0.4f, white),
                glm::translate(glm::mat4(1.0f), {0.3f, -0.6f, -0.2f}));
  builder.place(builder.add_quad(
      {{{-0.6f, 0.6f, -0.6f}, {0.6f, 0.6f, -0.6f}, {0.6f, 0.6f, 0.6f}, {-0.6f, 0.6f, 0.6f}}},
      white));
  builder.add_point_light({0, 0.25f, 0}, glm::vec3(0.8f));
  return builder.build();
}

TEST(Indirect, CornellBoxHasTheColoursOfTheReference) {
  RendererRig rig(cornell_box(), scene::constant_environment(glm::vec3(0.0f)),
                  look({0, 0, 3.6f}, {0, 0, 0}, 38.0f), 60, 60);
  rig.apply(full_reference());
  save_image("indirect_cornell_reference", rig.accumulate(256));
  const render::FloatImage expected = rig.capture("accumulated");
  protocol::Settings settings = gathered();
  rig.apply(settings);
  save_image("indirect_cornell", rig.accumulate(160));
  const render::FloatImage got = rig.capture("accumulated");
  struct Region {
    const char* name;
    glm::uvec2 from, to;
  };
  for (const Region& region :
       {Region{"red", {3, 18}, {9, 42}}, Region{"green", {51, 18}, {57, 42}},
        Region{"floor", {20, 52}, {40, 57}}, Region{"ceiling", {20, 3}, {40, 8}},
        Region{"back", {20, 16}, {34, 30}}}) {
    const glm::dvec3 wall = mean_of(got, region.from, region.to);
    const glm::dvec3 truth = mean_of(expected, region.from, region.to);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(wall[c], truth[c], 0.05 * truth[c] + 0.003) << region.name << " " << c;
    }
  }
  // No light falls on the ceiling by itself.
  settings.indirect.enabled = false;
  rig.apply(settings);
  rig.accumulate(8);
  EXPECT_LT(mean_of(rig.capture("accumulated"), {20, 3}, {40, 8}).x,
            0.2 * mean_of(expected, {20, 3}, {40, 8}).x);
}

/// A wall that no light falls on, beside a floor under a light from above.
std::shared_ptr<const scene::Scene> wall_beside_floor(const shared::Material& floor) {
  SceneBuilder builder;
  builder.place(builder.add_quad({{{-6, 0, 8}, {6, 0, 8}, {6, 0, 0}, {-6, 0, 0}}}, floor));
  builder.place(
      builder.add_quad({{{-6, 0, 0}, {6, 0, 0}, {6, 3, 0}, {-6, 3, 0}}}, surface(glm::vec3(0.7f))));
  builder.add_sun(glm::normalize(glm::vec3(0.2f, -1.0f, -0.02f)), glm::vec3(3.0f));
  return builder.build();
}

// Rays from the wall graze the floor, where its specular lobe would show much of light that came
// from everywhere; of a light above it is a few hundredths.
TEST(Indirect, SpecularFloorsSendOnWhatTheyGet) {
  RendererRig rig(wall_beside_floor(surface(glm::vec3(0.4f), 0.4f)),
                  scene::constant_environment(glm::vec3(0.0f)), look({0, 1, 5}, {0, 1, 0}, 24.0f),
                  48, 48);
  rig.apply(full_reference());
  rig.accumulate(128);
  const double expected = mean_of(rig.capture("accumulated"), {8, 8}, {40, 40}).x;
  rig.apply(gathered());
  rig.accumulate(128);
  const double got = mean_of(rig.capture("accumulated"), {8, 8}, {40, 40}).x;
  EXPECT_GT(got, 0.97 * expected);
  EXPECT_LT(got, 1.12 * expected);
}

/// Frames of a moving view, one after the other.
void play(RendererRig& rig, int frames) {
  for (int i = 0; i < frames; ++i) {
    rig.renderer.set_camera(look({0.002f * float(i % 2), 0, 3.6f}, {0, 0, 0}, 38.0f));
    rig.renderer.render();
  }
}

double ceiling(RendererRig& rig) {
  return mean_of(rig.capture("hdr"), {16, 2}, {44, 8}).x;
}

// 15 frames are half a second. Light that has gone around comes back more slowly than it goes.
TEST(Indirect, FollowsALightThatIsSwitched) {
  const auto scene = cornell_box();
  RendererRig rig(scene, scene::constant_environment(glm::vec3(0.0f)),
                  look({0, 0, 3.6f}, {0, 0, 0}, 38.0f), 60, 60);
  rig.renderer.set_frame_seconds(1.0f / 30.0f);
  rig.apply(gathered());
  play(rig, 256);
  const double before = ceiling(rig);
  std::vector<shared::Light> lights{scene->lights[0].device};
  lights[0].color = glm::vec3(0.0f);
  rig.renderer.set_lights(lights);
  play(rig, 15);
  EXPECT_LT(ceiling(rig), 0.1 * before);
  play(rig, 30);
  EXPECT_LT(ceiling(rig), 0.01 * before);
  lights[0].color = scene->lights[0].device.color;
  rig.renderer.set_lights(lights);
  play(rig, 15);
  EXPECT_GT(ceiling(rig), 0.9 * before);
  play(rig, 30);
  EXPECT_GT(ceiling(rig), 0.9 * before);
  play(rig, 64);
  EXPECT_NEAR(ceiling(rig) / before, 1.0, 0.08);
}

/// Two rooms, the left one with a light, and a wall of 2 cm between them that leaves no gap and
/// lies away from the borders of cells. The clip "open" raises it within 0.2 s.
std::shared_ptr<const scene::Scene> two_rooms(float albedo) {
  SceneBuilder builder;
  std::array<Corners, 6> walls = box_walls();
  for (Corners& wall : walls) {
    for (glm::vec3& corner : wall) corner.x *= 2.0f;
  }
  builder.place(builder.add_quads(walls, surface(glm::vec3(albedo))));
  const std::array<Corners, 2> between{
      {{{{0.02f, -1, -1}, {0.02f, -1, 1}, {0.02f, 1, 1}, {0.02f, 1, -1}}},
       {{{0.04f, -1, 1}, {0.04f, -1, -1}, {0.04f, 1, -1}, {0.04f, 1, 1}}}}};
  builder.place(builder.add_quads(between, surface(glm::vec3(albedo))));
  builder.add_point_light({-1, 0.5f, 0}, glm::vec3(1.0f));
  auto scene = std::make_shared<scene::Scene>(*builder.build());
  constexpr float seconds = 0.2f;
  scene::Channel raised;
  raised.node = 1;
  raised.times = {0.0f, seconds};
  raised.values = {0, 0, 0, 0, 2, 0};
  scene->clips = {{"open", seconds, {raised}}};
  return scene;
}

scene::Camera left_room() {
  return look({-1.8f, 0, 0.8f}, {-0.5f, 0, -0.5f}, 70.0f);
}
scene::Camera right_room() {
  return look({1.8f, 0, 0.8f}, {0.5f, 0, -0.5f}, 70.0f);
}

TEST(Indirect, LittleLightLeaksThroughThinWalls) {
  RendererRig rig(two_rooms(0.8f), scene::constant_environment(glm::vec3(0.0f)), left_room(), 64,
                  48);
  rig.apply(gathered());
  rig.accumulate(64);
  const double lit = mean_of(rig.capture("accumulated"), {0, 0}, {64, 48}).x;
  rig.renderer.set_camera(right_room());
  save_image("indirect_leak", rig.accumulate(64));
  const double dark = mean_of(rig.capture("accumulated"), {0, 0}, {64, 48}).x;
  std::printf("light that leaks: %.4f of the lit room's\n", dark / lit);
  EXPECT_GT(lit, 0.05);
  EXPECT_LT(dark, 0.02 * lit);
}

// Half a second after the wall has come to rest.
TEST(Indirect, FollowsAWallThatMoves) {
  RendererRig rig(two_rooms(0.5f), scene::constant_environment(glm::vec3(0.0f)), right_room(), 64,
                  48);
  rig.apply(gathered());
  rig.renderer.set_frame_seconds(1.0f / 30.0f);
  const auto move = [&](float from, float to) {
    for (int i = 0; i <= 6; ++i) {
      const float along = from + (to - from) * float(i) / 6.0f;
      EXPECT_TRUE(rig.renderer.set_pose("open", 0.2 * along));
      rig.renderer.render();
    }
  };
  const auto wait = [&](int frames) {
    for (int i = 0; i < frames; ++i) {
      scene::Camera camera = right_room();
      camera.eye.y += 0.002f * float(i % 2);
      rig.renderer.set_camera(camera);
      rig.renderer.render();
    }
  };
  const auto indirect = [&] {
    return mean_of(rig.capture("indirect.history"), {0, 0}, {32, 24}).x;  // of half the size
  };
  move(0, 0);
  wait(64);
  const double closed = indirect();
  move(0, 1);
  wait(15);
  const double soon = indirect();
  wait(128);
  const double open = indirect();
  EXPECT_GT(open, 10.0 * closed);
  EXPECT_NEAR(soon, open, 0.1 * (open - closed));
  move(1, 0);
  wait(15);
  EXPECT_LT(indirect(), closed + 0.1 * (open - closed));
  wait(30);
  EXPECT_LT(indirect(), closed + 0.01 * (open - closed));
}

// Metals let no diffuse light through: what hides the environment from them is in front.
TEST(Indirect, MetalsReflectTheSkyWhateverTheyWouldLetThrough) {
  const auto seen = [](const scene::MaterialLayers& layers) {
    SceneBuilder builder;
    const auto metal = builder.with_layers(surface(glm::vec3(0.9f), 1.0f, 1.0f), layers);
    builder.place(builder.add_quad({{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}}, metal));
    RendererRig rig(builder.build(), scene::constant_environment(glm::vec3(1.0f)),
                    look({0, 0, 3}, {0, 0, 0}, 20.0f), 24, 24);
    protocol::Settings settings = undenoised();
    settings.indirect.enabled = true;
    settings.specular.enabled = false;
    return mean_color(rig, settings, "indirect_metal", 8).y;
  };
  const double expected = seen({});
  EXPECT_GT(expected, 0.5);
  EXPECT_NEAR(seen({.diffuse_transmission = 1.0f}) / expected, 1.0, 0.02);
}

TEST(Indirect, FramesDoNotDependOnThreads) {
  if (!device().is_cpu()) GTEST_SKIP() << "shaders make cells in any order";
  const auto frame = [] {
    RendererRig rig(cornell_box(), scene::constant_environment(glm::vec3(0.2f)),
                    look({0, 0, 3.6f}, {0, 0, 0}, 38.0f), 60, 60);
    rig.apply(gathered());
    return rig.accumulate(12).rgba;
  };
  EXPECT_EQ(frame(), frame());
}

}  // namespace
}  // namespace heliograph::test
