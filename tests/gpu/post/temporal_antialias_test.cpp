#include "render/passes/post/temporal_antialias.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "render/passes/post/accumulate.hpp"
#include "tests/support/frame_rig.hpp"

namespace heliograph::test {
namespace {

constexpr std::uint32_t width = 48, height = 32;
constexpr VkExtent2D extent{width, height};
using Texels = std::vector<glm::vec4>;
using Paint = std::function<glm::vec3(float x, float y)>;

Texels paint(const Paint& color) {
  Texels texels;
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const auto at = [](std::uint32_t i) { return static_cast<float>(i) + 0.5f; };
      texels.emplace_back(color(at(x), at(y)), 1.0f);
    }
  }
  return texels;
}

/// The pass alone, with synthetic images and motion vectors.
class TemporalAntialiasTest : public testing::Test {
 protected:
  TemporalAntialiasTest() {
    const auto image = [&](const char* name, const glm::vec4& texel) {
      return rig_.input(name, VK_FORMAT_R32G32B32A32_SFLOAT, Texels(width * height, texel));
    };
    hdr_ = image("hdr", glm::vec4(0.0f));
    gbuffer_.motion = image("motion", glm::vec4(0, 0, 0, 5));
    const render::Exposure exposure = render::expose(rig_.plan(), rig_.inputs(), hdr_, hdr_);
    resolved_ = render::temporal_antialias(rig_.plan(), rig_.inputs(), gbuffer_, exposure, hdr_);
  }

  /// Uniform motion in pixels per frame at view depth `view_z`.
  void move(const glm::vec2& pixels, float view_z = 5.0f) {
    const glm::vec2 uv = -pixels / glm::vec2(extent.width, extent.height);
    rig_.fill(gbuffer_.motion, Texels(width * height, glm::vec4(uv, 0, view_z)));
  }
  render::FloatImage frame(const Texels& image) {
    rig_.fill(hdr_, image);
    rig_.run();
    rig_.set_view(look({0, 0, 3}, {0, 0, 0}));  // later frames have a history
    return rig_.read(resolved_);
  }
  render::FloatImage frame(const Paint& color) { return frame(paint(color)); }

  FrameRig rig_{SceneBuilder().build(), look({0, 0, 3}, {0, 0, 0}), {.extent = extent}};
  gpu::ImageRef hdr_;
  render::GBuffer gbuffer_;
  gpu::ImageRef resolved_;
};

TEST_F(TemporalAntialiasTest, StaticImageIsUnchanged) {
  const Paint waves = [](float x, float y) {
    return glm::vec3(2.0f + std::sin(0.4f * x), 300.0f + 5.0f * y, 0.1f * x + 0.05f * y);
  };
  const Texels expected = paint(waves);
  for (int i = 0; i < 20; ++i) frame(waves);
  const render::FloatImage image = frame(waves);
  for (std::uint32_t y = 1; y + 1 < height; ++y) {
    for (std::uint32_t x = 1; x + 1 < width; ++x) {
      const glm::vec4 got = texel(image, x, y), want = expected[y * width + x];
      const float luma = 0.25f * (want.x + 2.0f * want.y + want.z);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], want[c], 0.01f * luma) << x << " " << y;
    }
  }
}

/// The sample alone, but for rounding to the 16 bits that shaders keep.
bool is_sample(const glm::vec4& resolved, const glm::vec4& sample) {
  return glm::all(glm::lessThanEqual(glm::abs(resolved - sample), glm::abs(sample) / 1024.0f));
}

// A published implementation lacks the off-screen test and smears here.
TEST_F(TemporalAntialiasTest, ColumnsEnteringTheFrameHaveNoHistory) {
  const auto shade = [](int frame_number) {
    return [frame_number](float x, float y) {
      const float pattern =
          std::sin(0.4f * (x + 3.0f * static_cast<float>(frame_number))) * std::sin(0.3f * y);
      return glm::vec3(1.0f + 0.9f * pattern, 0.5f + 0.4f * pattern, 0.2f);
    };
  };
  frame(shade(0));
  move({-3, 0});  // the camera pans right: three columns enter at the right edge
  for (int i = 1; i < 8; ++i) {
    const Texels input = paint(shade(i));
    const render::FloatImage image = frame(input);
    double inside = 0.0;
    for (std::uint32_t y = 0; y < height; ++y) {
      for (std::uint32_t x = width - 3; x < width; ++x) {
        ASSERT_TRUE(is_sample(texel(image, x, y), input[y * width + x]))
            << x << " " << y << " frame " << i;
      }
      for (std::uint32_t x = 8; x < width - 8; ++x) {
        inside = std::max<double>(inside, std::abs(texel(image, x, y).x - input[y * width + x].x));
      }
    }
    // The pattern moves by whole pixels, so that the history is exact where it is valid.
    EXPECT_LT(inside, 0.12) << "frame " << i;
  }
}

