#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "tests/image/support/renderer_rig.hpp"
#include "tracing/tracer_choice.hpp"

namespace heliograph::test {
namespace {

constexpr std::uint32_t accumulation_width = 160, accumulation_height = 90;

/// SpheresRig on a ground under a soft sun and a grey sky, with noise of every kind.
std::shared_ptr<const scene::Scene> spheres() {
  SceneBuilder builder;
  builder.place(builder.add_quad({{{-9, 0, 9}, {9, 0, 9}, {9, 0, -9}, {-9, 0, -9}}},
                                 surface({0.6f, 0.55f, 0.5f})));
  builder.place(builder.add_sphere(0.8f, surface({0.8f, 0.2f, 0.1f}, 0.4f)),
                glm::translate(glm::mat4(1.0f), {-0.9f, 0.8f, 0}));
  builder.place(builder.add_sphere(0.6f, surface({0.9f, 0.8f, 0.6f}, 0.2f, 1.0f)),
                glm::translate(glm::mat4(1.0f), {0.8f, 0.6f, 0.5f}));
  builder.add_sun({-0.6f, -1, -0.4f}, glm::vec3(2.5f), 8.0f);
  builder.add_point_light({1.5f, 2, 1}, {2, 1, 0.5f}, 0.2f);
  return builder.build();
}

/// On GPUs cells of the radiance cache depend on the order of threads.
protocol::Settings deterministic() {
  protocol::Settings settings;
  settings.indirect.enabled = device().is_cpu();
  return settings;
}

RendererRig make(const std::string& tracer = "auto") {
  return RendererRig(spheres(), scene::constant_environment(glm::vec3(0.5f, 0.6f, 0.8f)),
                     look({0.5f, 2, 4.5f}, {0, 0.5f, 0}), accumulation_width, accumulation_height,
                     tracer);
}

TEST(Accumulation, ErrorDecreasesWithSampleCount) {
  RendererRig reference = make();
  protocol::Settings settings;
  settings.accumulation.max_samples = 256;
  settings.sampling.seed = 99;
  reference.apply(settings);
  const render::Frame expected = reference.accumulate(256);
  save_image("spheres", expected);

  RendererRig rig = make();
  double before = 1e9;
  for (const std::uint32_t samples : {1u, 4u, 16u, 64u}) {
    const double error = difference(expected, rig.accumulate(samples)).mean;
    // Independent samples would halve the error. Spatial filtering helps the first frame most.
    EXPECT_LT(error, (samples == 4u ? 0.78 : 0.72) * before) << samples;
    before = error;
  }
  EXPECT_LT(before, 0.8) << "code values";
}

TEST(Accumulation, StopsWhenConvergedAndResumesOnChange) {
  RendererRig rig = make();
  protocol::Settings settings;
  settings.accumulation.max_samples = 5;
  rig.apply(settings);
  for (std::uint32_t i = 1; i <= 5; ++i) {
    EXPECT_TRUE(rig.renderer.needs_frame());
    const render::Frame frame = rig.renderer.render();
    EXPECT_EQ(frame.samples, i);
    EXPECT_EQ(frame.converged, i == 5);
  }
  EXPECT_FALSE(rig.renderer.needs_frame());
  rig.renderer.set_camera(look({0.5f, 2, 4.5f}, {0, 0.5f, 0}));
  rig.apply(settings);
  rig.renderer.set_size(accumulation_width, accumulation_height);
  EXPECT_FALSE(rig.renderer.needs_frame()) << "nothing changed";

  settings.exposure.compensation = 1.0f;
  rig.apply(settings);
  EXPECT_TRUE(rig.renderer.needs_frame());
  EXPECT_GE(rig.renderer.render().samples, 5u) << "exposure must not reset accumulation";
  EXPECT_FALSE(rig.renderer.needs_frame());

  settings.lighting.direct = false;
  rig.apply(settings);
  EXPECT_EQ(rig.renderer.render().samples, 1u) << "lighting must reset accumulation";
  rig.accumulate(5);
  rig.renderer.set_camera(look({0.6f, 2, 4.5f}, {0, 0.5f, 0}));
  EXPECT_TRUE(rig.renderer.needs_frame());
  EXPECT_EQ(rig.renderer.render().samples, 1u);
}

TEST(Accumulation, CameraMoveResetsAccumulation) {
  RendererRig moved = make(), fresh = make();
  for (RendererRig* const rig : {&moved, &fresh}) rig->apply(deterministic());
  moved.renderer.set_camera(look({-3, 1, 3}, {0, 0.5f, 0}));
  moved.accumulate(10);
  moved.renderer.set_camera(look({0.5f, 2, 4.5f}, {0, 0.5f, 0}));
  moved.renderer.invalidate_history();
  EXPECT_EQ(moved.accumulate(1).rgba, fresh.accumulate(1).rgba);
  moved.renderer.set_size(80, 45);
  moved.renderer.render();
  moved.renderer.set_size(accumulation_width, accumulation_height);
  EXPECT_EQ(moved.accumulate(3).rgba, fresh.accumulate(3).rgba);
}

TEST(Determinism, SeedDeterminesEveryByte) {
  for (const std::string& tracer : supported_tracers()) {
    RendererRig a = make(tracer), b = make(tracer), other = make(tracer);
    protocol::Settings settings = deterministic();
    settings.sampling.seed = 7;
    a.apply(settings);
    b.apply(settings);
    settings.sampling.seed = 8;
    other.apply(settings);
    const render::Frame frame = a.accumulate(6);
    EXPECT_EQ(frame.rgba, b.accumulate(6).rgba) << tracer;
    EXPECT_NE(frame.rgba, other.accumulate(6).rgba) << tracer;
  }
}

TEST(CanceledFrame, LeavesTheNextFramesAsTheyWouldHaveBeen) {
  if (!device().is_cpu()) GTEST_SKIP() << "frames are canceled on CPU devices only";
  RendererRig whole = make(), interrupted = make();
  for (int frame = 0; frame < 4; ++frame) {
    const auto turn = [&](RendererRig& rig) {
      rig.renderer.set_camera(
          look({0.5f + 0.05f * static_cast<float>(frame), 2, 4.5f}, {0, 0.5f, 0}));
    };
    turn(whole);
    for (const int passes : {0, 3, 25}) {
      int asked = 0;
      EXPECT_FALSE(interrupted.renderer.render([&] { return asked++ == passes; }));
    }
    turn(interrupted);
    EXPECT_TRUE(interrupted.renderer.needs_frame());
    const render::Frame expected = whole.renderer.render();
    EXPECT_EQ(interrupted.renderer.render().rgba, expected.rgba) << "frame " << frame;
  }
}

TEST(Tracers, ProduceNearlyEqualImages) {
  // The radiance cache makes more of differences than there are.
  protocol::Settings settings;
  settings.indirect.enabled = false;
  RendererRig first = make();
  first.apply(settings);
  const render::Frame expected = first.accumulate(16);
  for (const std::string& name : supported_tracers()) {
    RendererRig rig = make(name);
    rig.apply(settings);
    EXPECT_EQ(protocol::enum_name(engine(name).tracer()), name);
    const render::Frame actual = rig.accumulate(16);
    save_image("spheres_" + name, actual);
    expect_similar("tracers_" + name, expected, actual, 0.02, 0.9995);
  }
}

TEST(Shadows, OnlyDarkenAndOnlyIfEnabled) {
  RendererRig rig = make();
  rig.accumulate(32);
  const render::FloatImage with = rig.capture("accumulated");
  protocol::Settings settings;
  settings.shadows.enabled = false;
  rig.apply(settings);
  rig.renderer.invalidate_history();  // same sample positions
  save_image("spheres_without_shadows", rig.accumulate(32));
  const render::FloatImage without = rig.capture("accumulated");
  EXPECT_LT(mean_luminance(with), 0.99 * mean_luminance(without));
  int darker = 0;
  for (std::size_t i = 0; i < with.rgba.size(); i += 4) {
    EXPECT_LE(with.rgba[i], without.rgba[i] + 0.02f * without.rgba[i] + 0.02f) << i;
    darker += with.rgba[i] < 0.7f * without.rgba[i];
  }
  EXPECT_GT(darker, 300) << "pixels in shadow";
}

TEST(Settings, EachLightingSwitchRemovesLight) {
  RendererRig rig = make();
  rig.accumulate(4);
  const double all = mean_luminance(rig.capture("accumulated"));
  const auto without = [&](auto change) {
    protocol::Settings settings;
    change(settings);
    rig.apply(settings);
    rig.accumulate(4);
    return mean_luminance(rig.capture("accumulated"));
  };
  EXPECT_LT(without([](auto& s) { s.lighting.direct = false; }), 0.9 * all);
  EXPECT_LT(without([](auto& s) { s.lighting.environment_diffuse = false; }), 0.9 * all);
  EXPECT_LT(without([](auto& s) { s.lighting.environment_specular = false; }), 0.995 * all);
  EXPECT_LT(without([](auto& s) { s.environment.visible = false; }), 0.95 * all);
  EXPECT_GT(without([](auto& s) { s.ambient.occlusion = false; }), all);
  EXPECT_GT(without([](auto& s) { s.environment.intensity = 2.0f; }), 1.2 * all);
}

}  // namespace
}  // namespace heliograph::test
