// A scene whose geometry was shown without its textures before shares that, and looks as it does
// when it is uploaded at once.
#include <gtest/gtest.h>

#include "render/api/renderer.hpp"
#include "render/resources/scene_resources.hpp"
#include "scene/gltf/materials/materials.hpp"
#include "scene/gltf/materials/untextured.hpp"
#include "scenes/generator/scenes/paper_scenes.hpp"
#include "tests/support/engine.hpp"
#include "tests/support/generated_scene.hpp"

namespace heliograph::test {
namespace {

class FirstViewUpload : public testing::Test {
 protected:
  using Resources = std::shared_ptr<const render::SceneResources>;

  static scene::Scene textured() {
    const scenes::PaperScene& recipe = scenes::find_paper_scene("cubes_distance");
    return import_generated(recipe.make_document(recipe.make_sky(64, 32)), 64);
  }

  static std::vector<std::uint8_t> render(const Resources& scene) {
    render::Renderer renderer(engine());
    protocol::Settings settings;
    settings.antialiasing.temporal = false;
    settings.accumulation.max_samples = 1;
    EXPECT_TRUE(renderer.set_settings(settings));
    renderer.set_size(96, 54);
    renderer.set_camera(render::scene_of(*scene)->cameras.at(0));
    renderer.set_scene(scene);
    return renderer.render().rgba;
  }

  Resources upload_first(const scene::Scene& scene) const {
    return engine().upload(std::make_shared<const scene::Scene>(scene::without_textures(scene)),
                           white_);
  }
  Resources upload_after(const scene::Scene& scene, const Resources& first) const {
    return engine().upload_and_free_pixels(std::make_unique<scene::Scene>(scene), white_, {},
                                           first);
  }

  const std::shared_ptr<const scene::Environment> white_ =
      std::make_shared<const scene::Environment>(scene::constant_environment(glm::vec3(1.0f)));
};

TEST_F(FirstViewUpload, SharesGeometryAndLooksAsWithoutIt) {
  const scene::Scene scene = textured();
  const std::vector<std::uint8_t> expected = render(upload_after(scene, nullptr));
  Resources first = upload_first(scene);
  EXPECT_NE(render(first), expected) << "it has no textures";
  const Resources whole = upload_after(scene, first);
  EXPECT_EQ(whole->rest_tables.vertices.handle(), first->rest_tables.vertices.handle());
  EXPECT_EQ(whole->rest_tables.indices.handle(), first->rest_tables.indices.handle());
  EXPECT_NE(whole->rest_tables.materials.handle(), first->rest_tables.materials.handle());
  EXPECT_EQ(whole->rest_structure, first->rest_structure);
  EXPECT_EQ(render(whole), expected);
  EXPECT_GE(whole->bytes(), first->bytes() + whole->texture_heap.texels.size() +
                                whole->texture_heap.textures.size() +
                                whole->rest_tables.materials.size())
      << "what stays of the first view is counted";
  first.reset();
  EXPECT_EQ(render(whole), expected) << "what is shared stays";
}

TEST_F(FirstViewUpload, HasAnotherStructureWhereRaysLookUpMasks) {
  scene::Scene scene = textured();
  for (shared::Material& material : scene.materials) {
    if (material.base_color_texture.texture == shared::no_texture) continue;
    material.flags |= shared::material_alpha_mask;
    material.alpha_cutoff = 0.5f;
  }
  scene::build_alpha_heap(scene);
  ASSERT_FALSE(scene.alpha_heap.empty());
  scene::Scene plain = scene;
  for (shared::Material& material : plain.materials) material.alpha_mask = shared::no_texture;
  Resources first = upload_first(plain);
  const Resources whole = upload_after(scene, first);
  EXPECT_EQ(whole->rest_tables.vertices.handle(), first->rest_tables.vertices.handle());
  EXPECT_NE(whole->rest_structure, first->rest_structure);
  const std::weak_ptr<const tracing::AccelerationStructure> structure = first->rest_structure;
  first.reset();
  EXPECT_TRUE(structure.expired()) << "nothing traces it any more";
  EXPECT_EQ(render(whole), render(upload_after(scene, nullptr))) << "the geometry stays";
}

}  // namespace
}  // namespace heliograph::test
