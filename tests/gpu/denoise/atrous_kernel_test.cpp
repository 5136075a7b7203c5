#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <random>

#include "render/kernels/atrous.hpp"
#include "shaders/embedded.hpp"
#include "tests/gpu/denoise/packed_input.hpp"
#include "tests/support/frame_rig.hpp"

namespace heliograph::test {
namespace {

namespace kernels = render::kernels;

enum class Signal { visibility, specular };
using Texels = std::vector<glm::vec4>;

// A threshold that is no step of stored roughness: both sides must decide alike.
constexpr float between_roughnesses = 51.5f / 255.0f;

/// A guide with planes, edges, holes and various roughnesses, and a noisy signal.
struct Field {
  Texels guide;
  std::vector<glm::vec2> slope;
  Texels signal;
};

Field make_field(VkExtent2D extent, Signal kind) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  Field field;
  for (std::uint32_t y = 0; y < extent.height; ++y) {
    for (std::uint32_t x = 0; x < extent.width; ++x) {
      const bool left = x < extent.width / 2;
      const glm::vec3 normal =
          glm::normalize(glm::vec3(left ? 0.2f : -0.6f, 1.0f, 0.3f) + 0.02f * unit(random));
      const float roughness =
          stored_roughness(y < extent.height / 3 ? 0.2f + 0.04f * (unit(random) - 0.5f)
                           : left                ? 0.03f
                                                 : 0.6f);
      const bool hole = x % 19 == 7 && y % 5 == 2;
      const float view_z =
          hole ? 0.0f : 3.0f + 0.02f * static_cast<float>(x) + (left ? 0.0f : 1.0f);
      field.guide.emplace_back(hole ? glm::vec3(0.0f) : normal * (1.0f + roughness), view_z);
      field.slope.emplace_back(hole ? 0.0f : 0.02f, 0.001f);
      const float a = unit(random), b = unit(random), noise = 0.1f * unit(random);
      field.signal.push_back(kind == Signal::visibility
                                 ? glm::vec4(a < 0.3f, b < 0.7f, noise, 0.5f * noise)
                                 : glm::vec4(3.0f * a, b, a * b, noise));
    }
  }
  return field;
}

class AtrousRig {
 public:
  AtrousRig(VkExtent2D extent, Signal kind, bool orthographic = false)
      : kind_(kind), rig_(SceneBuilder().build(), camera(orthographic), {.extent = extent}) {
    const Field field = make_field(extent, kind);
    constexpr VkFormat four = render::formats::four_floats;
    guide_ = rig_.input("guide", four, field.guide);
    slope_ = rig_.input("slope", VK_FORMAT_R32G32_SFLOAT, field.slope);
    signal_ = rig_.input("signal", four, field.signal);
    packed_ = packed_input(rig_, field.guide, field.slope);
    by_shader_ = rig_.plan().image("shader", four);
    by_host_ = rig_.plan().image("host", four);
    declare("atrous", by_shader_, false);
    declare("atrous.host", by_host_, true);
    between_ = rig_.plan().image("between", render::formats::four_halves);
    by_two_shaders_ = rig_.plan().image("shaders", four);
    both_by_host_ = rig_.plan().image("both.host", four);
    const bool visibility = kind == Signal::visibility;
    declare_shader(
        "atrous.first",
        visibility ? shaders::visibility_atrous_half_first : shaders::specular_atrous_half_first,
        signal_, between_, &kernels::AtrousHalves::first);
    declare_shader(
        "atrous.second",
        visibility ? shaders::visibility_atrous_half_last : shaders::specular_atrous_half_last,
        between_, by_two_shaders_, &kernels::AtrousHalves::second);
    declare_halves();
    rig_.set_view(camera(orthographic), 5);
  }

  struct ErrorStatistics {
    double mean;
    double max;
    double changed;  // mean change by the filter
  };
  ErrorStatistics compare(const shared::AtrousConstants& constants) {
    constants_ = constants;
    rig_.run();
    return compared(by_shader_, by_host_);
  }
  /// Both halves at once with two passes of the shader.
  ErrorStatistics compare(const kernels::AtrousHalves& halves) {
    halves_ = halves;
    rig_.run();
    return compared(by_two_shaders_, both_by_host_);
  }

  ErrorStatistics compared(gpu::ImageRef by_shader, gpu::ImageRef by_host) {
    const render::FloatImage shader = rig_.read(by_shader), host = rig_.read(by_host);
    const render::FloatImage signal = rig_.read(signal_);
    ErrorStatistics result{};
    for (std::size_t i = 0; i < shader.rgba.size(); ++i) {
      const double off = std::abs(static_cast<double>(shader.rgba[i]) - host.rgba[i]);
      result.mean += std::isfinite(off) ? off : 1e9;
      result.max = std::max(result.max, off);
      result.changed += std::abs(static_cast<double>(shader.rgba[i]) - signal.rgba[i]);
    }
    result.mean /= static_cast<double>(shader.rgba.size());
    result.changed /= static_cast<double>(shader.rgba.size());
    return result;
  }

