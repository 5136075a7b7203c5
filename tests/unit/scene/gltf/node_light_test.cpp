#include <gtest/gtest.h>

#include <cmath>

#include "scene/import.hpp"
#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene::test {
namespace {

/// A scene with one node that has these extras, rotated so that its -Z points down.
GltfBuilder with_extras(const nlohmann::json& extras) {
  constexpr double quarter_turn = 0.70710678118;
  GltfBuilder builder = triangle();
  builder.add("nodes", {{"name", "light"},
                        {"translation", {1, 2, 3}},
                        {"rotation", {-quarter_turn, 0, 0, quarter_turn}},
                        {"scale", {2, 2, 2}},
                        {"extras", extras}});
  builder.json["scenes"][0]["nodes"].push_back(1);
  return builder;
}

TEST(AreaLights, RectangleEmitsAlongNodeMinusZ) {
  const Scene scene = with_extras({{"areaLight",
                                    {{"shape", "rect"},
                                     {"width", 3},
                                     {"height", 1},
                                     {"color", {1, .5, .25}},
                                     {"radiance", 8}}}})
                          .import();
  ASSERT_EQ(scene.lights.size(), 1u);
  const shared::Light& light = scene.lights[0].device;
  EXPECT_EQ(scene.lights[0].name, "light");
  EXPECT_EQ(light.type, shared::light_rectangle);
  EXPECT_EQ(light.position, glm::vec3(1, 2, 3));
  EXPECT_LT(glm::distance(light.direction, glm::vec3(0, -1, 0)), 1e-5f);
  EXPECT_LT(glm::distance(light.tangent, glm::vec3(1, 0, 0)), 1e-5f);
  EXPECT_EQ(light.color, glm::vec3(8, 4, 2));
  EXPECT_EQ(light.half_width, 1.5f) << "the node's scale is ignored";
  EXPECT_EQ(light.half_height, 0.5f);
  EXPECT_NEAR(light.radius, std::sqrt(3.0f / 3.14159265f), 1e-5f);
}

TEST(AreaLights, DiskHasRadius) {
  const Scene scene = with_extras({{"areaLight", {{"shape", "disk"}, {"radius", 0.3}}}}).import();
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.lights[0].device.type, shared::light_disk);
  EXPECT_FLOAT_EQ(scene.lights[0].device.radius, 0.3f);
  EXPECT_EQ(scene.lights[0].device.color, glm::vec3(1.0f));
}

TEST(AreaLights, InvalidExtrasAreRejected) {
  const nlohmann::json disk = {{"shape", "disk"}, {"radius", 0.3}};
  const auto refused = [](const nlohmann::json& light) {
    EXPECT_THROW(with_extras({{"areaLight", light}}).import(), ImportError) << light;
  };
  refused({{"shape", "sphere"}});
  refused({{"shape", "rect"}, {"width", 1}});
  refused({{"shape", "rect"}, {"width", 0}, {"height", 1}});
  refused({{"shape", "rect"}, {"width", 1}, {"height", 1e9}});
  refused({{"shape", "disk"}, {"radius", -1}});
  for (const auto& [key, value] :
       {std::pair{"radiance", nlohmann::json(-1)}, {"color", {1, -1, 1}}, {"color", "red"}}) {
    nlohmann::json light = disk;
    light[key] = value;
    refused(light);
  }
  EXPECT_TRUE(with_extras({{"areaLight", "not an object"}}).import().lights.empty());
}

TEST(Lights, PointAndSpotLightsHaveOptionalRadius) {
  GltfBuilder builder = with_extras({{"radius", 0.25}});
  builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  builder.json["nodes"][1]["extensions"] = {{"KHR_lights_punctual", {{"light", 0}}}};
  EXPECT_FLOAT_EQ(builder.import().lights.at(0).device.radius, 0.25f);
  builder.json["nodes"][1]["extras"] = {{"note", "hard shadows"}};
  EXPECT_EQ(builder.import().lights.at(0).device.radius, 0.0f);
  builder.json["nodes"][1]["extras"] = {{"radius", -1}};
  EXPECT_THROW(builder.import(), ImportError);
}

}  // namespace
}  // namespace heliograph::scene::test
