// Alpha-blended surfaces seen by the camera: composited over the HDR image in depth order, without
// the noise of stochastic transparency.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/import.hpp"
#include "tests/image/support/renderer_rig.hpp"

namespace heliograph::test {
namespace {

using protocol::PrimaryVisibility;

protocol::Settings undenoised_from(PrimaryVisibility source) {
  protocol::Settings settings = undenoised();
  settings.gbuffer.source = source;
  return settings;
}

shared::Material translucent(const glm::vec3& color, float alpha) {
  shared::Material material = surface(color);
  material.base_color.w = alpha;
  material.flags = shared::material_alpha_blend | shared::material_unlit;
  return material;
}

std::array<glm::vec3, 4> wall(float z, float half) {
  return {{{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}}};
}

class BlendOver : public testing::TestWithParam<PrimaryVisibility> {
 protected:
  /// HDR image of the first frame, before accumulation.
  render::FloatImage first_frame(const std::shared_ptr<const scene::Scene>& scene,
                                 const char* name) {
    RendererRig rig(scene, scene::constant_environment(glm::vec3(0.5f)),
                    look({0, 0, 4}, {0, 0, 0}, 20.0f), 48, 48);
    rig.apply(undenoised_from(GetParam()));
    save_image(name, rig.accumulate(1));
    return rig.capture("hdr");
  }
};

INSTANTIATE_TEST_SUITE_P(Sources, BlendOver,
                         testing::Values(PrimaryVisibility::rays, PrimaryVisibility::raster),
                         [](const auto& tested) {
                           return std::string(protocol::enum_name(tested.param));
                         });

// Independent of the order of the instances in the file.
TEST_P(BlendOver, LayersCompositeInDepthOrderWithoutNoise) {
  const glm::vec3 red(1.0f, 0.1f, 0.1f), green(0.1f, 1.0f, 0.1f), back(0.2f, 0.3f, 0.8f);
  shared::Material board = surface(back);
  board.flags = shared::material_unlit;
  for (const bool near_first : {true, false}) {
    SceneBuilder builder;
    const auto near = builder.add_quad(wall(1, 3), translucent(red, 0.25f));
    const auto far = builder.add_quad(wall(0, 3), translucent(green, 0.5f));
    const auto hidden = builder.add_quad(wall(-2, 3), translucent(glm::vec3(5.0f), 0.9f));
    const auto solid = builder.add_quad(wall(-1, 3), board);
    builder.place(near_first ? near : far).place(near_first ? far : near);
    builder.place(hidden).place(solid);
    const render::FloatImage image = first_frame(builder.build(), "blend_over_layers");
    const glm::vec3 expected = 0.25f * red + 0.75f * (0.5f * green + 0.5f * back);
    for (std::uint32_t y = 0; y < 48; ++y) {
      for (std::uint32_t x = 0; x < 48; ++x) {
        const glm::vec3 seen = rgb(image, x, y);
        ASSERT_LE(glm::distance(seen, expected), 0.004f)
            << x << ", " << y << ": " << seen.x << " " << seen.y << " " << seen.z;
      }
    }
  }
}

TEST_P(BlendOver, GBufferHoldsOpaqueSurfacesOnly) {
  SceneBuilder builder;
  const auto pane = builder.add_quad(wall(1, 3), translucent(glm::vec3(1.0f), 0.25f));
  const auto opaque =
      builder.add_quad({{{-3, -3, 0.5f}, {0, -3, 0.5f}, {0, 3, 0.5f}, {-3, 3, 0.5f}}},
                       translucent(glm::vec3(0.5f), 1.0f));
  builder.place(pane).place(opaque);
  RendererRig rig(builder.build(), scene::constant_environment(glm::vec3(0.0f)),
                  look({0, 0, 4}, {0, 0, 0}, 20.0f), 32, 32);
  rig.apply(undenoised_from(GetParam()));
  rig.accumulate(1);
  const render::FloatImage instance = rig.capture("gbuffer.instance");
  const render::FloatImage motion = rig.capture("gbuffer.motion");
  EXPECT_EQ(rgb(instance, 4, 16).x, 2.0f) << "a blended surface of alpha 1 is opaque";
  EXPECT_EQ(rgb(instance, 28, 16).x, 0.0f) << "nothing behind the pane";
  EXPECT_NEAR(motion.rgba[(16 * 32 + 4) * 4 + 3], 3.5f, 1e-3f);
}

// KHR_materials_transmission tints the background by the base color.
TEST_P(BlendOver, TransmissionTintsBackground) {
  SceneBuilder builder;
  shared::Material board = surface(glm::vec3(0.5f));
  board.flags = shared::material_unlit;
  scene::MaterialLayers clear;
  clear.transmission = 1.0f;
  clear.specular = 0.0f;  // no reflection, only transmission
  const glm::vec3 color(0.9f, 0.5f, 0.1f);
  builder.place(builder.add_quad(wall(0, 3), builder.with_layers(surface(color, 0.5f), clear)));
  builder.place(builder.add_quad(wall(-1, 3), board));
  const glm::vec3 seen = rgb(first_frame(builder.build(), "blend_over_glass"), 24, 24);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], 0.5f * color[c], 0.004f) << "channel " << c;
}

