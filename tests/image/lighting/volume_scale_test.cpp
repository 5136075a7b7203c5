// KHR_materials_volume gives thicknesses in the space of the mesh: what an instance's scale makes
// of them, where light does not travel through the volume.
#include <gtest/gtest.h>

#include <array>
#include <glm/gtc/matrix_transform.hpp>
#include <span>
#include <string>

#include "tests/image/support/renderer_rig.hpp"

namespace heliograph::test {
namespace {

using scene::MaterialLayers;

constexpr float much_larger = 10.0f;
constexpr float one_metre = 1.0f;  // the thickness in the world

/// Of one metre in the world, where instances have that scale.
MaterialLayers tinted_volume(float scale, bool diffuse) {
  MaterialLayers layers;
  (diffuse ? layers.diffuse_transmission : layers.transmission) = 1.0f;
  layers.specular = 0.0f;
  layers.thickness = one_metre / scale;
  layers.attenuation_distance = one_metre;
  layers.attenuation_color = {0.8f, 0.5f, 0.2f};
  return layers;
}

/// All six sides, or the one toward the eye, which closes no volume.
enum class Form { box, pane };

/// At the origin, lit from behind. `modelled`: the scale with which the mesh is two metres wide and
/// its volume one metre thick; `placed`: the instance's scale.
std::shared_ptr<scene::Scene> volume_scene(Form form, float modelled, float placed, bool diffuse) {
  SceneBuilder builder;
  const auto sides = box_sides(glm::vec3(1.0f / modelled));
  const std::span<const std::array<glm::vec3, 4>> shown(sides.data(), form == Form::box ? 6 : 1);
  const auto material =
      builder.with_layers(surface(glm::vec3(1.0f), 0.0f), tinted_volume(modelled, diffuse));
  builder.place(builder.add_quads(shown, material), glm::scale(glm::mat4(1.0f), glm::vec3(placed)));
  builder.add_sun({0, 0, 1}, glm::vec3(3.0f));
  return std::make_shared<scene::Scene>(*builder.build());
}

RendererRig rig_before_sky(std::shared_ptr<const scene::Scene> scene) {
  return {std::move(scene), scene::constant_environment(glm::vec3(1.0f)),
          look({0, 0, 6}, {0, 0, 0}, 16.0f), 24, 24};
}

void expect_same_light(const glm::dvec3& expected, const glm::dvec3& seen,
                       const std::string& what) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c] / expected[c], 1.0, 0.02) << what << ' ' << c;
}

struct VolumeWay {
  const char* name;
  Form form;
  bool diffuse;
  bool refraction;
  bool path_traced;
  protocol::PrimaryVisibility source;
};

class VolumeScale : public testing::TestWithParam<VolumeWay> {
 protected:
  static protocol::Settings settings() {
    protocol::Settings made = undenoised();
    made.gbuffer.source = GetParam().source;
    made.transmission.refraction = GetParam().refraction;
    if (!GetParam().path_traced) return made;
    made.reference.use = protocol::ReferenceUse::always;
    made.reference.scope = protocol::ReferenceScope::full;
    return made;
  }
  static std::string image(const char* of) {
    return std::string("volume_scale_") + GetParam().name + '_' + of;
  }
  static glm::dvec3 mean(RendererRig& rig, const char* of) {
    return mean_color(rig, settings(), image(of), 192);
  }
  static std::shared_ptr<scene::Scene> shown(float modelled, float placed) {
    return volume_scene(GetParam().form, modelled, placed, GetParam().diffuse);
  }
};

constexpr auto by_rays = protocol::PrimaryVisibility::rays;
constexpr auto by_raster = protocol::PrimaryVisibility::raster;
INSTANTIATE_TEST_SUITE_P(
    Ways, VolumeScale,
    testing::Values(VolumeWay{"straight_rays", Form::box, false, false, false, by_rays},
                    VolumeWay{"straight_raster", Form::box, false, false, false, by_raster},
                    VolumeWay{"open_rays", Form::pane, false, true, false, by_rays},
                    VolumeWay{"open_raster", Form::pane, false, true, false, by_raster},
                    VolumeWay{"diffuse_rays", Form::pane, true, true, false, by_rays},
                    VolumeWay{"diffuse_raster", Form::pane, true, true, false, by_raster},
                    VolumeWay{"diffuse_paths", Form::pane, true, true, true, by_rays}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST_P(VolumeScale, SmallMeshOfALargeInstanceLooksLikeALargeMesh) {
  RendererRig large = rig_before_sky(shown(1.0f, 1.0f));
  RendererRig small = rig_before_sky(shown(much_larger, much_larger));
  const glm::dvec3 expected = mean(large, "large");
  EXPECT_LT(expected.z, 0.9 * expected.x) << "the tint does not show";
  expect_same_light(expected, mean(small, "small"), "scaled");
}

/// Two instances of one mesh, each with its own thickness.
TEST_P(VolumeScale, InstancesOfAMeshHaveTheirOwn) {
  const std::shared_ptr<scene::Scene> both = shown(1.0f, 1.0f);
  const glm::mat4 half = glm::scale(glm::mat4(1.0f), glm::vec3(0.5f));
  const glm::mat4 aside = glm::translate(glm::mat4(1.0f), {40, 0, 0}) * half;
  both->instances.push_back({0, 1});
  both->nodes.push_back({.name = {}, .parent = {}, .local = aside, .world = aside});
  RendererRig rig = rig_before_sky(both);
  RendererRig whole = rig_before_sky(shown(1.0f, 1.0f));
  RendererRig halved = rig_before_sky(shown(1.0f, 0.5f));
  const glm::dvec3 thick = mean(whole, "whole");
  expect_same_light(thick, mean(rig, "first"), "first");
  rig.renderer.set_camera(look({40, 0, 6}, {40, 0, 0}, 8.0f));
  halved.renderer.set_camera(look({0, 0, 6}, {0, 0, 0}, 8.0f));
  const glm::dvec3 thin = mean(halved, "halved");
  EXPECT_GT(thin.z, 1.1 * thick.z);
  expect_same_light(thin, mean(rig, "second"), "second");
}

/// A clip that makes an instance ten times as large.
TEST_P(VolumeScale, FollowsAnimatedScales) {
  const std::shared_ptr<scene::Scene> moving = shown(much_larger, 1.0f);
  moving->nodes[0].transform = scene::Transform{};
  scene::Channel grown;
  grown.property = scene::Property::scale;
  grown.times = {0.0f, 1.0f};
  grown.values = {1, 1, 1, much_larger, much_larger, much_larger};
  moving->clips = {{"grow", 1.0f, {grown}}};
  RendererRig rig = rig_before_sky(moving);
  ASSERT_TRUE(rig.renderer.set_pose("grow", 1.0));
  RendererRig large = rig_before_sky(shown(1.0f, 1.0f));
  expect_same_light(mean(large, "still"), mean(rig, "grown"), "animated");
}

}  // namespace
}  // namespace heliograph::test
