#include <gtest/gtest.h>

#include <array>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/animation/explosion.hpp"
#include "tests/image/support/renderer_rig.hpp"

namespace heliograph::test {
namespace {

const scene::Camera exploded_view = look({0.5f, 2.2f, 6.0f}, {0, 0.8f, 0});

shared::Material bright() {
  shared::Material material = surface({0.8f, 0.8f, 0.8f});
  material.emissive = {5, 4, 3};
  return material;
}

/// Four spheres, one of which shines, `spread` times as far from their middle as at rest.
std::shared_ptr<const scene::Scene> four_spheres(float spread) {
  SceneBuilder builder;
  const auto red = builder.add_sphere(0.4f, surface({0.9f, 0.2f, 0.1f}, 0.4f));
  const auto bright_sphere = builder.add_sphere(0.4f, bright());
  constexpr std::array<glm::vec3, 4> places = {
      {{-0.5f, 0, -0.4f}, {0.5f, 0, -0.4f}, {0.5f, 0, 0.4f}, {-0.5f, 0, 0.4f}}};
  for (std::size_t i = 0; i < places.size(); ++i) {
    const glm::vec3 at = spread * places[i] + glm::vec3(0, 0.4f, 0);
    builder.place(i == 1 ? bright_sphere : red, glm::translate(glm::mat4(1.0f), at));
  }
  builder.add_sun({-0.4f, -1.0f, -0.3f}, {2.5f, 2.5f, 2.3f}, 2.0f);
  return builder.build();
}

RendererRig spheres_rig(std::shared_ptr<const scene::Scene> scene, const std::string& tracer) {
  return RendererRig(std::move(scene), scene::constant_environment(glm::vec3(0.3f)), exploded_view,
                     160, 120, tracer);
}

protocol::Settings exploded_by(float amount, protocol::ReferenceUse use) {
  protocol::Settings settings;
  settings.view.explode = amount;
  settings.reference.use = use;
  return settings;
}

class ExplodedView : public testing::TestWithParam<const char*> {};

TEST_P(ExplodedView, IsTheSceneWithItsPartsApart) {
  for (const auto use : {protocol::ReferenceUse::off, protocol::ReferenceUse::always}) {
    const std::string name = std::string("exploded_") + GetParam() +
                             (use == protocol::ReferenceUse::off ? "_hybrid" : "_reference");
    RendererRig rig = spheres_rig(four_spheres(1.0f), GetParam());
    rig.apply(exploded_by(0.0f, use));
    const render::Frame assembled = rig.accumulate(8);
    rig.apply(exploded_by(0.4f, use));
    rig.accumulate(2);
    rig.apply(exploded_by(1.0f, use));
    const render::Frame exploded = rig.accumulate(8);
    save_image(name, exploded);
    RendererRig placed = spheres_rig(four_spheres(2.0f), GetParam());
    placed.apply(exploded_by(0.0f, use));
    expect_similar(name, placed.accumulate(8), exploded, 0.7, 0.99);
    EXPECT_LT(ssim(assembled, exploded), 0.95);
    rig.apply(exploded_by(0.0f, use));
    expect_similar(name + "_assembled", assembled, rig.accumulate(8), 0.7, 0.99);
  }
}

TEST_P(ExplodedView, HidesInstancesAsTheAssembledOne) {
  RendererRig rig = spheres_rig(four_spheres(1.0f), GetParam());
  rig.apply(exploded_by(1.0f, protocol::ReferenceUse::off));
  rig.accumulate(2);
  rig.renderer.set_hidden({false, true, false, true});
  const render::Frame shown = rig.accumulate(8);
  RendererRig placed = spheres_rig(four_spheres(2.0f), GetParam());
  placed.renderer.set_hidden({false, true, false, true});
  expect_similar("exploded_hidden", placed.accumulate(8), shown, 0.7, 0.99);
}

INSTANTIATE_TEST_SUITE_P(Tracers, ExplodedView, testing::Values("auto", "software"));

}  // namespace
}  // namespace heliograph::test
