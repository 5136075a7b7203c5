#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <set>
#include <string>
#include <vector>

#include "render/api/buffer_names.hpp"
#include "tests/image/support/renderer_rig.hpp"

namespace heliograph::test {
namespace {

constexpr std::uint32_t views_width = 160, views_height = 90;

/// A scene with every kind of buffer content; the camera moves before the last frame.
class Views : public testing::Test {
 protected:
  Views() {
    protocol::Settings settings;
    settings.specular.fade_fraction = 0.0f;  // few samples are not rectified
    rig_.apply(settings);
    for (int i = 0; i < 6; ++i) {
      rig_.renderer.set_camera(camera(0.15f * static_cast<float>(i - 5)));
      rig_.renderer.render();
    }
  }
  static scene::Camera camera(float x) { return look({0.5f + x, 2, 4.5f}, {0, 0.5f, 0}); }
  static std::shared_ptr<const scene::Scene> spheres() {
    SceneBuilder builder;
    builder.place(builder.add_quad({{{-9, 0, 9}, {9, 0, 9}, {9, 0, -9}, {-9, 0, -9}}},
                                   surface({0.6f, 0.55f, 0.5f}, 0.7f)));
    builder.place(builder.add_sphere(0.8f, surface({0.8f, 0.2f, 0.1f}, 0.4f)),
                  glm::translate(glm::mat4(1.0f), {-0.9f, 0.8f, 0}));
    builder.place(builder.add_sphere(0.6f, surface({0.9f, 0.8f, 0.6f}, 0.2f, 1.0f)),
                  glm::translate(glm::mat4(1.0f), {0.8f, 0.6f, 0.5f}));
    shared::Material glow = surface({0, 0, 0});
    glow.emissive = {2.0f, 1.5f, 0.5f};
    builder.place(
        builder.add_quad({{{1.8f, 0, 0}, {2.4f, 0, 0}, {2.4f, 1.2f, 0}, {1.8f, 1.2f, 0}}}, glow));
    builder.add_sun({-0.6f, -1, -0.4f}, glm::vec3(2.5f), 8.0f);
    return builder.build();
  }
  std::array<int, 3> shown(const char* view, std::uint32_t x, std::uint32_t y) {
    const render::Frame frame = *rig_.renderer.capture_view(view);
    const std::uint8_t* texel = &frame.rgba[(std::size_t{y} * views_width + x) * 4];
    return {texel[0], texel[1], texel[2]};
  }

