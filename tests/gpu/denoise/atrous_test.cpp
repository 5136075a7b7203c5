#include "render/passes/denoise/atrous.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "render/passes/denoise/denoise_constants.hpp"
#include "shaders/embedded.hpp"
#include "tests/shader/random_inputs.hpp"
#include "tests/support/frame_rig.hpp"

namespace heliograph::test {
namespace {

constexpr int width = 37, height = 23;
constexpr VkExtent2D extent{width, height};
constexpr std::size_t pixels = width * height;

/// Filter input: a slanted floor, a wall and a strip of background, with random signal and normals.
struct Input {
  std::vector<glm::vec4> guide{pixels}, signal{pixels};
  std::vector<glm::vec2> slope{pixels};

  explicit Input(std::uint32_t seed) {
    RandomInputs random(seed);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const auto i = static_cast<std::size_t>(y * width + x);
        const bool floor = y > 11;
        const glm::vec3 base = floor ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, 1);
        const glm::vec3 normal = glm::normalize(base + 0.05f * random.unit_vector());
        const float z = floor ? 4.0f + 0.2f * static_cast<float>(22 - y) : 9.0f;
        slope[i] = floor ? glm::vec2(0.0f, -0.2f) : glm::vec2(0.0f);
        guide[i] = glm::vec4(normal * (1.0f + random.uniform(0.1f, 0.5f)), x == 30 ? 0.0f : z);
        signal[i] = {random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 0.2f),
                     random.uniform(0, 0.2f)};
      }
    }
  }
};

/// How a reference weighs: as SVGF states it, or as shaders/lib/denoise/edge_stopping.glsl does,
/// with a power of the cosine to first order and an exponential by a float's bits.
enum class Weights { stated, cheap };

double cheap_exponential(double exponent) {
  const double octaves = std::max(exponent / std::log(2.0) + 127.0, 0.0);
  const double whole = std::floor(octaves);
  return std::ldexp(1.0 + octaves - whole, static_cast<int>(whole) - 127);
}

/// Reference implementation in double: SVGF eq. 1-5.
class AtrousReference {
 public:
  AtrousReference(const Input& in, const shared::AtrousConstants& constants, bool specular,
                  float footprint, Weights weights)
      : in_(in),
        c_(constants),
        specular_(specular),
        footprint_(footprint),
        cheap_(weights == Weights::cheap) {}

  std::vector<glm::dvec4> run() const {
    std::vector<glm::dvec4> result(pixels);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) result[at(x, y)] = filter(x, y);
    }
    return result;
  }

 private:
  static std::size_t at(int x, int y) { return static_cast<std::size_t>(y * width + x); }
  glm::dvec2 bright(std::size_t i) const {
    const glm::dvec4 s(in_.signal[i]);
    if (!specular_) return {s.x, s.y};
    return glm::dvec2(0.2126 * s.x + 0.7152 * s.y + 0.0722 * s.z);
  }
  glm::dvec2 variance(std::size_t i) const {
    const glm::dvec4 s(in_.signal[i]);
    return specular_ ? glm::dvec2(s.w) : glm::dvec2(s.z, s.w);
  }
  glm::dvec2 noise(int x, int y) const {
    if (!(c_.flags & shared::atrous_variance_prefilter)) return glm::sqrt(variance(at(x, y)));
    glm::dvec2 sum(0.0);
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const int qx = std::clamp(x + dx, 0, width - 1), qy = std::clamp(y + dy, 0, height - 1);
        sum += (2 - std::abs(dx)) * (2 - std::abs(dy)) / 16.0 * variance(at(qx, qy));
      }
    }
    return glm::sqrt(sum);
  }

  glm::dvec4 filter(int x, int y) const {
    constexpr double kernel[] = {1.0, 2.0 / 3.0, 1.0 / 6.0};
    const std::size_t p = at(x, y);
    const glm::dvec4 guide_p(in_.guide[p]);
    if (guide_p.w <= 0.0) return glm::dvec4(in_.signal[p]);
    const double size_p = glm::length(glm::dvec3(guide_p));
    const glm::dvec2 sigma = noise(x, y);
    const int step = c_.start_threshold < 0.0f ? 2 << c_.level : 1 << c_.level;
    glm::dvec4 sum(0.0);
    glm::dvec2 total(0.0);
    for (int j = -c_.rows; j <= c_.rows; ++j) {
      for (int i = -c_.columns; i <= c_.columns; ++i) {
        const int qx = x + i * step, qy = y + j * step;
        if (qx < 0 || qy < 0 || qx >= width || qy >= height) continue;
        const std::size_t q = at(qx, qy);
        const glm::dvec4 guide_q(in_.guide[q]);
        if (guide_q.w <= 0.0) continue;
        const glm::dvec2 offset(i * step, j * step);
        const double size_q = glm::length(glm::dvec3(guide_q));
        const double rise = glm::dot(glm::dvec2(in_.slope[p]), offset);
        const double away = std::abs(guide_q.w * (1.0 - rise / guide_p.w) - guide_p.w);
        const double allowed =
            c_.depth_sigma * (std::abs(rise) + 0.5 * footprint_ * guide_p.w * glm::length(offset));
        const double e_z = i == 0 && j == 0 ? 0.0 : -away / allowed;
        const double cosine =
            glm::dot(glm::dvec3(guide_p), glm::dvec3(guide_q)) / (size_p * size_q);
        const double e_n = double(c_.normal_power) *
                           (cheap_ ? cosine - 1.0 : std::log(std::clamp(cosine, 1e-6, 1.0)));
        const double e_r =
            specular_ ? -std::abs(size_p - size_q) / (0.02 + 0.2 * (size_p - 1.0)) : 0.0;
        const glm::dvec2 e_l = -glm::abs(bright(p) - bright(q)) /
                               (double(c_.luminance_sigma) * sigma + (specular_ ? 1e-4 : 1e-3));
        const glm::dvec2 exponent =
            std::log(kernel[std::abs(i)] * kernel[std::abs(j)]) + e_z + e_n + e_r + e_l;
        const glm::dvec2 w =
            cheap_ ? glm::dvec2(cheap_exponential(exponent.x), cheap_exponential(exponent.y))
                   : glm::exp(exponent);
        const glm::dvec4 s(in_.signal[q]);
        sum += specular_ ? glm::dvec4(w.x * s.x, w.x * s.y, w.x * s.z, w.x * w.x * s.w)
                         : glm::dvec4(w.x * s.x, w.y * s.y, w.x * w.x * s.z, w.y * w.y * s.w);
        total += w;
      }
    }
    return specular_ ? sum / glm::dvec4(total.x, total.x, total.x, total.x * total.x)
                     : sum / glm::dvec4(total, total * total);
  }

  const Input& in_;
  shared::AtrousConstants c_;
  bool specular_;
  double footprint_;
  bool cheap_;
};

