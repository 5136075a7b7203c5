// Materials whose extensions are edited render as those that were imported with the same values.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scene/gltf/materials/layer_table.hpp"
#include "tests/image/support/renderer_rig.hpp"

namespace heliograph::test {
namespace {

using scene::MaterialLayers;

struct Extensions {
  MaterialLayers layers;
  float ior = 1.5f;
};

Extensions coated(float amount) {
  Extensions made;
  made.layers.clearcoat = amount;
  made.layers.clearcoat_roughness = 0.1f;
  return made;
}

Extensions velvet(float strength) {
  Extensions made;
  made.layers.sheen_color = glm::vec3(strength, 0.5f * strength, 0.5f * strength);
  made.layers.sheen_roughness = 0.5f;
  return made;
}

Extensions dense(float ior) {
  return {.layers = {}, .ior = ior};
}

glm::vec3 bright_sky(const glm::vec3& d) {
  return glm::vec3(1.0f, 0.9f, 0.8f) + 0.2f * d.y;
}

/// A dark ball, the first material, above a plain floor. Its coat has a texture, which only counts
/// where there is a coat.
std::shared_ptr<const scene::Scene> ball(Extensions extensions) {
  SceneBuilder builder;
  const std::vector<std::uint8_t> halves{255, 0, 0, 255, 128, 0, 0, 255};
  extensions.layers.clearcoat_texture = scene::no_texture_slot();
  extensions.layers.clearcoat_texture.texture = builder.add_texture(2, 1, false, halves);
  shared::Material dark = surface(glm::vec3(0.03f), 0.6f);
  dark.ior = extensions.ior;
  builder.place(builder.add_sphere(1.0f, builder.with_layers(dark, extensions.layers)));
  builder.place(builder.add_quad({{{-3, -1, 3}, {3, -1, 3}, {3, -1, -3}, {-3, -1, -3}}},
                                 surface(glm::vec3(0.2f))));
  builder.add_sun({0.3f, -0.6f, -1}, glm::vec3(1.0f));
  return builder.build();
}

/// Gives the first material of what `rig` shows other extensions.
void edit(RendererRig& rig, const scene::Scene& scene, Extensions extensions) {
  std::vector<shared::Material> materials = scene.materials;
  std::vector<shared::MaterialLayer> layers = scene.layers;
  extensions.layers.clearcoat_texture = scene::no_texture_slot();
  if (!scene.textures.empty()) extensions.layers.clearcoat_texture.texture = 0;
  materials[0].ior = extensions.ior;
  materials[0].layer = static_cast<std::uint32_t>(layers.size());
  layers.push_back(scene::layer_of(materials[0], extensions.layers));
  rig.renderer.set_materials(materials, layers);
}

enum class Way { rays, raster, reference };

protocol::Settings settings_for(Way way) {
  protocol::Settings settings = undenoised();
  settings.gbuffer.source =
      way == Way::raster ? protocol::PrimaryVisibility::raster : protocol::PrimaryVisibility::rays;
  if (way == Way::reference) {
    settings.reference.use = protocol::ReferenceUse::always;
    settings.reference.scope = protocol::ReferenceScope::same_paths;
  }
  return settings;
}

std::string way_name(const testing::TestParamInfo<Way>& info) {
  return info.param == Way::rays ? "rays" : info.param == Way::raster ? "raster" : "reference";
}

void expect_same_color(const glm::dvec3& a, const glm::dvec3& b, const char* what) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c] / b[c], 1.0, 0.01) << what << ", channel " << c;
}

class EditedLayers : public testing::TestWithParam<Way> {
 protected:
  const protocol::Settings settings_ = settings_for(GetParam());

