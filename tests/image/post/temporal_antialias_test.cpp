#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/image/support/renderer_rig.hpp"

namespace heliograph::test {
namespace {

constexpr std::uint32_t antialias_width = 96, antialias_height = 64;

/// Thin bars of many slopes and a sphere's outline in front of a bright sky, without noise.
std::shared_ptr<const scene::Scene> edges() {
  SceneBuilder builder;
  builder.place(builder.add_sphere(0.7f, surface({0.9f, 0.3f, 0.1f})),
                glm::translate(glm::mat4(1.0f), {-0.7f, 0.3f, 0}));
  const auto bar =
      builder.add_quad({{{-1.5f, 0, 0}, {1.5f, 0, 0}, {1.5f, 0.03f, 0}, {-1.5f, 0.03f, 0}}},
                       surface({0.1f, 0.1f, 0.1f}));
  for (int i = 0; i < 8; ++i) {
    const float angle = 0.3f * static_cast<float>(i);
    builder.place(bar, glm::rotate(glm::translate(glm::mat4(1.0f), {0.8f, -0.4f, 0.2f}), angle,
                                   glm::vec3(0, 0, 1)));
  }
  return builder.build();
}

protocol::Settings without_noise() {
  protocol::Settings settings;
  settings.indirect.enabled = false;
  settings.shadows.enabled = false;
  settings.specular.enabled = false;
  settings.ambient.occlusion = false;
  settings.accumulation.max_samples = 4096;
  settings.accumulation.by_noise = false;
  settings.accumulation.blend_samples = 4096;  // shows the antialiased frame
  return settings;
}

/// The edges in front of a bright sky.
class Edges : public RendererRig {
 public:
  explicit Edges(const scene::Camera& camera)
      : RendererRig(edges(), make_environment(64, sky), camera, antialias_width, antialias_height) {
    apply(without_noise());
  }