/// A rig whose blur has `iterations` levels from that of `constants`.
struct Filter {
  Filter(const Input& in, const shared::AtrousConstants& given, bool specular, int iterations = 1,
         protocol::BlurKernel kernel = protocol::BlurKernel::full)
      : rig(SceneBuilder().build(), look({0, 0, 3}, {0, 0, 0}), {.extent = extent}),
        input{rig.input("guide", VK_FORMAT_R32G32B32A32_SFLOAT, in.guide),
              rig.input("slope", VK_FORMAT_R32G32_SFLOAT, in.slope),
              rig.input("signal", VK_FORMAT_R32G32B32A32_SFLOAT, in.signal)} {
    const auto constants = [given](const render::KernelShape& shape) {
      shared::AtrousConstants made = given;
      made.level = given.level + shape.level;
      made.columns = shape.columns;
      made.rows = shape.rows;
      return made;
    };
    const auto& shader = specular ? shaders::specular_atrous : shaders::visibility_atrous;
    const auto& half_shader =
        specular ? shaders::specular_atrous_half : shaders::visibility_atrous_half;
    rig.plan().use_host_kernels(false);  // atrous_kernel_test.cpp compares the host kernel
    filtered = render::blur(rig.plan(), rig.inputs(), input,
                            {.name = "test",
                             .buffers = render::specular_atrous_buffers,
                             .program = rig.inputs().program(shader),
                             .half_program = rig.inputs().program(half_shader),
                             .kernel = render::kernels::specular_atrous,
                             .iterations = iterations,
                             .shape = kernel,
                             .constants = constants},
                            {});
  }
  render::FloatImage run() {
    rig.run();
    return rig.read(filtered);
  }

  FrameRig rig;
  render::AtrousInput input;
  gpu::ImageRef filtered;
};

shared::AtrousConstants plain() {
  shared::AtrousConstants constants{};
  constants.luminance_sigma = 4.0f;
  constants.normal_power = 32.0f;
  constants.depth_sigma = 1.0f;
  constants.start_threshold = 2.0f;
  constants.flags = shared::atrous_variance_prefilter;
  constants.pixels_per_texel = 1;
  return constants;
}

class Atrous : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Signals, Atrous, testing::Bool(), [](const auto& instance) {
  return instance.param ? "specular" : "visibility";
});