// Temporal antialiasing follows the layer with the largest weight.
TEST_P(BlendOver, MotionVectorIsOfMostOpaqueLayer) {
  SceneBuilder builder;
  builder.place(builder.add_quad({{{-3, -3, 1}, {0, -3, 1}, {0, 3, 1}, {-3, 3, 1}}},
                                 translucent(glm::vec3(0.7f), 0.8f)));
  builder.place(builder.add_quad({{{0, -3, 1}, {3, -3, 1}, {3, 3, 1}, {0, 3, 1}}},
                                 translucent(glm::vec3(0.7f), 0.2f)));
  builder.place(builder.add_quad(wall(-4, 8), surface(glm::vec3(0.4f))));
  RendererRig rig(builder.build(), scene::constant_environment(glm::vec3(0.5f)),
                  look({0, 0, 4}, {0, 0, 0}, 20.0f), 32, 32);
  rig.apply(undenoised_from(GetParam()));
  rig.accumulate(1);
  rig.renderer.set_camera(look({0.1f, 0, 4}, {0.1f, 0, 0}, 20.0f));
  rig.renderer.render();
  const render::FloatImage motion = rig.capture("blended.motion");
  const auto at = [&](std::uint32_t x) { return &motion.rgba[(16 * 32 + x) * 4]; };
  EXPECT_NEAR(at(6)[3], 3.0f, 1e-3f);
  EXPECT_NEAR(at(26)[3], 8.0f, 1e-3f);
  EXPECT_NEAR(at(6)[0] / at(26)[0], 8.0f / 3.0f, 0.05f);
}

/// Mean error of the last frame of a sideways camera motion past a checkered pane far in front of a
/// wall, against a converged static view.
double error_in_motion(PrimaryVisibility source, float alpha) {
  SceneBuilder builder;
  std::vector<std::uint8_t> checks;
  for (int i = 0; i < 256; ++i) {
    const auto level = static_cast<std::uint8_t>((i + i / 16) % 2 ? 230 : 40);
    checks.insert(checks.end(), {level, level, level, 255});
  }
  shared::Material pane = translucent(glm::vec3(1.0f), alpha);
  pane.base_color_texture.texture = builder.add_texture(16, 16, true, checks);
  shared::Material board = surface(glm::vec3(0.3f));
  board.flags = shared::material_unlit;
  builder.place(builder.add_quad(wall(0, 1.5f), pane))
      .place(builder.add_quad(wall(-20, 40), board));
  const auto scene = builder.build();
  const auto camera = [](int frame) {
    const float x = 0.04f * static_cast<float>(frame);
    return look({x, 0, 4}, {x, 0, 0}, 30.0f);
  };
  const auto rig = [&] {
    return RendererRig(scene, scene::constant_environment(glm::vec3(0.5f)), camera(-12), 64, 64);
  };
  protocol::Settings settings = undenoised_from(source);
  RendererRig moving = rig(), reference = rig();
  settings.antialiasing.jitter = settings.antialiasing.temporal = true;
  moving.apply(settings);
  render::Frame shown;
  for (int i = -12; i <= 0; ++i) {
    moving.renderer.set_camera(camera(i));
    shown = moving.renderer.render();
  }
  settings.antialiasing.temporal = false;
  reference.apply(settings);
  reference.renderer.set_camera(camera(0));
  const render::Frame expected = reference.accumulate(64);
  save_image("blend_over_moving", shown);
  double sum = 0.0;
  for (std::size_t i = 0; i < expected.rgba.size(); ++i) {
    sum += std::abs(double(shown.rgba[i]) - double(expected.rgba[i]));
  }
  return sum / static_cast<double>(expected.rgba.size());
}

