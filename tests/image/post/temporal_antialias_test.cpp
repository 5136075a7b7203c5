#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/image/support/scene_renderer.hpp"

namespace heliograph::test {
namespace {

constexpr std::uint32_t width = 96, height = 64;

/// Edges of every slope, thin bars and a curved outline in front of a bright sky; nothing is noisy.
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
  settings.shadows.enabled = false;
  settings.specular.enabled = false;
  settings.ambient.occlusion = false;
  settings.accumulation.max_samples = 4096;
  settings.accumulation.blend_samples = 4096;  // what is shown is the filtered frame
  return settings;
}

/// The edges in front of a bright sky.
class Edges : public Still {
 public:
  explicit Edges(const scene::Camera& camera)
      : Still(edges(), make_environment(64, sky), camera, width, height) {
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

// Motion that still held the jitter would make the picture creep or shimmer for ever.
TEST(Antialias, AJitteredPictureThatStandsStillSettlesOnTheTruth) {
  const scene::Camera camera = look({0, 0, 3}, {0, 0, 0});
  Edges still(camera);
  still.accumulate(200);
  double resolved = 0.0, raw = 0.0, change = 0.0, raw_change = 0.0;
  render::FloatImage before = still.capture("antialiased"), raw_before = still.capture("hdr");
  for (int i = 0; i < 16; ++i) {
    save_picture("antialiased", still.renderer.render());
    const render::FloatImage truth = still.capture("accumulated");
    const render::FloatImage now = still.capture("antialiased"), sample = still.capture("hdr");
    resolved += mean_square(truth, now);
    raw += mean_square(truth, sample);
    change += mean_square(before, now);
    raw_change += mean_square(raw_before, sample);
    before = now;
    raw_before = sample;
  }
  RecordProperty("error", std::to_string(resolved / raw));
  EXPECT_GT(raw_change, 0.0) << "the frames themselves are jittered";
  EXPECT_LT(resolved, 0.25 * raw) << "nearer to 200 samples than one is";
  EXPECT_LT(change, 0.02 * raw_change) << "and almost still";
}

TEST(Antialias, WithoutJitterAStillPictureStandsStill) {
  Edges still(look({0, 0, 3}, {0, 0, 0}));
  protocol::Settings settings = without_noise();
  settings.antialiasing.jitter = false;
  still.apply(settings);
  still.accumulate(30);
  const render::FloatImage before = still.capture("antialiased");
  still.renderer.render();
  const double change = difference(before, still.capture("antialiased")).maximum;
  EXPECT_LT(change, 2e-3) << "the history is where the frame is: not a fraction of a pixel beside";
}

TEST(Antialias, EdgesAreBetterThanOneSampleWhileTheCameraMoves) {
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
    Edges resting(look(eye, target));
    resting.accumulate(128);
    const render::FloatImage truth = resting.capture("accumulated");
    const double resolved = mean_square(truth, moving.capture("antialiased"));
    const double raw = mean_square(truth, moving.capture("hdr"));
    EXPECT_LT(resolved, 0.75 * raw) << name << ": " << resolved << " " << raw;
    save_picture(std::string("antialias_") + name, *moving.renderer.capture_view("antialiased"));
  }
}

// The whole picture, as streamed: the share of the mean grows until nothing changes any more.
TEST(Handover, FramesOfAStillViewDifferLessAndLess) {
  SceneBuilder builder;
  builder.place(builder.add_quad({{{-3, -0.7f, 3}, {3, -0.7f, 3}, {3, -0.7f, -3}, {-3, -0.7f, -3}}},
                                 surface({0.6f, 0.6f, 0.5f})));
  builder.place(builder.add_sphere(0.6f, surface({0.8f, 0.3f, 0.2f}, 0.5f)));
  builder.add_sun({-0.5f, -1, -0.3f}, glm::vec3(2.0f), 6.0f);
  Still still(builder.build(), scene::constant_environment(glm::vec3(0.4f)),
              look({0, 0.6f, 3}, {0, 0, 0}), width, height);
  protocol::Settings settings;
  settings.accumulation.max_samples = 512;
  settings.accumulation.blend_samples = 16;
  still.apply(settings);
  const auto change_after = [&](std::uint32_t samples) {
    const render::Frame before = still.accumulate(samples);
    double sum = 0.0;
    render::Frame last = before;
    for (int i = 0; i < 4; ++i) {
      const render::Frame next = still.renderer.render();
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

TEST(Handover, ZeroShowsTheMeanAloneAndAMovingPictureNoneOfIt) {
  Edges still(look({0, 0, 3}, {0, 0, 0}));
  protocol::Settings settings = without_noise();
  settings.tone_map.curve = protocol::ToneMapCurve::linear;
  const auto shown_is = [&](const char* buffer) {
    const render::FloatImage radiance = still.capture(buffer);
    const render::FloatImage shown = still.capture("output");
    double worst = 0.0;
    for (std::size_t i = 0; i < shown.rgba.size(); ++i) {
      if (i % 4 == 3) continue;
      const double c = std::min(radiance.rgba[i], 1.0f);
      const double encoded = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
      worst = std::max(worst, std::abs(encoded - shown.rgba[i]));
    }
    return worst < 1.5 / 255.0;
  };
  settings.accumulation.blend_samples = 0;
  still.apply(settings);
  still.accumulate(7);
  EXPECT_TRUE(shown_is("accumulated"));
  EXPECT_FALSE(shown_is("antialiased"));
  settings.accumulation.blend_samples = 4;
  still.apply(settings);
  for (int i = 0; i < 5; ++i) {
    still.renderer.set_camera(look({0.05f * static_cast<float>(i), 0, 3}, {0, 0, 0}));
    still.renderer.render();
  }
  EXPECT_TRUE(shown_is("antialiased"));
  EXPECT_FALSE(shown_is("accumulated"));
}

}  // namespace
}  // namespace heliograph::test