TEST_P(Atrous, MatchesReferenceOnRandomInput) {
  for (const float start : {2.0f, -1.0f}) {
    for (const std::uint32_t flags : {0u, shared::atrous_variance_prefilter}) {
      const Input in(7);
      shared::AtrousConstants constants = plain();
      constants.start_threshold = start;
      constants.flags = flags;
      Filter filter(in, constants, GetParam());
      const render::FloatImage got = filter.run();
      constants.columns = constants.rows = 2;
      const float footprint =
          2.0f * std::abs(filter.rig.constants().unproject.y) / static_cast<float>(height);
      const auto reference = [&](Weights weights) {
        return AtrousReference(in, constants, GetParam(), footprint, weights).run();
      };
      const auto expected = reference(Weights::cheap), stated = reference(Weights::stated);
      double mean_off = 0.0;
      for (std::size_t i = 0; i < pixels; ++i) {
        for (int k = 0; k < 4; ++k) {
          const double value = got.rgba[4 * i + k];
          ASSERT_NEAR(value, expected[i][k], 2e-4 * std::abs(expected[i][k]) + 2e-5)
              << "pixel " << i << " channel " << k << " start " << start;
          ASSERT_NEAR(value, stated[i][k], 0.02) << "pixel " << i << " channel " << k;
          mean_off += std::abs(value - stated[i][k]) / (4.0 * pixels);
        }
      }
      EXPECT_LT(mean_off, 2e-3) << "cheap weights change nothing that shows";
    }
  }
}

TEST_P(Atrous, ConstantSignalIsUnchanged) {
  Input in(1);
  for (auto& value : in.signal) value = glm::vec4(0.5f, 0.5f, 0.5f, 0.5f);
  for (const auto kernel : {protocol::BlurKernel::full, protocol::BlurKernel::separable}) {
    Filter filter(in, plain(), GetParam(), 4, kernel);
    const render::FloatImage got = filter.run();
    for (std::size_t i = 0; i < pixels; ++i) EXPECT_NEAR(got.rgba[4 * i], 0.5f, 1e-5f) << i;
  }
}

TEST_P(Atrous, PreservesEdgesBetweenSurfaces) {
  const std::array upper{glm::vec4(0, 0, 1.5f, 5), glm::vec4(0, 0, 1.5f, 5)};
  const std::array lower{glm::vec4(0, 1.5f, 0, 5),
                         glm::vec4(0, 0, 1.5f, 50)};  // rotated; far behind
  for (std::size_t edge = 0; edge < upper.size(); ++edge) {
    Input in(1);
    for (std::size_t i = 0; i < pixels; ++i) {
      const bool below = i / width > 11;
      in.guide[i] = below ? lower[edge] : upper[edge];
      in.slope[i] = glm::vec2(0.0f);
      in.signal[i] = below ? glm::vec4(1, 1, 1, 9) : glm::vec4(0, 0, 0, 9);
      if (!GetParam()) in.signal[i].z = in.signal[i].w;
    }
    for (const auto kernel : {protocol::BlurKernel::full, protocol::BlurKernel::separable}) {
      Filter filter(in, plain(), GetParam(), 4, kernel);
      const render::FloatImage got = filter.run();
      for (std::size_t i = 0; i < pixels; ++i) {
        // Depth alone leaks slightly at the widest steps; without it half would leak.
        EXPECT_NEAR(got.rgba[4 * i], i / width > 11 ? 1.0f : 0.0f, edge == 0 ? 1e-4f : 0.01f)
            << i << ", edge " << edge;
      }
    }
  }
}

TEST_P(Atrous, ReducesNoiseAndVarianceOnUniformSurface) {
  Input in(3);
  for (std::size_t i = 0; i < pixels; ++i) {
    in.guide[i] = glm::vec4(0, 0, 1.3f, 5.0f);
    in.slope[i] = glm::vec2(0.0f);
    const float value = in.signal[i].x < 0.5f ? 0.0f : 1.0f;
    in.signal[i] = glm::vec4(value, value, GetParam() ? value : 0.25f, 0.25f);
  }
  for (const auto kernel : {protocol::BlurKernel::full, protocol::BlurKernel::separable}) {
    Filter filter(in, plain(), GetParam(), 4, kernel);
    const render::FloatImage got = filter.run();
    double mean = 0.0, squares = 0.0, left = 0.0;
    for (std::size_t i = 0; i < pixels; ++i) {
      mean += got.rgba[4 * i] / double(pixels);
      squares += double(got.rgba[4 * i]) * got.rgba[4 * i] / double(pixels);
      left += got.rgba[4 * i + 3] / double(pixels);
    }
    EXPECT_NEAR(mean, 0.5, 0.06);
    EXPECT_LT(squares - mean * mean, 0.25 / 20.0) << "of a variance of 1/4";
    EXPECT_LT(left, 0.25 / 20.0) << "filtered variance";
  }
}