TEST_P(BlendOver, DoesNotSmearUnderCameraMotion) {
  const double solid = error_in_motion(GetParam(), 1.0f);
  EXPECT_LT(error_in_motion(GetParam(), 0.9f), 1.2 * solid + 0.1);
}

/// A smooth tinted and a rough pane in front of spheres on a floor, under sun, point light and sky.
std::shared_ptr<const scene::Scene> room_with_panes() {
  SceneBuilder builder;
  builder.place(builder.add_quad({{{-6, 0, 4}, {6, 0, 4}, {6, 0, -6}, {-6, 0, -6}}},
                                 surface({0.6f, 0.5f, 0.4f}, 0.5f)));
  builder.place(builder.add_sphere(0.7f, surface({0.8f, 0.2f, 0.1f}, 0.2f)),
                glm::translate(glm::mat4(1.0f), {-0.8f, 0.7f, -1}));
  shared::Material smooth = surface({0.3f, 0.6f, 0.9f}, 0.1f),
                   cloth = surface({0.9f, 0.8f, 0.3f}, 0.9f);
  smooth.base_color.w = 0.4f;
  cloth.base_color.w = 0.7f;
  smooth.flags = cloth.flags = shared::material_alpha_blend | shared::material_double_sided;
  builder.place(
      builder.add_quad({{{-2, 0, 0}, {0.6f, 0, 0.6f}, {0.6f, 1.8f, 0.6f}, {-2, 1.8f, 0}}}, smooth));
  builder.place(builder.add_quad(
      {{{-0.4f, 0.2f, 1}, {2, 0.2f, -0.5f}, {2, 1.6f, -0.5f}, {-0.4f, 1.6f, 1}}}, cloth));
  builder.place(builder.add_sphere(0.5f, smooth),
                glm::translate(glm::mat4(1.0f), {1.6f, 0.5f, 0.8f}));
  builder.add_sun({0.5f, -1, -0.4f}, {3.0f, 2.8f, 2.4f}).add_point_light({2, 2, 1}, {4, 3, 2});
  return builder.build();
}

TEST_P(BlendOver, ConvergesToPathTracerAlongSamePaths) {
  const auto sky = [](const glm::vec3& d) {
    return glm::vec3(0.5f, 0.6f, 0.8f) + glm::vec3(0.3f, 0.2f, 0.1f) * d.y + 0.2f * d.x;
  };
  RendererRig rig(room_with_panes(), make_environment(128, sky),
                  look({0, 1.6f, 4.5f}, {0, 0.7f, 0}), 96, 54);
  protocol::Settings reference = undenoised_from(GetParam());
  reference.reference.use = protocol::ReferenceUse::always;
  reference.reference.scope = protocol::ReferenceScope::same_paths;
  const glm::dvec3 got = mean_color(rig, undenoised_from(GetParam()), "blend_over_hybrid");
  const glm::dvec3 expected = mean_color(rig, reference, "blend_over_reference");
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c] / expected[c], 1.0, 0.01) << "channel " << c;
}

// Khronos sample model whose goggles have blended lenses.
TEST(BlendedAsset, TransparentGlassesMatchReference) {
  const auto file = asset("gltf/FlightHelmet/FlightHelmet.gltf");
  if (!file) GTEST_SKIP() << "HELIOGRAPH_TEST_ASSETS is not set";
  const auto scene = std::make_shared<const scene::Scene>(scene::import_gltf(*file));
  RendererRig rig(scene, scene::constant_environment(glm::vec3(0.6f)),
                  scene::fit_camera(scene->bounds, 30.0f, 1.0f), 160, 160);
  protocol::Settings hybrid = undenoised_from(PrimaryVisibility::automatic), reference = hybrid;
  reference.reference.use = protocol::ReferenceUse::always;
  reference.reference.scope = protocol::ReferenceScope::same_paths;
  const glm::dvec3 got = mean_color(rig, hybrid, "flight_helmet", 12);
  const glm::dvec3 expected = mean_color(rig, reference, "flight_helmet_reference", 12);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c] / expected[c], 1.0, 0.01) << "channel " << c;
}

}  // namespace
}  // namespace heliograph::test