TEST_F(TemporalAntialiasTest, HistoryResetDiscardsPreviousFrame) {
  frame([](float, float) { return glm::vec3(100.0f); });
  FrameRig fresh(SceneBuilder().build(), look({0, 0, 3}, {0, 0, 0}), {.extent = extent});
  const auto hdr =
      fresh.input("hdr", VK_FORMAT_R32G32B32A32_SFLOAT, Texels(width * height, glm::vec4(100.0f)));
  render::GBuffer gbuffer;
  gbuffer.motion = fresh.input("motion", VK_FORMAT_R32G32B32A32_SFLOAT,
                               Texels(width * height, glm::vec4(0, 0, 0, 5)));
  const auto exposure = render::expose(fresh.plan(), fresh.inputs(), hdr, hdr);
  const auto resolved =
      render::temporal_antialias(fresh.plan(), fresh.inputs(), gbuffer, exposure, hdr);
  fresh.run();
  const Texels dim = paint([](float x, float) { return glm::vec3(0.01f * x); });
  fresh.fill(hdr, dim);
  fresh.run();  // frame constants still mark the history as invalid
  const render::FloatImage image = fresh.read(resolved);
  for (std::uint32_t x = 0; x < width; ++x) {
    EXPECT_TRUE(is_sample(texel(image, x, 5), dim[x])) << x;
  }
}

TEST_F(TemporalAntialiasTest, MovedSquareLeavesNoGhost) {
  const auto square = [](float left) {
    return [left](float x, float y) {
      const bool inside = x > left && x < left + 8 && y > 10 && y < 18;
      return inside ? glm::vec3(50.0f) : glm::vec3(0.05f + 0.01f * std::fmod(x + y, 3.0f));
    };
  };
  for (int i = 0; i < 10; ++i) frame(square(4));
  frame(square(30));  // without motion vectors: worst case
  const Paint behind = square(30);
  render::FloatImage image;
  for (int i = 0; i < 3; ++i) image = frame(behind);
  for (std::uint32_t y = 11; y < 17; ++y) {
    for (std::uint32_t x = 5; x < 11; ++x) EXPECT_LT(texel(image, x, y).x, 0.08f) << x << " " << y;
  }
}

// Without luminance weights the mean of one bright and many dark frames is bright.
TEST_F(TemporalAntialiasTest, FireflyFadesWithinFewFrames) {
  const auto sky = [](float spark) {
    return [spark](float x, float y) {
      const bool there = std::abs(x - 20.5f) < 0.6f && std::abs(y - 15.5f) < 0.6f;
      return there ? glm::vec3(spark) : glm::vec3(0.4f + 0.02f * std::sin(x * y));
    };
  };
  for (int i = 0; i < 5; ++i) frame(sky(0.4f));
  const float during = texel(frame(sky(5000.0f)), 20, 15).x;
  EXPECT_LT(during, 1.5f) << "one firefly is weighted by its compressed luminance";
  const float after = texel(frame(sky(0.4f)), 20, 15).x;
  EXPECT_LT(after, 0.5f);
}

TEST_F(TemporalAntialiasTest, EdgeUsesMotionOfNearestSurface) {
  // Left half near and moving right by 2 pixels, right half far and static: far pixels beside the
  // edge must use the motion of the near half.
  Texels motion;
  for (std::uint32_t i = 0; i < width * height; ++i) {
    const bool near = i % width < 24;
    motion.push_back(near ? glm::vec4(-2.0f / width, 0, 0, 2) : glm::vec4(0, 0, 0, 9));
  }
  rig_.fill(gbuffer_.motion, motion);
  const auto input = [](float x, float) { return x < 24 ? glm::vec3(2.0f) : glm::vec3(0.1f * x); };
  frame(input);
  const render::FloatImage image = frame(input);
  // Pixel 24 is far, beside the edge: with the near motion its history is column 22, darker as far
  // as the neighborhood box permits; with its own motion it would not change.
  const float own = input(24.5f, 0).x;
  EXPECT_LT(texel(image, 24, 10).x, own - 0.1f);
  EXPECT_NEAR(texel(image, 30, 10).x, input(30.5f, 0).x, 0.02f);
}