TEST_P(Atrous, IgnoresBackground) {
  Input in(5);
  for (std::size_t i = 0; i < pixels; ++i) {
    if (in.guide[i].w == 0.0f) in.signal[i] = glm::vec4(1e6f);
  }
  Filter filter(in, plain(), GetParam(), 3, protocol::BlurKernel::separable);
  const render::FloatImage got = filter.run();
  for (std::size_t i = 0; i < pixels; ++i) {
    if (in.guide[i].w == 0.0f) {
      EXPECT_EQ(got.rgba[4 * i], 1e6f);
    } else {
      EXPECT_LE(got.rgba[4 * i], 1.0f);
    }
  }
}

/// With `flag`, surfaces of the first roughness are not filtered, of the second in one iteration,
/// of the third in all.
void expect_levels(std::uint32_t flag, const std::array<float, 3>& roughness) {
  Input in(9);
  const auto third = [](std::size_t i) { return std::min<std::size_t>(i % width / 12, 2); };
  for (std::size_t i = 0; i < pixels; ++i) {
    in.guide[i] = glm::vec4(0, 0, 1.0f + roughness[third(i)], 5.0f);
    in.slope[i] = glm::vec2(0.0f);
  }
  shared::AtrousConstants constants = plain();
  constants.flags |= flag;
  Filter once(in, constants, true, 1), often(in, constants, true, 4);
  const render::FloatImage one = once.run(), four = often.run();
  for (std::size_t i = 0; i < pixels; ++i) {
    if (third(i) == 0) {
      EXPECT_EQ(four.rgba[4 * i], in.signal[i].x) << "a perfect mirror must not be blurred";
    } else if (third(i) == 1) {
      EXPECT_EQ(four.rgba[4 * i], one.rgba[4 * i]) << "one iteration";
      EXPECT_NE(four.rgba[4 * i], in.signal[i].x);
    } else {
      EXPECT_NE(four.rgba[4 * i], one.rgba[4 * i]);
    }
  }
}

TEST(AtrousLevels, FollowRoughnessForNoiseFreeHits) {
  expect_levels(shared::atrous_levels_by_roughness, {0.0015f, 0.049f, 0.051f});
}

TEST(AtrousLevels, StepGrowsWithinABandOfRoughness) {
  const float threshold = 0.5f;
  Input in(9);
  const auto third = [](std::size_t i) { return std::min<std::size_t>(i % width / 12, 2); };
  for (std::size_t i = 0; i < pixels; ++i) {
    in.guide[i] = glm::vec4(0, 0, 1.0f + threshold + 0.051f * (third(i) - 1.0f), 5.0f);
    in.slope[i] = glm::vec2(0.0f);
  }
  const auto filtered = [&](float start) {
    shared::AtrousConstants constants = plain();
    constants.start_threshold = start;
    constants.level = 1;  // steps of 2, 3 in the middle of the band, and 4
    return Filter(in, constants, true).run();
  };
  const render::FloatImage band = filtered(threshold), small = filtered(2.0f),
                           large = filtered(-1.0f);
  std::array<bool, 2> differs{};
  for (std::size_t i = 0; i < pixels; ++i) {
    const float value = band.rgba[4 * i];
    if (third(i) == 0) {
      EXPECT_EQ(value, small.rgba[4 * i]);
    } else if (third(i) == 2) {
      EXPECT_EQ(value, large.rgba[4 * i]);
    } else {
      differs[0] |= value != small.rgba[4 * i];
      differs[1] |= value != large.rgba[4 * i];
    }
  }
  EXPECT_TRUE(differs[0] && differs[1]) << "half way between";
}

// Lobes of less than a pixel, of one to two pixels, and wider than the filter's footprint.
TEST(AtrousLevels, AreLimitedBySpecularLobeWidth) {
  expect_levels(shared::atrous_lobe_limit, {0.01f, 0.17f, 0.9f});
}

TEST(SeparableAtrous, UpdatesVarianceInSecondPassOnly) {
  protocol::Settings settings;
  settings.specular_blur.variance_update = protocol::VarianceUpdate::vertical_only;
  const auto flags = [&](bool first) {
    return render::atrous_constants(settings.specular_blur, {}, {0, 2, 0, first}).flags;
  };
  EXPECT_TRUE(flags(true) & shared::atrous_keep_variance);
  EXPECT_FALSE(flags(false) & shared::atrous_keep_variance);
  const Input in(11);
  shared::AtrousConstants keep = plain();
  keep.flags |= shared::atrous_keep_variance;
  Filter filter(in, keep, true);
  const render::FloatImage got = filter.run();
  for (std::size_t i = 0; i < pixels; ++i) EXPECT_EQ(got.rgba[4 * i + 3], in.signal[i].w);
}

}  // namespace
}  // namespace heliograph::test