  RendererRig rig_of(const std::shared_ptr<const scene::Scene>& scene) const {
    return RendererRig(scene, make_environment(64, bright_sky), look({0, 0.5f, 3}, {0, 0, 0}), 64,
                       48);
  }
  /// Edits lead from `before` to `after` and back.
  void expect_edits(const Extensions& before, const Extensions& after) const {
    const auto scene = ball(before);
    RendererRig imported = rig_of(ball(after)), edited = rig_of(scene);
    const glm::dvec3 expected = mean_color(imported, settings_, "layers_imported", 48);
    const glm::dvec3 first = mean_color(edited, settings_, "layers_before_edit", 48);
    ASSERT_GT(glm::length(expected - first), 0.03 * glm::length(first)) << "both look the same";
    edit(edited, *scene, after);
    expect_same_color(mean_color(edited, settings_, "layers_edited", 48), expected, "edited");
    edited.renderer.set_materials(scene->materials);
    expect_same_color(mean_color(edited, settings_, "layers_restored", 48), first, "restored");
  }
};

TEST_P(EditedLayers, AMaterialWithoutExtensionsGetsThem) {
  for (const Extensions& given : {coated(1.0f), velvet(0.9f), dense(2.4f)}) {
    expect_edits({}, given);
  }
}

TEST_P(EditedLayers, AMaterialWithExtensionsGetsOthers) {
  expect_edits(coated(0.1f), coated(1.0f));
  expect_edits(velvet(0.9f), coated(1.0f));
}

TEST_P(EditedLayers, ValuesFollowOneAnother) {
  const auto scene = ball({});
  RendererRig imported = rig_of(ball(coated(1.0f))), edited = rig_of(scene);
  edited.apply(settings_);
  for (const float amount : {0.2f, 0.6f}) {
    edit(edited, *scene, coated(amount));
    edited.accumulate(1);
  }
  edit(edited, *scene, coated(1.0f));
  expect_same_color(mean_color(edited, settings_, "layers_followed", 48),
                    mean_color(imported, settings_, "layers_imported", 48), "the last value");
}

// Clay hides edits, those that are made meanwhile included.
TEST_P(EditedLayers, PlainMaterialsGiveThemBack) {
  const auto scene = ball({});
  RendererRig imported = rig_of(ball(coated(1.0f))), edited = rig_of(scene);
  protocol::Settings plain = settings_;
  plain.view.shading = protocol::ShadingMode::clay;
  edited.apply(plain);
  edited.accumulate(1);
  edit(edited, *scene, coated(1.0f));
  edited.accumulate(1);
  expect_same_color(mean_color(edited, settings_, "layers_after_clay", 48),
                    mean_color(imported, settings_, "layers_imported", 48), "after clay");
}

/// A pane in front of a wall that shines by itself. Nothing else is lit.
std::shared_ptr<const scene::Scene> glass_pane(float transmission) {
  SceneBuilder builder;
  MaterialLayers glass;
  glass.transmission = transmission;
  shared::Material wall = surface(glm::vec3(0.8f));
  wall.flags |= shared::material_unlit;
  const auto clear = builder.with_layers(surface(glm::vec3(1.0f), 0.5f), glass);
  builder.place(builder.add_quad({{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}}, clear));
  builder.place(builder.add_quad({{{-4, -4, -1}, {4, -4, -1}, {4, 4, -1}, {-4, 4, -1}}}, wall));
  return builder.build();
}

TEST_P(EditedLayers, TransmissionTellsWhatIsSeenThroughAPane) {
  const auto rig_of_pane = [](const std::shared_ptr<const scene::Scene>& scene) {
    return RendererRig(scene, scene::constant_environment(glm::vec3(0.0f)),
                       look({0, 0, 3}, {0, 0, 0}, 20.0f), 32, 32);
  };
  const auto scene = glass_pane(0.9f);
  RendererRig imported = rig_of_pane(glass_pane(0.4f)), edited = rig_of_pane(scene);
  Extensions less;
  less.layers.transmission = 0.4f;
  edit(edited, *scene, less);
  expect_same_color(mean_color(edited, settings_, "pane_edited", 192),
                    mean_color(imported, settings_, "pane_imported", 192), "through the pane");
}

INSTANTIATE_TEST_SUITE_P(Ways, EditedLayers,
                         testing::Values(Way::rays, Way::raster, Way::reference), way_name);

}  // namespace
}  // namespace heliograph::test