  /// Wall-clock milliseconds of the shader and of the host kernel, minimum of several frames.
  std::pair<double, double> time(const shared::AtrousConstants& constants) {
    using Clock = std::chrono::steady_clock;
    constants_ = constants;
    rig_.run();
    std::pair best(1e9, 1e9);
    for (int i = 0; i < 8; ++i) {
      const auto start = Clock::now();
      rig_.run();
      const double both = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
      const double host = rig_.plan().timings()[1].milliseconds;
      best.first = std::min(best.first, both - host);
      best.second = std::min(best.second, host);
    }
    return best;
  }

 private:
  static scene::Camera camera(bool orthographic) {
    scene::Camera made = look({0, 0, 3}, {0, 0, 0});
    if (orthographic) made.orthographic_height = 4.0f;
    return made;
  }
  void declare(const std::string& name, gpu::ImageRef filtered, bool host) {
    const bool visibility = kind_ == Signal::visibility;
    const auto& shader = visibility ? shaders::visibility_atrous : shaders::specular_atrous;
    rig_.plan().use_host_kernels(host);
    rig_.plan()
        .pass(name, rig_.inputs().program(shader))
        .bind<kernels::AtrousBindings>(
            {.guide = guide_, .depth_slope = slope_, .signal = signal_, .filtered = filtered})
        .constants([this] { return constants_; })
        .dispatch(rig_.plan().extent())
        .host(visibility ? kernels::visibility_atrous : kernels::specular_atrous, rig_.constants());
  }

  void declare_shader(const std::string& name, const gpu::ShaderBinary& shader, gpu::ImageRef from,
                      gpu::ImageRef to, shared::AtrousConstants kernels::AtrousHalves::*half) {
    rig_.plan().use_host_kernels(false);
    rig_.plan()
        .pass(name, rig_.inputs().program(shader))
        .bind<kernels::AtrousBindings>({.guide = packed_.surface.value(),
                                        .depth_slope = packed_.slope.value(),
                                        .signal = from,
                                        .filtered = to})
        .constants([this, half] { return halves_.*half; })
        .dispatch(rig_.plan().extent());
  }
  void declare_halves() {
    rig_.plan().use_host_kernels(true);
    rig_.plan()
        .host("atrous.halves", {})
        .bind<kernels::AtrousBindings>(
            {.guide = guide_, .depth_slope = slope_, .signal = signal_, .filtered = both_by_host_})
        .constants([this] { return halves_; })
        .host(kind_ == Signal::visibility ? kernels::visibility_atrous_halves
                                          : kernels::specular_atrous_halves,
              rig_.constants());
  }

