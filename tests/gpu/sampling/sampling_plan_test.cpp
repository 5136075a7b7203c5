#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/packing.hpp>
#include <optional>

#include "render/passes/sampling/plan_samples.hpp"
#include "tests/gpu/support/kernel_comparison.hpp"

namespace heliograph::test {
namespace {

constexpr VkExtent2D extent{61, 37};
constexpr std::size_t pixels = std::size_t{extent.width} * extent.height;

/// What a frame knows of its pixels, the same for all unless a test fills it otherwise.
struct History {
  float frames = 100.0f;
  float variance = 1.0f;  // of single samples, of visibility
  float roughness = 0.35f;
  float ambient = 0.5f;
  float metallic = 0.0f;
  bool known = true;
};

std::uint32_t packed_surface(const History& history) {
  const auto byte = [](float value) { return std::uint32_t(std::lround(255.0f * value)); };
  return byte(history.roughness) | byte(history.metallic) << 8;
}

/// The plan of frames whose histories are given, by the host kernel or the shader.
class PlannedFrames {
 public:
  explicit PlannedFrames(bool host = has_host_kernels(),
                         const protocol::Settings& settings = without_indirect())
      : rig_(SceneBuilder().build(), camera_, {.extent = extent, .settings = settings}) {
    render::GBuffer gbuffer{};
    gbuffer.surface = surface_;
    const render::PreviousSamples previous{visibility_length_, specular_length_, specular_distance_,
                                           visibility_};
    const render::Guide guide{reprojection_, reprojection_};
    planned_ =
        render::plan_samples(rig_.plan(), with_host_kernels(rig_, host), gbuffer, guide, previous);
    rig_.set_scene_motion({});
  }

  FrameRig& rig() { return rig_; }

  template <class HistoryOfPixel>
  void set(const HistoryOfPixel& history_of) {
    std::vector<glm::vec4> reprojection(pixels);
    std::vector<std::uint64_t> lengths(pixels), distance(pixels), noise(pixels);
    std::vector<std::uint32_t> surface(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
      const History history = history_of(i);
      const auto x = static_cast<float>(i % extent.width), y = static_cast<float>(i / extent.width);
      reprojection[i] = {x + 0.6f, y + 0.7f, history.known ? 15.0f : 0.0f, 0.0f};
      lengths[i] = glm::packHalf4x16(glm::vec4(history.frames));
      distance[i] = glm::packHalf4x16(glm::vec4(0.0f, 0.0f, 0.0f, 1.5f));
      const float of_mean = history.variance / history.frames;
      noise[i] = glm::packUnorm4x16(glm::vec4(0.5f, history.ambient, of_mean, of_mean));
      surface[i] = packed_surface(history);
    }
    rig_.fill(reprojection_, reprojection);
    rig_.fill(visibility_length_, lengths);
    rig_.fill(specular_length_, lengths);
    rig_.fill(specular_distance_, distance);
    rig_.fill(visibility_, noise);
    rig_.fill(surface_, surface);
  }
  void set(const History& history) {
    set([&](std::size_t) { return history; });
  }

  /// Words of one frame; the first frame of a rig has none before it.
  std::vector<std::uint32_t> run(std::uint32_t frame) {
    if (!started_) rig_.set_view(camera_, 0);
    started_ = true;
    rig_.set_view(camera_, frame);
    rig_.run();
    const render::FloatImage image = rig_.read(planned_);
    std::vector<std::uint32_t> words(pixels);
    for (std::size_t i = 0; i < pixels; ++i) words[i] = std::uint32_t(image.rgba[4 * i]);
    return words;
  }

  /// Fractions of the pixels that trace shadow, ambient and specular rays in 64 frames.
  glm::dvec3 rates() {
    glm::dvec3 sum(0.0);
    for (std::uint32_t frame = 1; frame <= 64; ++frame) {
      for (const std::uint32_t word : run(frame)) {
        sum += glm::dvec3((word & shared::plan_shadows) != 0, (word & shared::plan_ambient) != 0,
                          (word & shared::plan_specular) != 0);
      }
    }
    return sum / (64.0 * double(pixels));
  }

