#include <gtest/gtest.h>

#include <glm/gtc/packing.hpp>

#include "render/kernels/specular.hpp"
#include "render/passes/gbuffer/trace_gbuffer.hpp"
#include "render/passes/reflections/trace_specular.hpp"
#include "scene/import.hpp"
#include "shaders/shared/sampling.h"
#include "tests/gpu/support/kernel_comparison.hpp"
#include "tests/gpu/support/textured_scene.hpp"
#include "tests/support/scene_files.hpp"

namespace heliograph::test {
namespace {

/// The scene on a reflective floor, lit by every type of light.
std::shared_ptr<const scene::Scene> lit(const scene::Scene& from) {
  auto made = std::make_shared<scene::Scene>(from);
  const float size = from.bounds.radius();
  SceneBuilder builder;
  builder.add_sun({0.3f, -0.5f, -1.0f}, {3, 2, 1}, 2.0f);
  builder.add_point_light(glm::vec3(1.5f, 1, 1) * size, glm::vec3(4, 5, 6) * size * size,
                          0.1f * size);
  builder.add_point_light(glm::vec3(-1.5f, 0, 1) * size, glm::vec3(1, 0, 2) * size * size);
  const float y = from.bounds.minimum.y, wide = 3.0f * size;
  builder.place(
      builder.add_quad({{{-wide, y, wide}, {wide, y, wide}, {wide, y, -wide}, {-wide, y, -wide}}},
                       surface({0.8f, 0.7f, 0.6f}, 0.25f, 0.6f)));
  const scene::Scene added = *builder.build();
  made->lights = added.lights;
  made->lights.back().device.range = 3.0f * size;
  scene::Light spot = made->lights[1];
  spot.device.type = shared::light_spot;
  spot.device.position = glm::vec3(0, 1, 2) * size;
  spot.device.direction = glm::normalize(glm::vec3(0, -0.4f, -1));
  spot.device.spot_scale = 4.0f;
  spot.device.spot_offset = -3.0f;
  made->lights.push_back(spot);
  scene::Mesh floor = added.meshes[0];
  floor.material = static_cast<std::uint32_t>(made->materials.size());
  made->materials.push_back(added.materials[added.meshes[0].material]);
  made->meshes.push_back(floor);
  made->instances.push_back({static_cast<std::uint32_t>(made->meshes.size() - 1),
                             static_cast<std::uint32_t>(made->nodes.size())});
  made->nodes.push_back({.name = "floor", .parent = {}});
  made->bounds.include({-wide, y, -wide});
  made->bounds.include({wide, y, wide});
  return made;
}

struct View {
  VkExtent2D extent{150, 100};
  protocol::Settings settings;
  bool with_plan = false;      // a third of the pixels is traced, a third looked up
  std::optional<float> shown;  // shadow visibility of the frame before, which showed what is hit
};

scene::Environment sky() {
  return make_environment(128, [](const glm::vec3& d) {
    return glm::vec3(1.0f + d.y, 0.5f + 0.4f * d.x * d.z, 1.0f - d.x);
  });
}

/// Reflections of one G-buffer by the shaders and by the host kernels.
class KernelComparison {
 public:
  KernelComparison(std::shared_ptr<const scene::Scene> scene, const View& view)
      : rig_(scene, camera(*scene),
             {.extent = view.extent, .environment = sky(), .settings = view.settings}),
        gbuffer_(render::trace_gbuffer(rig_.plan(), with_host_kernels(rig_, true))),
        planned_(view.with_plan ? std::optional(plan(view.extent)) : std::nullopt),
        visibility_(view.shown ? std::optional(shown(view)) : std::nullopt),
        shader_(trace(false)),
        host_(trace(true)) {
    if (view.shown) rig_.run();  // the frame before
    rig_.set_view(camera(*scene), 6);
    rig_.run();
  }

  FrameRig& rig() { return rig_; }

  /// `outliers`: permitted fraction of values that differ by more than 0.01.
  void expect_equal(const std::string& which, double outliers = 6e-3) const {
    const ErrorStatistics error = compare(rig_.read(shader_), rig_.read(host_));
    EXPECT_GT(error.magnitude, 0.05) << which << ": no reflections";
    // Rounding may send a ray past an edge or select another light.
    EXPECT_LT(error.mean, 0.3 * outliers) << which;
    EXPECT_LT(error.outliers, outliers) << which;
  }

  /// Mean red of the host kernels' reflections.
  double brightness() const {
    const render::FloatImage image = rig_.read(host_);
    double sum = 0.0;
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) sum += image.rgba[i];
    return sum / double(image.rgba.size());
  }

