#include <gtest/gtest.h>

#include "render/passes/denoise/denoise_indirect.hpp"
#include "render/passes/formats.hpp"
#include "tests/gpu/support/kernel_comparison.hpp"

namespace heliograph::test {
namespace {

protocol::Settings gathered() {
  protocol::Settings settings;
  settings.indirect.enabled = settings.indirect.half_resolution = true;
  return settings;
}

scene::Camera camera() {
  return look({0, 0, 3}, {0, 0, 0});
}

/// Indirect light of the same frames denoised by the shaders and by the host kernels.
class HalfRig {
 public:
  explicit HalfRig(VkExtent2D extent)
      : rig_(SceneBuilder().build(), camera(), {.extent = extent, .settings = gathered()}) {
    rig_.invalidate_history();
  }

  FrameRig& rig() { return rig_; }

  void denoise(const render::GBuffer& gbuffer, gpu::ImageRef noisy) {
    const render::Guide guide = render::reproject(rig_.plan(), rig_.inputs(), gbuffer);
    const auto declare = [&](bool host) {
      const render::FrameInputs& in = with_host_kernels(rig_, host);
      const auto histories = render::declare_sample_histories(rig_.plan(), in.settings);
      return render::denoise_indirect(rig_.plan(), in, gbuffer, guide, histories, noisy);
    };
    by_shader = declare(false);
    by_host = declare(true);
  }

  void run(std::uint32_t frames) {
    for (std::uint32_t i = 0; i < frames; ++i) {
      rig_.set_view(camera(), i);
      rig_.run();
    }
  }

  gpu::ImageRef by_shader, by_host;

 private:
  FrameRig rig_;
};

TEST(IndirectHalfKernels, MatchShaders) {
  if (!device().is_cpu()) GTEST_SKIP() << "host kernels run on CPU devices only";
  for (const VkExtent2D extent : {VkExtent2D{2, 3}, {31, 7}, {32, 8}, {77, 45}}) {
    HalfRig half(extent);
    RandomFrame random(half.rig());
    const render::GBuffer gbuffer = random.gbuffer();
    half.denoise(gbuffer, random.four("radiance", {0, 0, 0, -0.4f}, {2, 2, 2, 0.6f}));
    half.run(3);
    const ErrorStatistics off =
        compare(half.rig().read(half.by_shader), half.rig().read(half.by_host));
    EXPECT_LT(off.mean, 2e-3) << extent.width;
    EXPECT_LT(off.outliers, 0.02) << extent.width;
  }
}

/// A dark surface on the left of `edge`, a bright one on the right, of which every second pixel was
/// sampled.
struct TwoSurfaces {
  VkExtent2D extent;
  std::uint32_t edge;

  template <class Texel, class Value>
  std::vector<Texel> texels(const Value& value) const {
    std::vector<Texel> made;
    for (std::uint32_t y = 0; y < extent.height; ++y) {
      for (std::uint32_t x = 0; x < extent.width; ++x) made.push_back(value(x, y, x >= edge));
    }
    return made;
  }

  gpu::ImageRef radiance(FrameRig& rig) const {
    return rig.input("radiance", render::formats::four_floats,
                     texels<glm::vec4>([](std::uint32_t x, std::uint32_t y, bool right) {
                       return glm::vec4(glm::vec3(right ? 1.0f : 0.0f), (x ^ y) & 1 ? 1.0f : -1.0f);
                     }));
  }
  render::GBuffer gbuffer(FrameRig& rig) const {
    const auto four = [&](const std::string& name, const auto& value) {
      return rig.input(name, render::formats::four_floats, texels<glm::vec4>(value));
    };
    render::GBuffer made{};
    made.normals = made.previous_normals =
        four("normals", [](auto, auto, bool right) { return glm::vec4(right ? 0.4f : 0.0f); });
    made.motion = made.previous_motion =
        four("motion", [](auto, auto, bool right) { return glm::vec4(0, 0, 0, right ? 2 : 3); });
    made.depth_slope =
        rig.input("slope", VK_FORMAT_R32G32_SFLOAT,
                  texels<glm::vec2>([](auto, auto, bool) { return glm::vec2(0.0f); }));
    made.surface = made.previous_surface =
        rig.input("surface", VK_FORMAT_R8G8B8A8_UNORM,
                  texels<std::uint32_t>([](auto, auto, bool) { return 0x80u; }));
    made.instance = made.previous_instance =
        rig.input("instance", VK_FORMAT_R32_UINT,
                  texels<std::uint32_t>([](auto, auto, bool right) { return right ? 2u : 1u; }));
    return made;
  }
};

TEST(IndirectHalf, KeepsSurfacesApart) {
  // The edge cuts squares in two, and the border too.
  const TwoSurfaces surfaces{{61, 37}, 31};
  HalfRig half(surfaces.extent);
  half.denoise(surfaces.gbuffer(half.rig()), surfaces.radiance(half.rig()));
  half.run(4);
  for (const gpu::ImageRef image : {half.by_shader, half.by_host}) {
    const render::FloatImage denoised = half.rig().read(image);
    for (std::uint32_t y = 0; y < surfaces.extent.height; ++y) {
      for (std::uint32_t x = 0; x < surfaces.extent.width; ++x) {
        const float expected = x >= surfaces.edge ? 1.0f : 0.0f;
        EXPECT_NEAR(texel(denoised, x, y).x, expected, 0.02f) << x << ", " << y;
      }
    }
  }
}

}  // namespace
}  // namespace heliograph::test
