#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "render/kernels/visibility_half.hpp"
#include "render/passes/denoise/denoise_visibility.hpp"
#include "render/passes/formats.hpp"
#include "shaders/embedded.hpp"
#include "tests/gpu/support/kernel_comparison.hpp"
#include "tests/support/frame_rig.hpp"

namespace heliograph::test {
namespace {

namespace kernels = render::kernels;
using render::formats::four_floats;

constexpr auto two_floats = VK_FORMAT_R32G32_SFLOAT;

/// Two planes with holes, and any signal.
struct Field {
  std::vector<glm::vec4> guide, signal;
  std::vector<glm::vec2> slope;
};

constexpr glm::vec2 field_slope(0.02f, 0.001f);

template <class Signal>
Field make_field(VkExtent2D extent, bool holes, const Signal& signal) {
  Field field;
  for (std::uint32_t y = 0; y < extent.height; ++y) {
    for (std::uint32_t x = 0; x < extent.width; ++x) {
      const bool hole = holes && (x % 19 == 7 || (x / 3 + y / 2) % 7 == 3);
      const bool far = holes && x > extent.width / 2;
      // Planes in perspective: 1 / Z is linear across the frame.
      const glm::vec2 pixel(x, y);
      const float z0 = far ? 4.0f : 3.0f;
      const float view_z = 1.0f / (1.0f / z0 - glm::dot(field_slope, pixel) / (z0 * z0) * 0.5f);
      const glm::vec3 normal = glm::normalize(glm::vec3(far ? -0.6f : 0.2f, 1.0f, 0.3f));
      field.guide.emplace_back(hole ? glm::vec3(0.0f) : normal * 1.4f, hole ? 0.0f : view_z);
      field.slope.push_back(hole ? glm::vec2(0.0f)
                                 : view_z * view_z * field_slope / (z0 * z0) * 0.5f);
      field.signal.push_back(signal(x, y));
    }
  }
  return field;
}

shared::AtrousConstants make_constants(std::uint32_t flags) {
  return {.luminance_sigma = 4.0f,
          .normal_power = 128.0f,
          .depth_sigma = 1.0f,
          .start_threshold = 2.0f,
          .flags = flags,
          .pixels_per_texel = 1};
}

/// Visibility halved and upsampled again, without a blur between.
class HalfRig {
 public:
  struct Images {
    gpu::ImageRef guide, slope, signal, denoised;
  };

  HalfRig(VkExtent2D extent, const Field& field, std::uint32_t flags, bool orthographic = false)
      : constants_(make_constants(flags)),
        rig_(SceneBuilder().build(), camera(orthographic), {.extent = extent}) {
    guide_ = rig_.input("guide", four_floats, field.guide);
    slope_ = rig_.input("slope", two_floats, field.slope);
    signal_ = rig_.input("signal", four_floats, field.signal);
    by_shader = declare("shader", false);
    if (device().is_cpu()) by_host = declare("host", true);
    rig_.set_view(camera(orthographic), 5);
    rig_.run();
  }

  render::FloatImage read(gpu::ImageRef image) const { return rig_.read(image); }

  Images by_shader, by_host;

 private:
  static scene::Camera camera(bool orthographic) {
    scene::Camera made = look({0, 0, 3}, {0, 0, 0});
    if (orthographic) made.orthographic_height = 4.0f;
    return made;
  }

  Images declare(const std::string& name, bool host) {
    gpu::FramePlan& plan = rig_.plan();
    const auto half = gpu::FrameSize::squares(2);
    const Images made{plan.image(name + ".guide", four_floats, 0, half),
                      plan.image(name + ".slope", two_floats, 0, half),
                      plan.image(name + ".signal", four_floats, 0, half),
                      plan.image(name + ".denoised", four_floats)};
    plan.use_host_kernels(host);
    const auto& buffers = render::half_visibility_buffers;
    const render::PackedGuide packed =
        render::declare_packed_guide(plan, buffers.guide, buffers.slope, half);
    plan.pass(name + ".halve", rig_.inputs().program(shaders::visibility_halve))
        .bind<kernels::VisibilityHalveBindings>({.guide = guide_,
                                                 .depth_slope = slope_,
                                                 .signal = signal_,
                                                 .half_guide = made.guide,
                                                 .half_slope = made.slope,
                                                 .half_signal = made.signal,
                                                 .packed_guide = packed.surface,
                                                 .packed_slope = packed.slope})
        .constants([this] { return constants_; })
        .dispatch(half)
        .host(kernels::visibility_halve, rig_.constants());
    plan.pass(name + ".upsample", rig_.inputs().program(shaders::visibility_upsample))
        .bind<kernels::VisibilityUpsampleBindings>({.guide = guide_,
                                                    .depth_slope = slope_,
                                                    .signal = signal_,
                                                    .half_guide = made.guide,
                                                    .half_signal = made.signal,
                                                    .denoised = made.denoised})
        .constants([this] { return constants_; })
        .dispatch(gpu::each_pixel())
        .host(kernels::visibility_upsample, rig_.constants());
    return made;
  }

