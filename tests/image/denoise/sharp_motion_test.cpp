// Thin shadows and reflections in curved surfaces must stay sharp under camera motion.
#include <gtest/gtest.h>

#include "tests/image/denoise/spheres.hpp"

namespace heliograph::test {
namespace {

constexpr int frames = 20;

/// Thin bars with thin shadows around a metal sphere on a bright ground.
std::shared_ptr<const scene::Scene> bars_around_sphere(float roughness) {
  SceneBuilder builder;
  builder.place(builder.add_quad({{{-9, 0, 9}, {9, 0, 9}, {9, 0, -9}, {-9, 0, -9}}},
                                 surface({0.8f, 0.8f, 0.75f}, 0.9f)));
  builder.place(builder.add_sphere(0.8f, surface({0.95f, 0.9f, 0.8f}, roughness, 1.0f)),
                glm::translate(glm::mat4(1.0f), {0.9f, 0.8f, 0.3f}));
  shared::Material red = surface({0.7f, 0.1f, 0.05f}, 0.8f);
  red.flags |= shared::material_double_sided;
  const auto bar =
      builder.add_quad({{{-0.05f, 0, 0}, {0.05f, 0, 0}, {0.05f, 1.2f, 0}, {-0.05f, 1.2f, 0}}}, red);
  for (int i = 0; i < 12; ++i) {
    const float x = 0.3f * static_cast<float>(i) - 3.0f;
    builder.place(bar, glm::translate(glm::mat4(1.0f), {x, 0, -0.6f}));
  }
  builder.add_sun({0.25f, -1, 0.6f}, glm::vec3(2.5f), 0.5f);
  return builder.build();
}

scene::Camera orbit(int frame) {
  const float angle = 0.02f * static_cast<float>(frame);
  return look({5.0f * std::sin(angle), 1.8f, 5.0f * std::cos(angle)}, {0, 0.5f, 0});
}

/// Mean error of the last frame of an orbit, over the pixels whose instance is selected.
template <class Selected>
double error_in_motion(protocol::Settings settings, const std::string& name, Selected selected,
                       float roughness = 0.03f) {
  settings.antialiasing.jitter = settings.antialiasing.temporal = true;
  const auto scene = bars_around_sphere(roughness);
  SpheresRig rig(scene, settings);
  rig.renderer.set_frame_seconds(1.0f / 30.0f);
  render::Frame shown;
  for (int i = -frames; i <= 0; ++i) {
    rig.renderer.set_camera(orbit(i));
    shown = rig.renderer.render();
  }
  save_image(name, shown);
  protocol::Settings smooth = noisy_only();
  smooth.antialiasing.jitter = true;
  SpheresRig reference(scene, smooth);
  reference.renderer.set_camera(orbit(0));
  const render::Frame expected = reference.accumulate(128);
  save_image(name + "_ground_truth", expected);
  const render::FloatImage instances = reference.capture("gbuffer.instance");
  double sum = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < expected.rgba.size(); ++i) {
    if (i % 4 == 3 || !selected(static_cast<int>(instances.rgba[i - i % 4]))) continue;
    sum += std::abs(double(shown.rgba[i]) - double(expected.rgba[i]));
    ++count;
  }
  return sum / count;
}

constexpr auto is_sphere = [](int instance) { return instance == 2; };

// A perfect mirror is noise-free with one ray per pixel.
TEST(SharpMotion, MirrorIsAsSharpAsWithoutDenoising) {
  protocol::Settings settings = denoised_only();
  const double denoised = error_in_motion(settings, "orbit_mirror", is_sphere);
  settings.specular_temporal.enabled = settings.specular_blur.enabled = false;
  const double raw = error_in_motion(settings, "orbit_mirror_raw", is_sphere);
  EXPECT_LT(denoised, 1.1 * raw);
}

TEST(SharpMotion, GlossySphereReflectionDoesNotLag) {
  protocol::Settings settings = denoised_only();
  for (const float roughness : {0.1f, 0.2f}) {
    const std::string name = "orbit_ball_" + std::to_string(int(100.0f * roughness));
    settings.specular_temporal.virtual_motion = true;
    const double compensated = error_in_motion(settings, name, is_sphere, roughness);
    settings.specular_temporal.virtual_motion = false;
    const double lagging = error_in_motion(settings, name + "_lagging", is_sphere, roughness);
    EXPECT_LT(compensated, 0.9 * lagging) << roughness;
    settings.specular_temporal.virtual_motion = true;
    protocol::Settings other = settings;
    other.specular_temporal.rectification = protocol::Rectification::fast_history;
    const double by_fast_history =
        error_in_motion(other, name + "_fast_history", is_sphere, roughness);
    EXPECT_LT(compensated, by_fast_history) << roughness;
    other.specular_temporal.virtual_motion = false;
    EXPECT_LT(by_fast_history, 0.85 * error_in_motion(other, name + "_both", is_sphere, roughness))
        << roughness;
  }
}

TEST(SharpMotion, ThinShadowsAreNotSmeared) {
  const auto is_ground = [](int instance) { return instance == 1; };
  protocol::Settings settings = denoised_only();
  const double sharp = error_in_motion(settings, "orbit_bars", is_ground);
  settings.shadow_temporal.bicubic = false;
  const double smeared = error_in_motion(settings, "orbit_bars_bilinear", is_ground);
  EXPECT_LT(sharp, 0.97 * smeared);
}

}  // namespace
}  // namespace heliograph::test
