// Images whose CPU copy is released after upload must render identically, also on a new device
// after a device loss.
#include <gtest/gtest.h>

#include "render/api/renderer.hpp"
#include "scenes/generator/scenes/paper_scenes.hpp"
#include "tests/support/engine.hpp"
#include "tests/support/generated_scene.hpp"

namespace heliograph::test {
namespace {

class ReleasedImages : public testing::Test {
 protected:
  static scene::Scene textured() {
    const scenes::PaperScene& recipe = scenes::find_paper_scene("cubes_distance");
    return import_generated(recipe.make_document(recipe.make_sky(64, 32)), 64);
  }

  static std::vector<std::uint8_t> render_once(render::Engine& engine,
                                               std::shared_ptr<const render::SceneResources> scene,
                                               protocol::PrimaryVisibility source) {
    render::Renderer renderer(engine);
    protocol::Settings settings;
    settings.gbuffer.source = source;
    settings.antialiasing.temporal = false;
    settings.accumulation.max_samples = 1;
    EXPECT_TRUE(renderer.set_settings(settings));
    renderer.set_size(96, 54);
    renderer.set_camera(render::scene_of(*scene)->cameras.at(0));
    renderer.set_scene(std::move(scene));
    return renderer.render().rgba;
  }

  // Host kernels draw without the textures of the rasteriser.
  render::Engine shaders_{{.validation = true, .host_kernels = false}};
  const std::shared_ptr<const scene::Environment> white_ =
      std::make_shared<const scene::Environment>(scene::constant_environment(glm::vec3(1.0f)));
};

TEST_F(ReleasedImages, RenderSameImageAfterReleaseAndDeviceLoss) {
  auto scene = std::make_unique<scene::Scene>(textured());
  const std::uint64_t decoded = scene->bytes();
  ASSERT_FALSE(scene->images.empty());
  const auto kept = shaders_.upload(std::make_shared<const scene::Scene>(*scene), white_);
  const auto released = shaders_.upload_and_free_pixels(std::move(scene), white_);
  EXPECT_FALSE(render::scene_of(*kept)->images[0].pixels.empty());
  for (const scene::Image& image : render::scene_of(*released)->images) {
    EXPECT_TRUE(image.pixels.empty()) << image.name;
  }
  EXPECT_LT(render::scene_of(*released)->bytes(), decoded);
  const auto renewed = shaders_.renew(*released);
  for (const auto source :
       {protocol::PrimaryVisibility::rays, protocol::PrimaryVisibility::raster}) {
    const auto expected = render_once(shaders_, kept, source);
    EXPECT_EQ(render_once(shaders_, released, source), expected);
    EXPECT_EQ(render_once(shaders_, renewed, source), expected);
  }
}

// Raster textures take as much memory as the texture heap: tracing alone does not need them, nor
// does drawing on the host.
TEST_F(ReleasedImages, CpuDevicesUploadRasterTexturesOnFirstUse) {
  if (!device().is_cpu()) GTEST_SKIP() << "other devices upload them with the scene";
  const auto scene = shaders_.upload(std::make_unique<scene::Scene>(textured()), white_);
  const std::uint64_t before = render::memory_bytes(*scene);
  render_once(shaders_, scene, protocol::PrimaryVisibility::rays);
  EXPECT_EQ(render::memory_bytes(*scene), before);
  render_once(shaders_, scene, protocol::PrimaryVisibility::raster);
  EXPECT_GT(render::memory_bytes(*scene), before);

  const auto drawn = engine().upload(std::make_unique<scene::Scene>(textured()), white_);
  const std::uint64_t without = render::memory_bytes(*drawn);
  render_once(engine(), drawn, protocol::PrimaryVisibility::raster);
  EXPECT_EQ(render::memory_bytes(*drawn), without);
}

}  // namespace
}  // namespace heliograph::test
