// On processors a scene may be larger than what shaders can bind: kernels read it.
#include <gtest/gtest.h>

#include "render/api/renderer.hpp"
#include "scene/import_error.hpp"
#include "tests/support/engine.hpp"
#include "tests/support/scene_builder.hpp"

namespace heliograph::test {
namespace {

/// A lit quad, before whose vertices `unused` others stand that no triangle has.
std::shared_ptr<const scene::Scene> quad_behind(std::size_t unused) {
  SceneBuilder builder;
  const shared::Material white = surface(glm::vec3(0.8f));
  const auto mesh = builder.add_quad({{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}}, white);
  builder.place(mesh).add_sun({0.3f, -0.2f, -1.0f}, glm::vec3(2.0f));
  auto scene = std::make_shared<scene::Scene>(*builder.build());
  auto& vertices = scene->meshes[mesh].vertices;
  auto& indices = scene->meshes[mesh].indices;
  vertices.insert(vertices.begin(), unused, vertices.front());
  for (std::uint32_t& index : indices) index += static_cast<std::uint32_t>(unused);
  return scene;
}

std::vector<std::uint8_t> image_of(std::shared_ptr<const scene::Scene> scene,
                                   protocol::PrimaryVisibility source) {
  render::Renderer renderer(engine());
  protocol::Settings settings;
  settings.gbuffer.source = source;
  settings.antialiasing.temporal = false;
  EXPECT_TRUE(renderer.set_settings(settings));
  renderer.set_size(64, 36);
  renderer.set_camera(look({0, 0, 3}, {0, 0, 0}));
  renderer.set_scene(
      engine().upload(std::move(scene), scene::constant_environment({0.2f, 0.2f, 0.2f})));
  return renderer.render().rgba;
}

class LargeScene : public testing::Test {
 protected:
  void SetUp() override {
    if (!device().is_cpu()) GTEST_SKIP() << "of devices that are processors";
    if (device().limits().maxStorageBufferRange > 1u << 28) GTEST_SKIP() << "needs too much memory";
  }

  const std::size_t more_than_bound_ =
      device().limits().maxStorageBufferRange / sizeof(shared::Vertex) + 1;
};

TEST_F(LargeScene, LooksLikeASmallOneWithTheSameTriangles) {
  if (!engine().parts().host_kernels) GTEST_SKIP() << "of kernels";
  for (const auto source :
       {protocol::PrimaryVisibility::rays, protocol::PrimaryVisibility::raster}) {
    const auto expected = image_of(quad_behind(0), source);
    EXPECT_EQ(image_of(quad_behind(more_than_bound_), source), expected);
  }
}

TEST_F(LargeScene, IsRefusedWithTheLimitWhereShadersReadIt) {
  render::Engine shaders({.validation = true, .host_kernels = false});
  const auto around = scene::constant_environment(glm::vec3(1.0f));
  try {
    shaders.upload(quad_behind(more_than_bound_), around);
    ADD_FAILURE() << "was not refused";
  } catch (const scene::ImportError& error) {
    EXPECT_NE(std::string(error.what()).find("this device binds at most"), std::string::npos)
        << error.what();
  }
}

TEST_F(LargeScene, IsNotRenderedByShadersThatCannotReadIt) {
  if (!engine().parts().host_kernels) GTEST_SKIP() << "of kernels";
  render::Renderer renderer(engine());
  protocol::Settings settings;
  settings.reference.use = protocol::ReferenceUse::always;
  settings.reference.scope = protocol::ReferenceScope::same_paths;
  EXPECT_TRUE(renderer.set_settings(settings));
  renderer.set_size(64, 36);
  renderer.set_scene(
      engine().upload(quad_behind(more_than_bound_), scene::constant_environment(glm::vec3(1.0f))));
  EXPECT_THROW(renderer.render(), gpu::GpuError);
}

}  // namespace
}  // namespace heliograph::test