  shared::AtrousConstants constants_;
  FrameRig rig_;
  gpu::ImageRef guide_, slope_, signal_;
};

void expect_near(const render::FloatImage& expected, const render::FloatImage& actual, double most,
                 const std::string& which) {
  ASSERT_EQ(expected.rgba.size(), actual.rgba.size()) << which;
  const ErrorStatistics off = compare(expected, actual);
  EXPECT_LT(off.mean, 0.02 * most) << which;
  EXPECT_LT(off.max, most) << which;
}

TEST(VisibilityHalfKernels, MatchShaders) {
  if (!device().is_cpu()) GTEST_SKIP() << "host kernels run on CPU devices only";
  for (const VkExtent2D extent :
       {VkExtent2D{1, 1}, {2, 3}, {3, 5}, {31, 7}, {32, 8}, {77, 45}, {130, 90}}) {
    for (const std::uint32_t flags : {0u, shared::atrous_variance_prefilter}) {
      for (const bool orthographic : {false, true}) {
        std::mt19937 random(7);
        std::uniform_real_distribution<float> unit(0.0f, 1.0f);
        const Field field = make_field(extent, true, [&](std::uint32_t, std::uint32_t) {
          const float noise = 0.1f * unit(random);
          return glm::vec4(unit(random) < 0.3f, unit(random) < 0.7f, noise, 0.5f * noise);
        });
        HalfRig rig(extent, field, flags, orthographic);
        const std::string which = std::to_string(extent.width) + " x " +
                                  std::to_string(extent.height) + " flags " +
                                  std::to_string(flags) + (orthographic ? " orthographic" : "");
        const auto same = [&](gpu::ImageRef HalfRig::Images::*image, double most) {
          expect_near(rig.read(rig.by_shader.*image), rig.read(rig.by_host.*image), most, which);
        };
        same(&HalfRig::Images::guide, 1e-7);
        same(&HalfRig::Images::slope, 1e-7);
        same(&HalfRig::Images::signal, 2.5e-3);
        same(&HalfRig::Images::denoised, 2.5e-3);
      }
    }
  }
}

/// Root mean square of what the first channel is off `expected(x, y)` by.
template <class Expected>
double off_by(const render::FloatImage& image, const Expected& expected) {
  double sum = 0.0;
  for (std::uint32_t y = 0; y < image.height; ++y) {
    for (std::uint32_t x = 0; x < image.width; ++x) {
      const double off = texel(image, x, y).x - expected(x, y);
      sum += off * off;
    }
  }
  return std::sqrt(sum / (image.width * image.height));
}

TEST(VisibilityUpsample, KeepsWhatIsKnownAtFullSize) {
  // The borders of shadows lie anywhere; without noise they stay where they are.
  const auto shadow = [](std::uint32_t x, std::uint32_t y) {
    return (x * 5 + y * 3) % 31 < 13 ? 1.0 : 0.0;
  };
  const Field field = make_field({64, 48}, false, [&](std::uint32_t x, std::uint32_t y) {
    return glm::vec4(shadow(x, y), shadow(y, x), 0.0f, 0.0f);
  });
  HalfRig rig({64, 48}, field, shared::atrous_variance_prefilter);
  EXPECT_LT(off_by(rig.read(rig.by_shader.denoised), shadow), 1e-3);
}

TEST(VisibilityUpsample, AveragesNoise) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  const Field field = make_field({64, 48}, false, [&](std::uint32_t, std::uint32_t) {
    return glm::vec4(unit(random) < 0.5f, 0.5f, 0.25f, 0.0f);
  });
  HalfRig rig({64, 48}, field, shared::atrous_variance_prefilter);
  const auto mean = [](std::uint32_t, std::uint32_t) { return 0.5; };
  const render::FloatImage denoised = rig.read(rig.by_shader.denoised);
  // A square of four pixels has half the deviation of one, 0.5; four of them less.
  EXPECT_LT(off_by(denoised, mean), 0.2);
  EXPECT_GT(off_by(denoised, mean), 0.08);
  // The variance that is left is that of the mean.
  const double left = off_by(denoised, mean) * off_by(denoised, mean);
  EXPECT_NEAR(texel(denoised, 32, 24).z / left, 1.0, 0.5);
}

}  // namespace
}  // namespace heliograph::test