// On a surface that moves by more from row to row, a neighbour's motion is wrong by the same amount
// in every frame, and the history drifts.
TEST_F(TemporalAntialiasTest, SlantedSurfaceMovesByItsOwnMotion) {
  Texels motion;
  for (std::uint32_t i = 0; i < width * height; ++i) {
    // Nearer toward the bottom, by less than an edge; columns move by a tenth of the row.
    const auto row = static_cast<float>(i / width);
    motion.emplace_back(-0.1f * row / width, 0, 0, 20.0f - 0.1f * row);
  }
  rig_.fill(gbuffer_.motion, motion);
  const auto surface = [](int frame_number) {
    return [frame_number](float x, float y) {
      const float own = x - 0.1f * (y - 0.5f) * static_cast<float>(frame_number);
      return glm::vec3(1.0f + 0.5f * std::sin(0.6f * own));
    };
  };
  protocol::Settings settings;
  settings.antialiasing.clip = 8.0f;
  rig_.set_settings(settings);
  render::FloatImage image;
  for (int i = 0; i < 20; ++i) image = frame(surface(i));
  const Texels expected = paint(surface(19));
  for (std::uint32_t x = 44; x < width; ++x) {
    EXPECT_NEAR(texel(image, x, 4).x, expected[4 * width + x].x, 0.05f) << x;
  }
}

// Waves of four pixels that move by a third of one: Catmull-Rom's cubic leaves two thirds of them.
TEST_F(TemporalAntialiasTest, SubpixelMotionKeepsDetail) {
  move({0.3f, 0});
  const auto waves = [](int frame_number) {
    return [frame_number](float x, float) {
      const float own = x - 0.3f * static_cast<float>(frame_number);
      return glm::vec3(1.0f + 0.1f * std::sin(1.5707963f * own));
    };
  };
  protocol::Settings settings;
  settings.antialiasing.clip = 8.0f;
  rig_.set_settings(settings);
  render::FloatImage image;
  for (int i = 0; i < 40; ++i) image = frame(waves(i));
  double contrast = 0.0;
  const Texels sharp = paint(waves(39));
  double whole = 0.0;
  for (std::uint32_t x = 16; x < 40; ++x) {
    contrast += (texel(image, x, 10).x - 1.0) * (sharp[10 * width + x].x - 1.0);
    whole += std::pow(sharp[10 * width + x].x - 1.0, 2);
  }
  RecordProperty("contrast", std::to_string(contrast / whole));
  EXPECT_GT(contrast / whole, 0.75);
}

TEST_F(TemporalAntialiasTest, NewPixelsAverageTheirFirstFrames) {
  protocol::Settings settings;
  settings.antialiasing.clip = 8.0f;
  rig_.set_settings(settings);
  for (int i = 0; i < 4; ++i) {
    const float noise[] = {1.0f, 1.4f, 1.2f, 1.6f};
    const render::FloatImage image = frame([&](float x, float y) {
      // Neighbours that differ, so that the box lets the history pass.
      return glm::vec3(noise[i] + 0.8f * std::fmod(std::floor(x) + std::floor(y), 2.0f));
    });
    const float mean = texel(image, 20, 10).x;
    if (i == 1) {
      EXPECT_NEAR(mean, 1.2f, 0.03f) << "both weigh the same";
    }
    if (i == 3) {
      EXPECT_NEAR(mean, 1.3f, 0.05f) << "all four";
    }
    EXPECT_FLOAT_EQ(texel(image, 20, 10).w, static_cast<float>(i + 1)) << "frames in the mean";
  }
}

/// A moving pattern, drawn by jittered samples of a part of the size that is shown.
class Reconstruction {
 public:
  explicit Reconstruction(VkExtent2D drawn)
      : drawn_(drawn),
        rig_(SceneBuilder().build(), look({0, 0, 3}, {0, 0, 0}),
             {.extent = drawn,
              .shown = drawn.width == shown.width ? std::nullopt : std::optional(shown)}) {
    const Texels black(std::size_t{drawn.width} * drawn.height, glm::vec4(0.0f));
    hdr_ = rig_.input("hdr", VK_FORMAT_R32G32B32A32_SFLOAT, black);
    gbuffer_.motion = rig_.input("motion", VK_FORMAT_R32G32B32A32_SFLOAT, black);
    const render::Exposure exposure = render::expose(rig_.plan(), rig_.inputs(), hdr_, hdr_);
    resolved_ = render::temporal_antialias(rig_.plan(), rig_.inputs(), gbuffer_, exposure, hdr_);
  }

  /// The next frame of a pattern that has moved by `pixels` since the last.
  render::FloatImage frame(const Paint& pattern, const glm::vec2& pixels) {
    if (frames_ > 0) rig_.set_view(look({0, 0, 3}, {0, 0, 0}), frames_);
    const glm::vec2 jitter = render::sample_jitter(frames_++);
    const glm::vec2 size(drawn_.width, drawn_.height), full(shown.width, shown.height);
    Texels texels;
    for (std::uint32_t y = 0; y < drawn_.height; ++y) {
      for (std::uint32_t x = 0; x < drawn_.width; ++x) {
        const glm::vec2 at = (glm::vec2(x, y) + 0.5f - jitter) / size * full;
        texels.emplace_back(pattern(at.x, at.y), 1.0f);
      }
    }
    rig_.fill(hdr_, texels);
    rig_.fill(gbuffer_.motion, Texels(texels.size(), glm::vec4(-pixels / full, 0, 5)));
    rig_.run();
    return rig_.read(resolved_);
  }