 private:
  static scene::Camera camera(const scene::Scene& scene) {
    scene::Camera made = scene::fit_camera(scene.bounds, 25.0f, 1.5f);
    made.eye.y += 0.3f * scene.bounds.radius();
    return made;
  }

  gpu::ImageRef plan(VkExtent2D extent) {
    std::vector<std::uint32_t> words(std::size_t{extent.width} * extent.height);
    for (std::size_t i = 0; i < words.size(); ++i) {
      // 1.5 metres in the frame before
      const std::uint32_t sampled[] = {shared::plan_specular, 0u,
                                       shared::plan_specular | shared::plan_environment};
      words[i] =
          sampled[i * 7919 % 3] | 0x3fc0u | std::uint32_t(i % 256) << shared::plan_visibility_shift;
    }
    return rig_.input("planned", VK_FORMAT_R32_UINT, words);
  }
  gpu::ImageRef shown(const View& view) {
    const std::size_t pixels = std::size_t{view.extent.width} * view.extent.height;
    return rig_.input("visibility", VK_FORMAT_R16G16B16A16_UNORM,
                      std::vector(pixels, glm::packUnorm4x16(glm::vec4(*view.shown))));
  }
  gpu::ImageRef trace(bool host) {
    return render::trace_specular(rig_.plan(), with_host_kernels(rig_, host), gbuffer_, planned_,
                                  visibility_);
  }

  FrameRig rig_;
  render::GBuffer gbuffer_;
  std::optional<gpu::ImageRef> planned_, visibility_;
  gpu::ImageRef shader_, host_;
};

class SpecularKernel : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_host_kernels()) GTEST_SKIP() << "host kernels run on CPU devices only";
  }
};

TEST_F(SpecularKernel, MatchesShaders) {
  const auto scene = lit(*textured_scene());
  View view;
  KernelComparison(scene, view).expect_equal("all light");
  view.with_plan = true;
  KernelComparison(scene, view).expect_equal("by plan");
  view.shown = 0.5f;
  KernelComparison(scene, view).expect_equal("shadows of the frame before");
  view.with_plan = false;
  view.shown.reset();
  view.settings.specular.half_resolution = true;
  KernelComparison(scene, view).expect_equal("half resolution");
  view.settings.specular.half_resolution = false;
  view.settings.specular.hit_shading = protocol::HitShading::environment;
  KernelComparison(scene, view).expect_equal("no analytic lights");
  view.settings.specular.hit_shading = protocol::HitShading::traced;
  view.settings.shadows.enabled = false;
  view.settings.lighting.environment_specular = false;
  view.settings.specular.max_roughness = 0.3f;
  KernelComparison(scene, view).expect_equal("no shadows, no sky");
}

TEST_F(SpecularKernel, TakesShadowsFromTheFrameBefore) {
  const auto scene = lit(*textured_scene());
  const auto brightness = [&](std::optional<float> shown) {
    View view;
    view.shown = shown;
    return KernelComparison(scene, view).brightness();
  };
  const double dark = brightness(0.0f), traced = brightness({}), bright = brightness(1.0f);
  EXPECT_GT(traced, dark + 0.1 * (bright - dark)) << dark << " " << bright;
  EXPECT_LT(traced, bright);
  EXPECT_GT(bright, 1.01 * dark);
}

TEST_F(SpecularKernel, MatchesShadersForDamagedHelmet) {
  const auto file = asset("gltf/DamagedHelmet.glb");
  if (!file) GTEST_SKIP() << "HELIOGRAPH_TEST_ASSETS is not set";
  KernelComparison(lit(scene::import_gltf(*file)), {}).expect_equal("helmet");
}

TEST_F(SpecularKernel, MatchesShadersAtAnySize) {
  const auto scene = lit(*textured_scene());
  for (const VkExtent2D extent : {VkExtent2D{5, 3}, {17, 31}, {130, 7}}) {
    for (const bool half : {false, true}) {
      View view{extent, {}};
      view.settings.specular.half_resolution = half;
      KernelComparison(scene, view)
          .expect_equal(std::to_string(extent.width) + " x " + std::to_string(extent.height), 0.05);
    }
  }
}

TEST_F(SpecularKernel, IsFasterThanShaders) {
  KernelComparison comparison(lit(*textured_scene()), {.extent = {640, 360}, .settings = {}});
  expect_faster(comparison.rig(), {"specular.rays", "specular.shade", "specular.resolve"}, 2.0);
}

}  // namespace
}  // namespace heliograph::test
