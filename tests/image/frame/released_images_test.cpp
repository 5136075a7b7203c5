// What lets go of its pixels once they are on the device must look as before, there and on the
// device that comes after a loss.
#include <gtest/gtest.h>

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

  static std::vector<std::uint8_t> picture(std::shared_ptr<const render::SceneResources> scene,
                                           protocol::PrimaryVisibility source) {
    render::Renderer renderer(engine());
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

  const std::shared_ptr<const scene::Environment> white_ =
      std::make_shared<const scene::Environment>(scene::constant_environment(glm::vec3(1.0f)));
};

TEST_F(ReleasedImages, RenderSameImageAfterReleaseAndDeviceLoss) {
  auto given_away = std::make_unique<scene::Scene>(textured());
  const std::uint64_t decoded = given_away->bytes();
  ASSERT_FALSE(given_away->images.empty());
  const auto kept = engine().upload(std::make_shared<const scene::Scene>(*given_away), white_);
  const auto released = engine().upload(std::move(given_away), white_);
  EXPECT_FALSE(render::scene_of(*kept)->images[0].pixels.empty());
  for (const scene::Image& image : render::scene_of(*released)->images) {
    EXPECT_TRUE(image.pixels.empty()) << image.name;
  }
  EXPECT_LT(render::scene_of(*released)->bytes(), decoded);
  const auto renewed = engine().renew(*released);
  for (const auto source :
       {protocol::PrimaryVisibility::rays, protocol::PrimaryVisibility::raster}) {
    const auto expected = picture(kept, source);
    EXPECT_EQ(picture(released, source), expected);
    EXPECT_EQ(picture(renewed, source), expected);
  }
}

// Textures for the rasteriser are as large as the heap: who does not rasterise does not need them.
TEST_F(ReleasedImages, CpuDevicesUploadRasterTexturesOnFirstUse) {
  if (!device().is_cpu()) GTEST_SKIP() << "other devices have them from the start";
  const auto scene = engine().upload(std::make_unique<scene::Scene>(textured()), white_);
  const std::uint64_t before = render::memory_bytes(*scene);
  picture(scene, protocol::PrimaryVisibility::rays);
  EXPECT_EQ(render::memory_bytes(*scene), before);
  picture(scene, protocol::PrimaryVisibility::raster);
  EXPECT_GT(render::memory_bytes(*scene), before);
}

}  // namespace
}  // namespace heliograph::test
