#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <stdexcept>

#include "tests/image/support/renderer_rig.hpp"

namespace heliograph::test {
namespace {

constexpr std::uint32_t width = 160, height = 120;
const render::Section front_half{.planes = {{0, 0, 1, 0}}};
const render::Section right_half{.planes = {{1, 0, 0, 0}}};

/// A smooth floor and a ball upon it.
std::shared_ptr<const scene::Scene> section_room(bool ball = true) {
  SceneBuilder builder;
  builder.place(builder.add_quad({{{-6, 0, 6}, {6, 0, 6}, {6, 0, -6}, {-6, 0, -6}}},
                                 surface({0.6f, 0.6f, 0.6f}, 0.05f)));
  if (ball) {
    builder.place(builder.add_sphere(0.8f, surface({0.2f, 0.3f, 0.9f}, 0.6f)),
                  glm::translate(glm::mat4(1.0f), {0, 0.8f, 0}));
  }
  builder.add_sun({-0.4f, -1.0f, -0.3f}, {2.5f, 2.5f, 2.3f}, 2.0f);
  return builder.build();
}

RendererRig section_rig(const glm::vec3& eye, const std::string& tracer = "auto") {
  return RendererRig(section_room(), scene::constant_environment(glm::vec3(0.3f)),
                     look(eye, {0, 0.7f, 0}), width, height, tracer);
}

protocol::Settings section_settings(protocol::ReferenceUse use) {
  protocol::Settings settings = undenoised();
  settings.reference.use = use;
  return settings;
}

class Sections : public testing::TestWithParam<const char*> {};

TEST_P(Sections, CloseWhatTheyCutInFrameAndReference) {
  for (const auto use : {protocol::ReferenceUse::off, protocol::ReferenceUse::always}) {
    RendererRig rig = section_rig({0.6f, 1.6f, 4.0f}, GetParam());
    rig.apply(section_settings(use));
    rig.renderer.set_section(front_half);
    save_image(std::string("section_") + GetParam() +
                   (use == protocol::ReferenceUse::off ? "_hybrid" : "_reference"),
               rig.accumulate(16));
    const render::FloatImage radiance = rig.capture("accumulated");
    // The middle of the frame shows the cut ball.
    const glm::vec3 cap = rgb(radiance, width / 2, height / 2);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(cap[c], front_half.cap_color[c], 0.01f) << c;
  }
}

TEST_P(Sections, TakeShadowsAndReflectionsWithThem) {
  // All but a thousandth of a metre of the ball is cut away, and what it did to the floor with it.
  RendererRig rig = section_rig({3.0f, 1.6f, 3.0f}, GetParam());
  rig.apply(section_settings(protocol::ReferenceUse::off));
  rig.renderer.set_section({.planes = {{0, 1, 0, 0.001f}}});
  const render::Frame cut = rig.accumulate(16);
  save_image(std::string("section_floor_") + GetParam(), cut);
  RendererRig bare(section_room(false), scene::constant_environment(glm::vec3(0.3f)),
                   look({3.0f, 1.6f, 3.0f}, {0, 0.7f, 0}), width, height, GetParam());
  bare.apply(section_settings(protocol::ReferenceUse::off));
  expect_similar(std::string("section_bare_") + GetParam(), bare.accumulate(16), cut, 1.5, 0.97);
}

INSTANTIATE_TEST_SUITE_P(Tracers, Sections, testing::Values("auto", "software"));

TEST(Section, AgreesWithTheReference) {
  RendererRig rig = section_rig({2.4f, 1.6f, 3.0f});
  rig.renderer.set_section(right_half);
  protocol::Settings settings = section_settings(protocol::ReferenceUse::off);
  rig.apply(settings);
  const render::Frame hybrid = rig.accumulate(64);
  settings.reference.use = protocol::ReferenceUse::always;
  rig.apply(settings);
  expect_similar("section_same_paths", rig.accumulate(64), hybrid, 2.0, 0.95);
}

TEST(Section, LeavesFramesWithoutPlanesAsTheyWere) {
  const auto frame_of = [](RendererRig& rig) {
    rig.renderer.reset();
    return rig.accumulate(2).rgba;
  };
  RendererRig rig = section_rig({0.6f, 1.6f, 4.0f});
  rig.apply(section_settings(protocol::ReferenceUse::off));
  const auto before = frame_of(rig);
  rig.renderer.set_section(front_half);
  EXPECT_NE(frame_of(rig), before);
  rig.renderer.set_section({});
  EXPECT_EQ(frame_of(rig), before);
}

TEST(Section, RefusesASeventhPlane) {
  RendererRig rig = section_rig({0.6f, 1.6f, 4.0f});
  render::Section section;
  section.planes.assign(7, {0, 0, 1, 9});
  EXPECT_THROW(rig.renderer.set_section(section), std::invalid_argument);
}

}  // namespace
}  // namespace heliograph::test