  RendererRig rig_{spheres(), scene::constant_environment(glm::vec3(0.5f, 0.6f, 0.8f)),
                   camera(0.0f), views_width, views_height};
};

TEST_F(Views, EveryBufferIsListedCapturedAndNotBlank) {
  ASSERT_GE(rig_.renderer.buffers().size(), 30u);
  EXPECT_EQ(rig_.renderer.buffers()[0].name, "output");
  for (const render::BufferInfo& buffer : rig_.renderer.buffers()) {
    EXPECT_GT(buffer.description.size(), 15u) << buffer.name;
    EXPECT_EQ(buffer.description.find("Written by the pass"), std::string::npos)
        << buffer.name << " has no description of its own";
    const auto values = rig_.renderer.capture(buffer.name);
    ASSERT_TRUE(values) << buffer.name;
    const bool is_half = values->width == views_width / 2 && values->height == views_height / 2;
    if (!is_half) {
      EXPECT_EQ(values->width, views_width) << buffer.name;
      EXPECT_EQ(values->height, views_height) << buffer.name;
    }
    EXPECT_EQ(is_half, buffer.name.starts_with("indirect.") &&
                           !buffer.name.starts_with("indirect.radiance") &&
                           !buffer.name.starts_with("indirect.upsampled"))
        << buffer.name;
    const auto view = rig_.renderer.capture_view(buffer.name);
    ASSERT_TRUE(view) << buffer.name;
    save_image("buffer_" + buffer.name, *view);
    bool differs = false;
    for (std::size_t i = 4; i < view->rgba.size(); ++i) {
      differs |= view->rgba[i] != view->rgba[i % 4];
    }
    // A static scene has neither motion errors nor rectified shadows, its first frames show none of
    // the mean, and no ambient rays are traced beside indirect light: these views have one color.
    const bool is_black = buffer.name == "gbuffer.motion.error" ||
                          buffer.name == "visibility.history_length.rectified" ||
                          buffer.name == "indirect.history_length.rectified" ||
                          buffer.name == "indirect.half.surface" ||
                          buffer.name == "sampling.plan.ambient" ||
                          buffer.name == "ambient.visibility" || buffer.name == "mean_weight" ||
                          buffer.name == "mean.filtered";
    EXPECT_EQ(differs, !is_black) << buffer.name;
  }
}

TEST_F(Views, StreamedViewEqualsCapturedView) {
  for (const char* name : {"gbuffer.normals.geometric", "gbuffer.motion.view_z", "hdr"}) {
    protocol::Settings settings;
    settings.view.buffer = name;
    rig_.apply(settings);
    const render::Frame streamed = rig_.renderer.render();
    EXPECT_EQ(streamed.rgba, rig_.renderer.capture_view(name)->rgba) << name;
  }
  protocol::Settings settings;
  settings.view.buffer = "gbuffer.motion.nothing";
  EXPECT_FALSE(rig_.renderer.set_settings(settings));
  EXPECT_FALSE(rig_.renderer.capture("no such buffer"));
}

TEST_F(Views, RejectedBufferNameKeepsHistory) {
  rig_.renderer.render();
  const render::Frame before = rig_.renderer.render();
  protocol::Settings settings;
  settings.specular.enabled = false;  // changes the passes and buffers
  settings.view.buffer = "specular.nothing";
  const auto refused = rig_.renderer.set_settings(settings);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().path, "view.buffer");
  EXPECT_EQ(rig_.renderer.render().samples, before.samples + 1);
}

TEST_F(Views, OutputReplacesBufferThatSettingsDisable) {
  protocol::Settings settings;
  settings.specular.enabled = false;
  settings.view.buffer = "specular.radiance";
  settings.exposure.compensation = 3.0f;
  rig_.apply(settings);
  const render::Frame bright = rig_.renderer.render();
  EXPECT_EQ(bright.rgba, rig_.renderer.capture_view("output")->rgba);
  settings.exposure.compensation = 0.0f;
  rig_.apply(settings);
  EXPECT_NE(rig_.renderer.render().rgba, bright.rgba) << "exposure must not be applied";
  settings.specular.enabled = true;
  rig_.apply(settings);
  const render::Frame back = rig_.renderer.render();
  EXPECT_EQ(back.rgba, rig_.renderer.capture_view("specular.radiance")->rgba);
}

/// Settings that together create every buffer.
std::vector<protocol::Settings> settings_for_all_buffers() {
  std::vector<protocol::Settings> all(5);
  all[0].reference.use = protocol::ReferenceUse::always;
  all[1].specular.half_resolution = true;
  all[1].shadow_blur.kernel = all[1].specular_blur.kernel = protocol::BlurKernel::full;
  all[3].shadow_blur.half_resolution = all[4].shadow_blur.half_resolution = true;
  all[3].shadow_blur.iterations = all[4].shadow_blur.iterations = 4;
  all[4].shadow_blur.kernel = protocol::BlurKernel::full;
  all[4].lens.depth_of_field = true;
  all[2].indirect.enabled = all[3].indirect.enabled = true;
  all[3].indirect_blur.kernel = protocol::BlurKernel::full;
  for (const char* assignment :
       {"reference.use=when_static", "reinhard.mode=exact",
        "shadow_temporal.rectification=percentile", "specular_temporal.rectification=percentile",
        "indirect_temporal.rectification=percentile", "shadow_blur.feedback=1",
        "specular_blur.feedback=1"}) {
    EXPECT_TRUE(protocol::set_by_path(all[2], assignment)) << assignment;
  }
  return all;
}

TEST(BufferNames, MatchBuffersOfAllSettings) {
  SceneBuilder builder;
  shared::Material glass = surface({0.5f, 0.7f, 0.5f}, 0.1f);
  glass.base_color.w = 0.4f;
  glass.flags = shared::material_alpha_blend;
  builder.place(builder.add_sphere(1.0f, surface(glm::vec3(0.5f))));
  builder.place(builder.add_quad({{{-1, -1, 2}, {1, -1, 2}, {1, 1, 2}, {-1, 1, 2}}}, glass));
  RendererRig rig(builder.build(), scene::constant_environment(glm::vec3(1.0f)),
                  look({0, 0, 5}, {0, 0, 0}), 32, 18);
  std::set<std::string> created;
  for (const protocol::Settings& settings : settings_for_all_buffers()) {
    rig.apply(settings);
    for (const render::BufferInfo& buffer : rig.renderer.buffers()) created.insert(buffer.name);
  }
  const std::vector<std::string>& names = render::buffer_names();
  std::set<std::string> expected(names.begin(), names.end());
  // Host kernels filter both halves of an iteration at once, and read slopes as the G-buffer has
  // them.
  const render::Engine::Parts& parts = engine("auto").parts();
  if (parts.host_kernels && parts.device.is_cpu()) {
    for (const char* name : {"visibility.blur.half", "visibility.half.blur.half",
                             "specular.blur.half", "indirect.blur.half", "reproject.slope",
                             "indirect.reproject.slope", "visibility.half.slope"}) {
      expected.erase(name);
    }
  }
  EXPECT_EQ(created, expected);
}

TEST_F(Views, ShowKnownValuesInKnownColors) {
  // Near the center of the metal sphere; the bottom row is ground, the top row sky.
  const std::uint32_t x = 96, y = 56;
  EXPECT_EQ(shown("gbuffer.surface.metallic", x, y), (std::array{253, 231, 37})) << "1: yellow";
  EXPECT_EQ(shown("gbuffer.surface.metallic", x, views_height - 1), (std::array{68, 1, 84})) << "0";
  EXPECT_EQ(shown("gbuffer.normals", 20, views_height - 1), (std::array{128, 255, 128}))
      << "upward";
  EXPECT_EQ(shown("gbuffer.normals", 20, 0), (std::array{0, 0, 0})) << "background";
  EXPECT_EQ(shown("gbuffer.motion.view_z", 20, 0), (std::array{0, 0, 0})) << "background";
  const render::FloatImage depth = rig_.capture("gbuffer.motion.view_z");
  EXPECT_NEAR(rgb(depth, x, y).x, 4.0f, 0.7f) << "metres";
}

// +Z is the center of the octahedral map and must not be taken for "no surface".
TEST(NormalsView, SurfaceFacingZIsNotBlack) {
  for (const auto source :
       {protocol::PrimaryVisibility::raster, protocol::PrimaryVisibility::rays}) {
    SceneBuilder builder;
    builder.place(builder.add_quad({{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}},
                                   surface(glm::vec3(0.5f))));
    RendererRig rig(builder.build(), scene::constant_environment(glm::vec3(1.0f)),
                    look({0, 0, 4}, {0, 0, 0}), 32, 18);
    protocol::Settings settings;
    settings.gbuffer.source = source;
    rig.apply(settings);
    rig.renderer.render();
    for (const char* view : {"gbuffer.normals", "gbuffer.normals.geometric"}) {
      const render::Frame frame = *rig.renderer.capture_view(view);
      const std::uint8_t* middle = &frame.rgba[(std::size_t{9} * 32 + 16) * 4];
      EXPECT_EQ((std::array{middle[0], middle[1], middle[2]}),
                (std::array<std::uint8_t, 3>{128, 128, 255}))
          << view;
      EXPECT_EQ((std::array{frame.rgba[0], frame.rgba[1], frame.rgba[2]}),
                (std::array<std::uint8_t, 3>{0, 0, 0}))
          << view << " of the sky";
    }
  }
}

TEST_F(Views, MotionOfStaticSceneHasNoError) {
  const render::FloatImage motion = rig_.capture("gbuffer.motion");
  const render::FloatImage error = rig_.capture("gbuffer.motion.error");
  float fastest = 0.0f, largest = 0.0f;
  for (std::size_t i = 0; i < error.rgba.size(); i += 4) {
    fastest = std::max(fastest, std::abs(motion.rgba[i]) * views_width);
    largest = std::max(largest, error.rgba[i]);
  }
  EXPECT_GT(fastest, 0.5f) << "pixels";
  EXPECT_LT(largest, 0.02f) << "pixels";
}

TEST_F(Views, SurfacesArePickedFromFramesThatKeepNoBuffers) {
  rig_.renderer.keep_buffers(false);
  for (const auto source :
       {protocol::PrimaryVisibility::automatic, protocol::PrimaryVisibility::rays,
        protocol::PrimaryVisibility::raster}) {
    protocol::Settings settings;
    settings.gbuffer.source = source;
    rig_.apply(settings);
    rig_.renderer.render();
    // On GPUs images share no memory: all are there after a static view's frame.
    if (device().is_cpu()) {
      EXPECT_FALSE(rig_.renderer.has_buffers());
    }
    const auto picked = rig_.renderer.pick({0.5f, 0.8f});
    ASSERT_TRUE(picked) << protocol::enum_name(source) << ": " << picked.error().message;
    EXPECT_TRUE(*picked) << protocol::enum_name(source);
  }
}

}  // namespace
}  // namespace heliograph::test
