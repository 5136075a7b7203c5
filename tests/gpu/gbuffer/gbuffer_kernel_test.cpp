#include <gtest/gtest.h>

#include "render/kernels/gbuffer/gbuffer_hits.hpp"
#include "render/passes/gbuffer/trace_gbuffer.hpp"
#include "scene/import.hpp"
#include "tests/gpu/support/kernel_comparison.hpp"
#include "tests/gpu/support/textured_scene.hpp"
#include "tests/support/scene_files.hpp"

namespace heliograph::test {
namespace {

std::shared_ptr<const scene::Scene> helmet() {
  const auto file = asset("gltf/DamagedHelmet.glb");
  return file ? std::make_shared<const scene::Scene>(scene::import_gltf(*file)) : nullptr;
}

scene::Camera view_of(const scene::Scene& scene, bool orthographic) {
  scene::Camera camera = scene::fit_camera(scene.bounds, 40.0f, 1.5f);
  if (orthographic) camera.orthographic_height = 2.2f * scene.bounds.radius();
  return camera;
}

/// The G-buffer by the shaders and by the host kernels.
class KernelComparison {
 public:
  KernelComparison(std::shared_ptr<const scene::Scene> scene, const scene::Camera& camera,
                   VkExtent2D extent, protocol::ShadingMode mode = protocol::ShadingMode::lit)
      : rig_(std::move(scene), camera, {.extent = extent, .settings = shown_as(mode)}),
        shader_(render::trace_gbuffer(rig_.plan(), with_host_kernels(rig_, false))),
        host_(render::trace_gbuffer(rig_.plan(), with_host_kernels(rig_, true))) {
    scene::Camera moved = camera;
    moved.eye += glm::vec3(0.05f, -0.02f, 0.03f);
    rig_.set_view(moved, 3);
    rig_.run();
  }

  FrameRig& rig() { return rig_; }

  void expect_equal(const std::string& which) const {
    expect_same_gbuffer(rig_, shader_, host_, which);
  }

 private:
  static protocol::Settings shown_as(protocol::ShadingMode mode) {
    protocol::Settings settings = without_indirect();
    settings.view.shading = mode;
    return settings;
  }

  FrameRig rig_;
  render::GBuffer shader_, host_;
};

class GBufferKernel : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_host_kernels()) GTEST_SKIP() << "host kernels run on CPU devices only";
  }
};

TEST_F(GBufferKernel, MatchesShaders) {
  for (const bool orthographic : {false, true}) {
    const std::string view = orthographic ? "orthographic" : "perspective";
    for (const auto& [name, scene] :
         {std::pair("textured", textured_scene()), std::pair("transparent", transparent_scene())}) {
      KernelComparison(scene, view_of(*scene, orthographic), {150, 100})
          .expect_equal(name + (", " + view));
    }
  }
}

TEST_F(GBufferKernel, MatchesShadersInEveryShadingMode) {
  const auto scene = textured_scene();
  using enum protocol::ShadingMode;
  for (const auto mode : {wireframe, clay, matcap, uv_checker, normals}) {
    KernelComparison(scene, view_of(*scene, false), {150, 100}, mode)
        .expect_equal(std::string(protocol::enum_name(mode)));
  }
}

TEST_F(GBufferKernel, MatchesShadersForDamagedHelmet) {
  const auto scene = helmet();
  if (!scene) GTEST_SKIP() << "HELIOGRAPH_TEST_ASSETS is not set";
  KernelComparison(scene, view_of(*scene, false), {150, 100}).expect_equal("helmet");
}

TEST_F(GBufferKernel, MatchesShadersAtAnySize) {
  const auto scene = textured_scene();
  for (const VkExtent2D extent : {VkExtent2D{1, 1}, {3, 5}, {16, 2}, {17, 31}, {130, 1}}) {
    KernelComparison(scene, view_of(*scene, false), extent)
        .expect_equal(std::to_string(extent.width) + " x " + std::to_string(extent.height));
  }
}

TEST_F(GBufferKernel, IsFasterThanShaders) {
  const auto scene = textured_scene();
  KernelComparison comparison(scene, view_of(*scene, false), {640, 360});
  expect_faster(comparison.rig(), {"gbuffer.rays", "gbuffer.hits", "gbuffer.2.hits"}, 2.0);
}

}  // namespace
}  // namespace heliograph::test