  static constexpr VkExtent2D shown{96, 64};

 private:
  VkExtent2D drawn_;
  FrameRig rig_;
  gpu::ImageRef hdr_;
  render::GBuffer gbuffer_;
  gpu::ImageRef resolved_;
  std::uint32_t frames_ = 0;
};

/// Rings that become finer from the middle of the frame, up to waves of three pixels.
Paint zone_plate(float moved) {
  return [moved](float x, float y) {
    const glm::vec2 off(x - 48.0f - moved, y - 32.0f);
    return glm::vec3(0.5f + 0.4f * std::cos(0.022f * glm::dot(off, off)));
  };
}

/// Mean over each pixel's area.
Texels supersampled(const Paint& pattern) {
  Texels texels;
  for (std::uint32_t y = 0; y < Reconstruction::shown.height; ++y) {
    for (std::uint32_t x = 0; x < Reconstruction::shown.width; ++x) {
      glm::vec3 sum(0.0f);
      for (int i = 0; i < 64; ++i) {
        const auto part = [](int k) { return (static_cast<float>(k) + 0.5f) / 8.0f; };
        sum += pattern(static_cast<float>(x) + part(i % 8), static_cast<float>(y) + part(i / 8));
      }
      texels.emplace_back(sum / 64.0f, 1.0f);
    }
  }
  return texels;
}

std::vector<float> errors(const render::FloatImage& image, const Texels& expected) {
  std::vector<float> all;
  for (std::uint32_t y = 6; y < Reconstruction::shown.height - 6; ++y) {
    for (std::uint32_t x = 10; x < Reconstruction::shown.width - 10; ++x) {
      all.push_back(texel(image, x, y).x - expected[y * Reconstruction::shown.width + x].x);
    }
  }
  return all;
}

double mean_magnitude(const std::vector<float>& values) {
  double sum = 0.0;
  for (const float value : values) sum += std::abs(value);
  return sum / static_cast<double>(values.size());
}

TEST(Reconstruction, JitteredStillConvergesToTheSupersampledImage) {
  const Texels expected = supersampled(zone_plate(0.0f));
  double at_first = 0.0;
  Reconstruction reconstruction({64, 43});
  render::FloatImage image;
  for (int i = 0; i < 60; ++i) {
    image = reconstruction.frame(zone_plate(0.0f), {0, 0});
    if (i == 0) at_first = mean_magnitude(errors(image, expected));
  }
  const double error = mean_magnitude(errors(image, expected));
  testing::Test::RecordProperty("error", std::to_string(error));
  EXPECT_LT(error, 0.2 * at_first);
}

TEST(Reconstruction, MovingZonePlateShimmersHardlyMoreThanAtFullSize) {
  const auto shimmer = [](VkExtent2D drawn) {
    Reconstruction reconstruction(drawn);
    std::vector<float> before;
    double sum = 0.0;
    for (int i = 0; i < 24; ++i) {
      const float moved = 0.37f * static_cast<float>(i);
      const auto image = reconstruction.frame(zone_plate(moved), {0.37f, 0});
      std::vector<float> now = errors(image, supersampled(zone_plate(moved)));
      if (i >= 16) {
        std::vector<float> change = now;
        for (std::size_t k = 0; k < now.size(); ++k) change[k] -= before[k];
        sum += mean_magnitude(change) / 8.0;
      }
      before = std::move(now);
    }
    return sum;
  };
  const double native = shimmer(Reconstruction::shown), drawn_smaller = shimmer({77, 51});
  testing::Test::RecordProperty("native", std::to_string(native));
  testing::Test::RecordProperty("smaller", std::to_string(drawn_smaller));
  EXPECT_LT(drawn_smaller, 1.15 * native) << native;
}

TEST_F(TemporalAntialiasTest, BicubicHistoryStaysPositiveAtHardEdges) {
  const auto edge = [](float offset) {
    return
        [offset](float x, float) { return x < 20 + offset ? glm::vec3(0.0f) : glm::vec3(80.0f); };
  };
  move({0.4f, 0});
  for (int i = 0; i < 12; ++i) {
    const render::FloatImage image = frame(edge(0.4f * static_cast<float>(i)));
    for (const float value : image.rgba) ASSERT_GE(value, 0.0f);
    for (const float value : image.rgba) ASSERT_LT(value, 82.0f);
  }
}

}  // namespace
}  // namespace heliograph::test