  Signal kind_;
  shared::AtrousConstants constants_{.pixels_per_texel = 1};
  kernels::AtrousHalves halves_{{.pixels_per_texel = 1}, {.pixels_per_texel = 1}};
  FrameRig rig_;
  gpu::ImageRef guide_, slope_, signal_, by_shader_, by_host_;
  render::PackedGuide packed_;
  gpu::ImageRef between_, by_two_shaders_, both_by_host_;
};

shared::AtrousConstants constants(int level, int columns, int rows, std::uint32_t flags,
                                  float start_threshold) {
  shared::AtrousConstants made{};
  made.level = level;
  made.columns = columns;
  made.rows = rows;
  made.luminance_sigma = 4.0f;
  made.normal_power = 128.0f;
  made.depth_sigma = 1.0f;
  made.start_threshold = start_threshold;
  made.flags = flags;
  made.pixels_per_texel = 1;
  return made;
}

/// `across_first`: the first half is the one across.
kernels::AtrousHalves halves(int level, bool across_first, std::uint32_t flags,
                             float start_threshold) {
  const shared::AtrousConstants across = constants(level, 2, 0, flags, start_threshold);
  const shared::AtrousConstants down = constants(level, 0, 2, flags, start_threshold);
  kernels::AtrousHalves made =
      across_first ? kernels::AtrousHalves{across, down} : kernels::AtrousHalves{down, across};
  made.second.flags &= ~shared::atrous_keep_variance;
  return made;
}

class AtrousKernel : public testing::TestWithParam<Signal> {
 protected:
  void SetUp() override {
    if (!device().is_cpu()) GTEST_SKIP() << "host kernels run on CPU devices only";
  }
};

TEST_P(AtrousKernel, MatchesShader) {
  for (const bool orthographic : {false, true}) {
    AtrousRig rig({77, 45}, GetParam(), orthographic);
    for (const auto& [columns, rows] : {std::pair(2, 2), {2, 0}, {0, 2}}) {
      for (const int level : {0, 1, 3}) {
        for (const float threshold : {-1.0f, between_roughnesses, 2.0f}) {
          for (const std::uint32_t flags : {0u, 1u, 3u, 5u, 15u}) {
            const auto result = rig.compare(constants(level, columns, rows, flags, threshold));
            const std::string which = "kernel " + std::to_string(columns) + "," +
                                      std::to_string(rows) + " level " + std::to_string(level) +
                                      " flags " + std::to_string(flags) + " threshold " +
                                      std::to_string(threshold);
            EXPECT_LT(result.mean, 1e-4) << which;
            EXPECT_LT(result.max, 5e-3) << which;
            EXPECT_GT(result.changed, 0.01) << "the filter changes nothing: " << which;
          }
        }
      }
    }
  }
}

TEST_P(AtrousKernel, MatchesShaderAtAnySize) {
  for (const VkExtent2D extent : {VkExtent2D{1, 1}, {3, 5}, {16, 2}, {17, 31}, {130, 1}}) {
    AtrousRig rig(extent, GetParam());
    for (const int level : {0, 4}) {
      const auto result = rig.compare(constants(level, 2, 2, 5u, 2.0f));
      EXPECT_LT(result.mean, 1e-4) << extent.width << " x " << extent.height << " level " << level;
    }
  }
}

TEST_P(AtrousKernel, MatchesShaderWhereThreadsShareAFrame) {
  AtrousRig rig({600, 150}, GetParam());
  for (const auto& [columns, rows] : {std::pair(2, 2), {2, 0}, {0, 2}}) {
    for (const int level : {0, 3}) {
      const auto result = rig.compare(constants(level, columns, rows, 5u, between_roughnesses));
      EXPECT_LT(result.mean, 1e-4) << columns << "," << rows << " level " << level;
      EXPECT_LT(result.max, 5e-3) << columns << "," << rows << " level " << level;
    }
  }
}

// Between the shader's passes a signal of up to 3 holds 16 bits a channel.
TEST_P(AtrousKernel, HalvesAtOnceMatchTwoPassesOfTheShader) {
  for (const bool orthographic : {false, true}) {
    AtrousRig rig({77, 45}, GetParam(), orthographic);
    for (const bool across_first : {false, true}) {
      for (const int level : {0, 1, 3}) {
        for (const float threshold : {-1.0f, between_roughnesses, 2.0f}) {
          for (const std::uint32_t flags : {0u, 1u, 3u, 5u, 15u}) {
            const auto result = rig.compare(halves(level, across_first, flags, threshold));
            const std::string which = std::string(across_first ? "across" : "down") +
                                      " first, level " + std::to_string(level) + " flags " +
                                      std::to_string(flags) + " threshold " +
                                      std::to_string(threshold);
            EXPECT_LT(result.mean, 2e-4) << which;
            EXPECT_LT(result.max, 8e-3) << which;
            EXPECT_GT(result.changed, 0.01) << "the filter changes nothing: " << which;
          }
        }
      }
    }
  }
}

TEST_P(AtrousKernel, HalvesAtOnceMatchTwoPassesAtAnySize) {
  for (const VkExtent2D extent :
       {VkExtent2D{1, 1}, {3, 5}, {16, 2}, {17, 31}, {130, 1}, {1, 200}, {300, 400}, {650, 150}}) {
    AtrousRig rig(extent, GetParam());
    for (const bool across_first : {false, true}) {
      for (const int level : {0, 4}) {
        const auto result = rig.compare(halves(level, across_first, 5u, between_roughnesses));
        EXPECT_LT(result.mean, 5e-4) << extent.width << " x " << extent.height << " level " << level
                                     << (across_first ? " across first" : " down first");
      }
    }
  }
}

TEST_P(AtrousKernel, IsFasterThanShader) {
  AtrousRig rig({640, 360}, GetParam());
  const std::string kind = GetParam() == Signal::visibility ? "visibility" : "specular";
  double shader = 0.0, host = 0.0;
  for (const int level : {0, 3}) {
    for (const auto& [columns, rows] : {std::pair(2, 0), {0, 2}, {2, 2}}) {
      const auto [a, b] = rig.time(constants(level, columns, rows, 5u, between_roughnesses));
      shader += a;
      host += b;
      RecordProperty(
          kind + "_" + std::to_string(level) + "_" + std::to_string(columns) + std::to_string(rows),
          std::to_string(a) + " " + std::to_string(b) + " ms");
    }
  }
  std::printf("%s: shader %.2f ms, host %.2f ms, ratio %.1f\n", kind.c_str(), shader, host,
              shader / host);
  EXPECT_GT(shader, 1.5 * host);
}

INSTANTIATE_TEST_SUITE_P(Signals, AtrousKernel,
                         testing::Values(Signal::visibility, Signal::specular),
                         [](const auto& test) {
                           return test.param == Signal::visibility ? "visibility" : "specular";
                         });

}  // namespace
}  // namespace heliograph::test
