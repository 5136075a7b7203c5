#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "tests/image/support/renderer_rig.hpp"

namespace heliograph::test {
namespace {

const scene::Camera view = look({0.4f, 2.0f, 4.0f}, {0, 0.4f, 0});
constexpr std::uint32_t sphere = 1, bright_sphere = 2;  // instances of the whole room

shared::Material bright_material() {
  shared::Material material = surface({0.8f, 0.8f, 0.8f});
  material.emissive = {6, 5, 3};
  return material;
}

/// A smooth floor; upon it, if asked for, a sphere and one that shines. With `clip` one of the
/// things moves: the clip "rise" lifts what is placed last.
std::shared_ptr<const scene::Scene> hidden_room(bool furnished, bool clip = false) {
  SceneBuilder builder;
  builder.place(builder.add_quad({{{-6, 0, 6}, {6, 0, 6}, {6, 0, -6}, {-6, 0, -6}}},
                                 surface({0.6f, 0.6f, 0.6f}, 0.15f)));
  if (furnished) {
    builder.place(builder.add_sphere(0.6f, surface({0.9f, 0.2f, 0.1f}, 0.6f)),
                  glm::translate(glm::mat4(1.0f), {-0.7f, 0.6f, 0}));
    builder.place(builder.add_sphere(0.3f, bright_material()),
                  glm::translate(glm::mat4(1.0f), {0.8f, 0.4f, 0.5f}));
  }
  builder.add_sun({-0.4f, -1.0f, -0.3f}, {2.5f, 2.5f, 2.3f}, 2.0f);
  if (!clip) return builder.build();
  auto scene = std::make_shared<scene::Scene>(*builder.build());
  const std::uint32_t node = scene->instances.back().node;
  const glm::vec3 at(scene->nodes[node].world[3]);
  scene->nodes[node].transform = scene::Transform{at, {1, 0, 0, 0}, glm::vec3(1.0f)};
  scene::Channel channel;
  channel.node = node;
  channel.times = {0.0f, 1.0f};
  channel.values = {at.x, at.y, at.z, at.x, at.y + 1.0f, at.z};
  scene->clips = {{"rise", 1.0f, {channel}}};
  return scene;
}

render::Frame rendered_room(RendererRig& rig, protocol::ReferenceUse reference) {
  protocol::Settings settings;
  settings.reference.use = reference;
  rig.apply(settings);
  return rig.accumulate(8);
}

RendererRig rig_of(std::shared_ptr<const scene::Scene> scene, const std::string& tracer) {
  return RendererRig(std::move(scene), scene::constant_environment(glm::vec3(0.3f)), view, 160, 120,
                     tracer);
}

class HiddenInstances : public testing::TestWithParam<const char*> {};

TEST_P(HiddenInstances, LeaveNoTraceInFrameOrReference) {
  for (const auto use : {protocol::ReferenceUse::off, protocol::ReferenceUse::always}) {
    const std::string name = std::string("hidden_") + GetParam() +
                             (use == protocol::ReferenceUse::off ? "_hybrid" : "_reference");
    RendererRig bare = rig_of(hidden_room(false), GetParam());
    RendererRig furnished = rig_of(hidden_room(true), GetParam());
    const render::Frame all = rendered_room(furnished, use);
    furnished.renderer.set_hidden({false, true, true});
    const render::Frame hidden = rendered_room(furnished, use);
    save_image(name, hidden);
    expect_similar(name, rendered_room(bare, use), hidden, 0.7, 0.99);
    furnished.renderer.set_hidden({});
    expect_similar(name + "_again", all, rendered_room(furnished, use), 0.7, 0.99);
  }
}

TEST_P(HiddenInstances, StayHiddenWhileAClipMovesThem) {
  RendererRig rig = rig_of(hidden_room(true, true), GetParam());
  RendererRig bare = rig_of(hidden_room(false), GetParam());
  ASSERT_TRUE(rig.renderer.set_pose("rise", 0.5));
  rendered_room(rig, protocol::ReferenceUse::off);
  rig.renderer.set_hidden({false, true, true});
  expect_similar("hidden_moving", rendered_room(bare, protocol::ReferenceUse::off),
                 rendered_room(rig, protocol::ReferenceUse::off), 0.7, 0.99);
  ASSERT_TRUE(rig.renderer.set_pose("rise", 0.7));
  expect_similar("hidden_moved", rendered_room(bare, protocol::ReferenceUse::off),
                 rendered_room(rig, protocol::ReferenceUse::off), 0.7, 0.99);
}

INSTANTIATE_TEST_SUITE_P(Tracers, HiddenInstances, testing::Values("auto", "software"));

/// Pixels in which two frames differ by more than `least` code values.
int differing_pixels(const render::Frame& a, const render::Frame& b, int least) {
  int count = 0;
  for (std::size_t i = 0; i < a.rgba.size(); i += 4) {
    int most = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      most = std::max(most, std::abs(int{a.rgba[i + c]} - int{b.rgba[i + c]}));
    }
    count += most >= least;
  }
  return count;
}

TEST(Selection, IsOutlinedWithoutSteps) {
  RendererRig rig = rig_of(hidden_room(true), "auto");
  const render::Frame plain = rendered_room(rig, protocol::ReferenceUse::off);
  rig.renderer.set_selected(std::array{sphere});
  EXPECT_TRUE(rig.renderer.needs_frame());
  const render::Frame outlined = rig.renderer.render();
  save_image("selection", outlined);
  EXPECT_GT(outlined.samples, 8u) << "the mean of the samples goes on";
  // The sphere is 46 pixels wide: a line of two pixels around it covers about 300.
  const int changed = differing_pixels(plain, outlined, 24),
            strong = differing_pixels(plain, outlined, 80);
  EXPECT_GT(strong, 100);
  EXPECT_LT(changed, 600);
  EXPECT_GT(changed, strong + 60) << "edges fade";
  rig.renderer.set_selected({});
  EXPECT_EQ(differing_pixels(plain, rig.renderer.render(), 24), 0);
}

TEST(Selection, OutlineOfTheHostMatchesTheShader) {
  if (!device().is_cpu()) GTEST_SKIP() << "host kernels run on CPU devices only";
  render::Engine shaders({.validation = true, .host_kernels = false});
  const auto outlined = [](render::Engine& engine) {
    render::Renderer renderer(engine);
    renderer.set_scene(
        engine.upload(hidden_room(true), scene::constant_environment(glm::vec3(0.3f))));
    renderer.set_size(160, 120);
    renderer.set_camera(view);
    protocol::Settings settings;
    settings.indirect.enabled = false;
    EXPECT_TRUE(renderer.set_settings(settings));
    renderer.set_selected(std::array{sphere, bright_sphere});
    renderer.set_draw_scale(0.5f);
    renderer.render();
    return renderer.render();
  };
  const render::Frame expected = outlined(shaders), found = outlined(engine());
  EXPECT_LT(differing_pixels(expected, found, 12), 60);
}

}  // namespace
}  // namespace heliograph::test
