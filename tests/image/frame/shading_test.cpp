#include "shaders/shared/shading.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/image/support/renderer_rig.hpp"

namespace heliograph::test {
namespace {

using protocol::ShadingMode;
constexpr std::uint32_t shading_width = 160, shading_height = 120;

/// A glossy red ball and a shining one on a floor that is one quad, with texture coordinates.
std::shared_ptr<const scene::Scene> shaded_room(bool plain = false) {
  const auto made = [plain](const glm::vec3& color, float roughness, float metallic = 0.0f) {
    if (!plain) return surface(color, roughness, metallic);
    return surface(glm::vec3(shared::clay_albedo), shared::clay_roughness);
  };
  SceneBuilder builder;
  builder.place(builder.add_quad({{{-3, 0, 3}, {3, 0, 3}, {3, 0, -3}, {-3, 0, -3}}},
                                 made({0.7f, 0.6f, 0.3f}, 0.1f)));
  builder.place(builder.add_sphere(0.7f, made({0.9f, 0.1f, 0.1f}, 0.2f, 1.0f)),
                glm::translate(glm::mat4(1.0f), {-0.9f, 0.7f, 0}));
  shared::Material shining = made({0.1f, 0.1f, 0.9f}, 0.6f);
  if (!plain) shining.emissive = {3, 2, 1};
  builder.place(builder.add_sphere(0.7f, shining),
                glm::translate(glm::mat4(1.0f), {0.9f, 0.7f, 0}));
  builder.add_sun({-0.4f, -1.0f, -0.3f}, {2.5f, 2.5f, 2.3f}, 2.0f);
  return builder.build();
}

const scene::Camera above = look({0, 3.0f, 4.0f}, {0, 0.4f, 0});

RendererRig shading_rig(const std::string& tracer, bool plain = false) {
  return RendererRig(shaded_room(plain), scene::constant_environment(glm::vec3(0.4f)), above,
                     shading_width, shading_height, tracer);
}

protocol::Settings shading_settings(ShadingMode mode) {
  protocol::Settings settings = undenoised();
  settings.view.shading = mode;
  return settings;
}

render::Frame shade(RendererRig& rig, ShadingMode mode, const std::string& name,
                    std::uint32_t samples = 16) {
  rig.apply(shading_settings(mode));
  render::Frame frame = rig.accumulate(samples);
  save_image("shading_" + name, frame);
  return frame;
}

class Shading : public testing::TestWithParam<const char*> {};

TEST_P(Shading, ClayIsWhatASceneOfOneMaterialShows) {
  const std::string tracer = GetParam();
  RendererRig rig = shading_rig(tracer), plain = shading_rig(tracer, true);
  for (const auto use : {protocol::ReferenceUse::off, protocol::ReferenceUse::always}) {
    protocol::Settings settings = shading_settings(ShadingMode::clay);
    settings.reference.use = use;
    rig.apply(settings);
    settings.view.shading = ShadingMode::lit;
    plain.apply(settings);
    expect_similar("shading_clay_" + tracer, plain.accumulate(32), rig.accumulate(32), 1.0, 0.97);
  }
}

TEST_P(Shading, NormalsAndTextureCoordinatesNeedNoLight) {
  const std::string tracer = GetParam();
  RendererRig rig = shading_rig(tracer);
  shade(rig, ShadingMode::normals, "normals_" + tracer);
  // The floor in front faces up.
  const glm::vec3 up = rgb(rig.capture("accumulated"), shading_width / 2, shading_height - 6);
  EXPECT_NEAR(up.x, 0.25f, 0.01f);
  EXPECT_NEAR(up.y, 1.0f, 0.01f);
  EXPECT_NEAR(up.z, 0.25f, 0.01f);
  shade(rig, ShadingMode::uv_checker, "uv_" + tracer);
  shade(rig, ShadingMode::matcap, "matcap_" + tracer);
  // The upper left of a ball is bright, the lower right dark, and both balls are alike.
  const render::FloatImage matcap = rig.capture("accumulated");
  const auto brightest_row = [&](std::uint32_t from, std::uint32_t to) {
    float most = 0.0f;
    for (std::uint32_t x = from; x < to; ++x)
      most = std::max(most, rgb(matcap, x, shading_height / 2).y);
    return most;
  };
  EXPECT_NEAR(brightest_row(0, shading_width / 2), brightest_row(shading_width / 2, shading_width),
              0.08f);
}

TEST_P(Shading, WireframeDrawsTheDiagonalOfAQuad) {
  const std::string tracer = GetParam();
  RendererRig rig = shading_rig(tracer);
  const render::Frame lit = shade(rig, ShadingMode::lit, "lit_" + tracer, 32);
  const render::Frame wires = shade(rig, ShadingMode::wireframe, "wireframe_" + tracer, 32);
  // In front of the balls the floor shows its diagonal alone: one dark place in a row.
  constexpr std::uint32_t row = shading_height - 20;
  std::vector<std::uint32_t> darker;
  for (std::uint32_t x = 10; x < shading_width - 10; ++x) {
    const std::size_t at = 4 * (std::size_t{row} * shading_width + x);
    if (wires.rgba[at] + 40 < lit.rgba[at]) darker.push_back(x);
  }
  ASSERT_FALSE(darker.empty());
  EXPECT_LE(darker.back() - darker.front(), 4u);
}

INSTANTIATE_TEST_SUITE_P(Tracers, Shading, testing::Values("auto", "software"));

TEST(ShadingModes, NeedNoScene) {
  RendererRig rig = shading_rig("auto");
  rig.renderer.set_scene(nullptr);
  for (const ShadingMode mode : {ShadingMode::clay, ShadingMode::normals, ShadingMode::lit}) {
    rig.apply(shading_settings(mode));
    EXPECT_GT(rig.accumulate(1).rgba.size(), 0u) << protocol::enum_name(mode);
  }
}

TEST(ShadingModes, LeaveLitFramesAsTheyWere) {
  RendererRig rig = shading_rig("auto");
  const auto frame = [&](ShadingMode mode) {
    rig.apply(shading_settings(mode));
    rig.renderer.reset();
    return rig.accumulate(2).rgba;
  };
  const auto before = frame(ShadingMode::lit);
  EXPECT_NE(frame(ShadingMode::clay), before);
  EXPECT_EQ(frame(ShadingMode::lit), before);
}

}  // namespace
}  // namespace heliograph::test