 private:
  static glm::vec3 sky(const glm::vec3& d) {
    return glm::vec3(0.4f, 0.6f, 1.0f) * (1.0f + 0.8f * d.y);
  }
};

double mean_square(const render::FloatImage& a, const render::FloatImage& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) {
    if (i % 4 < 3) sum += std::pow(a.rgba[i] - b.rgba[i], 2);
  }
  return sum / static_cast<double>(a.rgba.size() / 4 * 3);
}

// Motion vectors that contain the jitter would make the image drift or shimmer.
TEST(TemporalAntialias, JitteredStaticViewConvergesToGroundTruth) {
  const scene::Camera camera = look({0, 0, 3}, {0, 0, 0});
  Edges rig(camera);
  rig.accumulate(200);
  double resolved = 0.0, raw = 0.0, change = 0.0, raw_change = 0.0;
  render::FloatImage before = rig.capture("temporal_antialias"), raw_before = rig.capture("hdr");
  for (int i = 0; i < 16; ++i) {
    save_image("antialiased", rig.renderer.render());
    const render::FloatImage reference = rig.capture("accumulated");
    const render::FloatImage now = rig.capture("temporal_antialias"), sample = rig.capture("hdr");
    resolved += mean_square(reference, now);
    raw += mean_square(reference, sample);
    change += mean_square(before, now);
    raw_change += mean_square(raw_before, sample);
    before = now;
    raw_before = sample;
  }
  RecordProperty("error", std::to_string(resolved / raw));
  EXPECT_GT(raw_change, 0.0) << "unfiltered frames must be jittered";
  EXPECT_LT(resolved, 0.25 * raw) << "closer to 200 samples than one sample is";
  EXPECT_LT(change, 0.02 * raw_change) << "almost constant";
}

// What is drawn smaller: the samples of many frames give the image of the full size.
TEST(TemporalAntialias, ReconstructedStaticViewConvergesToGroundTruth) {
  const scene::Camera camera = look({0, 0, 3}, {0, 0, 0});
  Edges full(camera);
  full.accumulate(200);
  const render::FloatImage reference = full.capture("accumulated");
  const double raw = mean_square(reference, full.capture("hdr"));
  for (const float scale : {0.8f, 0.67f, 0.5f}) {
    Edges rig(camera);
    rig.renderer.set_draw_scale(scale);
    rig.accumulate(100);
    const render::Frame frame = rig.renderer.render();
    EXPECT_EQ(frame.width, antialias_width);
    EXPECT_EQ(frame.height, antialias_height);
    save_image("reconstructed", frame);
    const render::FloatImage drawn = rig.capture("hdr");
    EXPECT_EQ(drawn.width, static_cast<std::uint32_t>(std::lround(scale * antialias_width)));
    EXPECT_LT(mean_square(reference, rig.capture("temporal_antialias")), 0.5 * raw) << scale;
  }
}

// Without antialiasing there is nothing to reconstruct from.
TEST(TemporalAntialias, SmallerFramesWithoutItShowTheNearestPixels) {
  const scene::Camera camera = look({0, 0, 3}, {0, 0, 0});
  protocol::Settings settings = without_noise();
  settings.antialiasing.temporal = settings.antialiasing.jitter = false;
  Edges small(camera), rig(camera);
  small.apply(settings);
  rig.apply(settings);
  small.renderer.set_size(antialias_width / 2, antialias_height / 2);
  rig.renderer.set_draw_scale(0.5f);
  const render::Frame drawn = small.renderer.render(), frame = rig.renderer.render();
  ASSERT_EQ(frame.width, antialias_width);
  ASSERT_EQ(frame.height, antialias_height);
  for (std::uint32_t y = 0; y < frame.height; ++y) {
    for (std::uint32_t x = 0; x < frame.width; ++x) {
      for (std::uint32_t c = 0; c < 3; ++c) {
        const int expected = drawn.rgba[(y / 2 * drawn.width + x / 2) * 4 + c];
        EXPECT_NEAR(frame.rgba[(y * frame.width + x) * 4 + c], expected, 1) << x << ", " << y;
      }
    }
  }
}

TEST(TemporalAntialias, PointsOfSmallerFramesAreTheSameSurfaces) {
  const scene::Camera camera = look({0, 0, 3}, {0, 0, 0});
  Edges full(camera), rig(camera);
  rig.renderer.set_draw_scale(0.5f);
  full.renderer.render();
  rig.renderer.render();
  const glm::vec2 point(0.35f, 0.4f);  // on the sphere
  const auto expected = full.renderer.pick(point), found = rig.renderer.pick(point);
  ASSERT_TRUE(expected && *expected && found && *found);
  EXPECT_EQ((*found)->instance, (*expected)->instance);
  EXPECT_LT(glm::distance((*found)->position, (*expected)->position), 0.05f);
  EXPECT_EQ(rig.renderer.inspect(point).size(), full.renderer.inspect(point).size());
}

// The end of motion: full size continues what was reconstructed, in the denoisers too.
TEST(TemporalAntialias, HistoriesOutliveAChangeOfTheDrawScale) {
  const scene::Camera camera = look({0, 0, 3}, {0, 0, 0});
  Edges rig(camera);
  protocol::Settings settings = without_noise();
  settings.shadows.enabled = settings.ambient.occlusion = settings.specular.enabled = true;
  rig.apply(settings);
  rig.renderer.set_draw_scale(0.67f);
  for (int i = 0; i < 24; ++i) rig.renderer.render();
  const render::FloatImage before = rig.capture("temporal_antialias");
  rig.renderer.set_draw_scale(1.0f);
  rig.renderer.render();
  const double jump = mean_square(before, rig.capture("temporal_antialias"));
  Edges fresh(camera);
  fresh.apply(settings);
  fresh.renderer.render();
  EXPECT_LT(jump, 0.1 * mean_square(before, fresh.capture("temporal_antialias")));
}

TEST(TemporalAntialias, StaticViewWithoutJitterIsConstant) {
  Edges rig(look({0, 0, 3}, {0, 0, 0}));
  protocol::Settings settings = without_noise();
  settings.antialiasing.jitter = false;
  rig.apply(settings);
  rig.accumulate(30);
  const render::FloatImage before = rig.capture("temporal_antialias");
  rig.renderer.render();
  const double change = difference(before, rig.capture("temporal_antialias")).maximum;
  EXPECT_LT(change, 2e-3) << "history is offset from the frame";
}

TEST(TemporalAntialias, MovingEdgesAreBetterThanOneSample) {
  for (const auto& [name, step] : {std::pair("yaw", glm::vec3(0.02f, 0, 0)),
                                   {"pitch", glm::vec3(0, 0.02f, 0)},
                                   {"dolly", glm::vec3(0, 0, -0.03f)}}) {
    glm::vec3 eye(0, 0, 3), target(0, 0, 0);
    const bool turns = step.z == 0.0f;
    Edges moving(look(eye, target));
    for (int i = 0; i < 24; ++i) {
      (turns ? target : eye) += step;
      moving.renderer.set_camera(look(eye, target));
      moving.renderer.render();
    }
    Edges reference(look(eye, target));
    reference.accumulate(128);
    const render::FloatImage expected = reference.capture("accumulated");
    const double resolved = mean_square(expected, moving.capture("temporal_antialias"));
    const double raw = mean_square(expected, moving.capture("hdr"));
    EXPECT_LT(resolved, 0.75 * raw) << name << ": " << resolved << " " << raw;
    save_image(std::string("antialias_") + name,
               *moving.renderer.capture_view("temporal_antialias"));
  }
}

// The output frame: the weight of the accumulated mean grows until the frame is constant.
TEST(AccumulationBlend, StaticViewConverges) {
  SceneBuilder builder;
  builder.place(builder.add_quad({{{-3, -0.7f, 3}, {3, -0.7f, 3}, {3, -0.7f, -3}, {-3, -0.7f, -3}}},
                                 surface({0.6f, 0.6f, 0.5f})));
  builder.place(builder.add_sphere(0.6f, surface({0.8f, 0.3f, 0.2f}, 0.5f)));
  builder.add_sun({-0.5f, -1, -0.3f}, glm::vec3(2.0f), 6.0f);
  RendererRig rig(builder.build(), scene::constant_environment(glm::vec3(0.4f)),
                  look({0, 0.6f, 3}, {0, 0, 0}), antialias_width, antialias_height);
  protocol::Settings settings;
  settings.accumulation.max_samples = 512;
  settings.accumulation.by_noise = false;
  settings.accumulation.blend_samples = 16;
  rig.apply(settings);
  const auto change_after = [&](std::uint32_t samples) {
    const render::Frame before = rig.accumulate(samples);
    double sum = 0.0;
    render::Frame last = before;
    for (int i = 0; i < 4; ++i) {
      const render::Frame next = rig.renderer.render();
      sum += difference(last, next).mean;
      last = next;
    }
    return sum / 4.0;
  };
  const double early = change_after(2), middle = change_after(48), late = change_after(400);
  RecordProperty("code_values",
                 std::to_string(early) + " " + std::to_string(middle) + " " + std::to_string(late));
  EXPECT_LT(middle, 0.5 * early);
  EXPECT_LT(late, 0.25 * middle);
  EXPECT_LT(late, 0.04) << "code values";
}

TEST(AccumulationBlend, ZeroShowsMeanAndMotionShowsFrame) {
  Edges rig(look({0, 0, 3}, {0, 0, 0}));
  protocol::Settings settings = without_noise();
  settings.tone_map.curve = protocol::ToneMapCurve::linear;
  const auto shown_is = [&](const char* buffer) {
    const render::FloatImage radiance = rig.capture(buffer);
    const render::FloatImage shown = rig.capture("output");
    double largest = 0.0;
    for (std::size_t i = 0; i < shown.rgba.size(); ++i) {
      if (i % 4 == 3) continue;
      const double c = std::min(radiance.rgba[i], 1.0f);
      const double encoded = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
      largest = std::max(largest, std::abs(encoded - shown.rgba[i]));
    }
    return largest < 1.5 / 255.0;
  };
  settings.accumulation.blend_samples = 0;
  rig.apply(settings);
  rig.accumulate(7);
  EXPECT_TRUE(shown_is("accumulated"));
  EXPECT_FALSE(shown_is("temporal_antialias"));
  settings.accumulation.blend_samples = 4;
  rig.apply(settings);
  for (int i = 0; i < 5; ++i) {
    rig.renderer.set_camera(look({0.05f * static_cast<float>(i), 0, 3}, {0, 0, 0}));
    rig.renderer.render();
  }
  EXPECT_TRUE(shown_is("temporal_antialias"));
  EXPECT_FALSE(shown_is("accumulated"));
}

}  // namespace
}  // namespace heliograph::test