 private:
  gpu::ImageRef halves(const char* name) {
    return rig_.input(name, VK_FORMAT_R16G16B16A16_SFLOAT, std::vector<std::uint64_t>(pixels));
  }

  const scene::Camera camera_ = look({0, 0, 3}, {0, 0, 0});
  FrameRig rig_;
  gpu::ImageRef reprojection_ = rig_.input("reprojection", VK_FORMAT_R32G32B32A32_SFLOAT,
                                           std::vector(pixels, glm::vec4(0.0f)));
  gpu::ImageRef visibility_length_ = halves("lengths"),
                specular_length_ = halves("specular_lengths"),
                specular_distance_ = halves("distance");
  gpu::ImageRef visibility_ = rig_.input("visibility_before", VK_FORMAT_R16G16B16A16_UNORM,
                                         std::vector<std::uint64_t>(pixels));
  gpu::ImageRef surface_ =
      rig_.input("surface", VK_FORMAT_R8G8B8A8_UNORM, std::vector<std::uint32_t>(pixels));
  gpu::ImageRef planned_;
  bool started_ = false;
};

void expect_rates(const History& history, const glm::dvec3& expected, const char* what,
                  const protocol::Settings& settings = without_indirect()) {
  PlannedFrames frames(has_host_kernels(), settings);
  frames.set(history);
  const glm::dvec3 rates = frames.rates();
  EXPECT_NEAR(rates.x, expected.x, 0.01) << what;
  EXPECT_NEAR(rates.y, expected.y, 0.01) << what;
  EXPECT_NEAR(rates.z, expected.z, 0.01) << what;
}

TEST(SamplingPlan, KernelMatchesShader) {
  if (!has_host_kernels()) GTEST_SKIP() << "host kernels run on CPU devices only";
  protocol::Settings settings = without_indirect();
  settings.specular.fade_to = protocol::FadedReflection::environment;
  PlannedFrames host(true, settings), shader(false, settings);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  for (std::uint32_t frame = 1; frame <= 8; ++frame) {
    std::vector<History> histories(pixels);
    for (History& history : histories) {
      history = {std::floor(1.0f + 40.0f * unit(random)),
                 0.2f * unit(random),
                 unit(random),
                 unit(random),
                 unit(random),
                 unit(random) > 0.1f};
    }
    const auto history_of = [&](std::size_t i) { return histories[i]; };
    host.set(history_of);
    shader.set(history_of);
    EXPECT_EQ(host.run(frame), shader.run(frame)) << frame;
  }
}

TEST(SamplingPlan, SamplesLongHistoriesOnceInFloorFrames) {
  const protocol::Settings settings = without_indirect();
  const double floor = 1.0 / settings.sampling.floor;
  ASSERT_EQ(floor, 0.125) << "the default";
  expect_rates({}, {floor, floor, floor}, "long");
  // Smooth or metallic reflectors show most of their reflection.
  expect_rates({.roughness = 0.05f}, {floor, floor, 0.5}, "smooth");
  expect_rates({.metallic = 1.0f}, {floor, floor, 0.5}, "metal");
}

TEST(SamplingPlan, SamplesShortHistoriesInEveryFrame) {
  expect_rates({.known = false}, {1, 1, 1}, "disoccluded");
  expect_rates({.frames = 1.0f, .roughness = 0.05f}, {1, 1, 1}, "one frame");
  const auto full = static_cast<float>(protocol::Settings{}.sampling.full_frames);
  expect_rates({.frames = full - 1.0f, .roughness = 0.05f}, {1, 1, 1}, "almost full");
  expect_rates({.frames = full, .roughness = 0.05f}, {0.125, 0.125, 0.5}, "full");
}

TEST(SamplingPlan, NeedsFewerSamplesWhereTheyHardlyDiffer) {
  const auto full = static_cast<float>(protocol::Settings{}.sampling.full_frames);
  const float quarter = std::ceil(full / shared::plan_quiet_factor);
  expect_rates({.frames = quarter, .variance = 0.5f * shared::plan_quiet_variance},
               {0.125, 0.125, 0.125}, "quiet");
  expect_rates({.frames = quarter, .variance = 2.0f * shared::plan_quiet_variance}, {1, 1, 0.125},
               "noisy");
}

TEST(SamplingPlan, FadesReflectionsOfRoughSurfaces) {
  protocol::Settings settings = without_indirect();
  settings.specular.fade_start = 0.4f;
  settings.specular.fade_end = 0.6f;
  settings.specular.fade_fraction = 0.8f;
  const auto rate = [&](float roughness) {
    PlannedFrames frames(has_host_kernels(), settings);
    frames.set(History{.roughness = roughness});
    return frames.rates().z * settings.sampling.floor;
  };
  EXPECT_NEAR(rate(0.4f), 1.0, 0.03);
  EXPECT_NEAR(rate(0.5f), 0.6, 0.05) << "half faded";
  EXPECT_NEAR(rate(0.6f), 0.2, 0.05);
  EXPECT_NEAR(rate(1.0f), 0.2, 0.05);
  expect_rates({.roughness = 1.0f, .metallic = 1.0f}, {0.125, 0.125, 0.5}, "metal", settings);
  expect_rates({.roughness = 1.0f, .known = false}, {1, 1, 1}, "disoccluded", settings);
  settings.specular.fade_fraction = 0.0f;
  expect_rates({.roughness = 1.0f}, {0.125, 0.125, 0.125}, "none fades", settings);
}

TEST(SamplingPlan, LooksUpTheEnvironmentWhereReflectionsFade) {
  protocol::Settings settings = without_indirect();
  settings.specular.fade_to = protocol::FadedReflection::environment;
  settings.specular.fade_fraction = 1.0f;
  PlannedFrames frames(has_host_kernels(), settings);
  frames.set(History{.roughness = 1.0f, .ambient = 0.25f});
  int looked_up = 0;
  for (std::uint32_t frame = 1; frame <= 16; ++frame) {
    for (const std::uint32_t word : frames.run(frame)) {
      const bool sampled = (word & shared::plan_specular) != 0;
      EXPECT_EQ((word & shared::plan_environment) != 0, sampled);
      EXPECT_EQ(word >> shared::plan_visibility_shift, 64u) << "a quarter of 255";
      looked_up += sampled;
    }
  }
  EXPECT_NEAR(looked_up / (16.0 * pixels), 0.125, 0.03);
}

// Three gaps of a golden rotation over eight turns.
TEST(SamplingPlan, LeavesNoPixelOutForLong) {
  PlannedFrames frames;
  frames.set(History{});
  std::vector<std::uint32_t> last(pixels, 0);
  std::uint32_t longest = 0;
  for (std::uint32_t frame = 1; frame <= 100; ++frame) {
    const auto words = frames.run(frame);
    for (std::size_t i = 0; i < pixels; ++i) {
      if ((words[i] & shared::plan_shadows) == 0) continue;
      longest = std::max(longest, frame - last[i]);
      last[i] = frame;
    }
  }
  EXPECT_LE(longest, 13u);
  for (const std::uint32_t frame : last) EXPECT_GT(frame, 100u - 13u);
}

TEST(SamplingPlan, SamplesAllWhileLightOrGeometryChanges) {
  for (const std::uint32_t still : {0u, render::SceneMotion::settling_frames - 1}) {
    PlannedFrames frames;
    frames.set(History{});
    frames.rig().set_scene_motion({.still_frames = still});
    EXPECT_EQ(frames.rates(), glm::dvec3(1.0)) << still;
  }
}

TEST(SamplingPlan, IsNotMadeForStaticViews) {
  PlannedFrames frames;
  frames.set(History{});
  frames.run(1);
  EXPECT_GE(frames.rig().plan().timings().back().milliseconds, 0.0f);
  frames.rig().set_accumulated(1);
  frames.run(2);
  EXPECT_LT(frames.rig().plan().timings().back().milliseconds, 0.0f);
}

}  // namespace
}  // namespace heliograph::test
