#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "scene/camera/camera.hpp"
#include "scene/camera/camera_choice.hpp"
#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene::test {
namespace {

using nlohmann::json;

constexpr float quarter_turn = 0.70710678f;

TEST(Nodes, WorldTransformsMultiplyAlongHierarchy) {
  GltfBuilder builder = triangle();
  builder.json["nodes"] = {
      {{"name", "leaf"}, {"mesh", 0}, {"translation", {1, 0, 0}}},
      {{"name", "root"}, {"children", {2}}, {"scale", {2, 2, 2}}},
      {{"name", "middle"}, {"children", {0}}, {"rotation", {0, 0, quarter_turn, quarter_turn}}}};
  builder.json["scenes"][0]["nodes"] = {1};
  const Scene scene = builder.import();
  ASSERT_EQ(scene.nodes.size(), 3u);
  EXPECT_EQ(scene.nodes[0].name, "root");
  EXPECT_EQ(scene.nodes[1].parent, 0u);
  EXPECT_EQ(scene.nodes[2].name, "leaf");
  EXPECT_EQ(scene.nodes[2].parent, 1u);
  const glm::vec4 origin = scene.nodes[2].world * glm::vec4(0, 0, 0, 1);
  EXPECT_LT(glm::distance(glm::vec3(origin), glm::vec3(0, 2, 0)), 1e-5f);
  EXPECT_EQ(scene.instances[0].node, 2u);
}

TEST(Nodes, MatrixIsColumnMajor) {
  GltfBuilder builder = triangle();
  builder.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3, 4, 5, 1};
  EXPECT_EQ(glm::vec3(builder.import().nodes[0].world[3]), glm::vec3(3, 4, 5));
}

TEST(Nodes, OnlyDefaultSceneIsShown) {
  GltfBuilder builder = triangle();
  builder.add("nodes", {{"mesh", 0}, {"name", "other"}});
  builder.json["scenes"].push_back({{"nodes", {1}}});
  builder.json["scene"] = 1;
  const Scene scene = builder.import();
  ASSERT_EQ(scene.nodes.size(), 1u);
  EXPECT_EQ(scene.nodes[0].name, "other");
  EXPECT_EQ(scene.scenes.size(), 2u);
  EXPECT_EQ(scene.shown_scene, 1u);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(Nodes, WithoutScenesAllRootsAreShown) {
  GltfBuilder builder = triangle();
  builder.add("nodes", {{"mesh", 0}});
  builder.json.erase("scenes");
  EXPECT_EQ(builder.import().instances.size(), 2u);
}

TEST(Nodes, EmptyDocumentIsEmptyScene) {
  GltfBuilder builder;
  const Scene scene = builder.import();
  EXPECT_TRUE(scene.instances.empty());
  EXPECT_TRUE(scene.bounds.empty());
  EXPECT_EQ(scene.materials.size(), 1u);
}

TEST(Cameras, LookAlongNodeMinusZ) {
  GltfBuilder builder = triangle();
  builder.add("cameras", {{"type", "perspective"},
                          {"perspective", {{"yfov", 1.0}, {"znear", 0.2}, {"aspectRatio", 2.0}}}});
  builder.add("nodes", {{"name", "main"},
                        {"camera", 0},
                        {"translation", {10, 0.5, 0}},
                        {"rotation", {0, quarter_turn, 0, quarter_turn}}});
  builder.json["scenes"][0]["nodes"].push_back(1);
  const Scene scene = builder.import();
  ASSERT_EQ(scene.cameras.size(), 1u);
  const Camera& camera = scene.cameras[0];
  EXPECT_EQ(camera.name, "main");
  EXPECT_LT(glm::distance(camera.eye, glm::vec3(10, 0.5f, 0)), 1e-5f);
  // Rotated by 90 degrees about Y, -Z becomes -X; the triangle's center is at x = 0.5.
  EXPECT_LT(glm::distance(camera.target, glm::vec3(0.5f, 0.5f, 0)), 1e-4f);
  EXPECT_LT(glm::distance(camera.up, glm::vec3(0, 1, 0)), 1e-5f);
  EXPECT_NEAR(camera.vertical_fov, 57.29578f, 1e-3f);
  EXPECT_FLOAT_EQ(camera.near_plane, 0.2f);
  EXPECT_EQ(camera.orthographic_height, 0.0f);
}

TEST(Cameras, TargetIsNearWhenCameraIsInsideScene) {
  GltfBuilder builder = triangle();
  builder.add("cameras",
              {{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.2}}}});
  builder.json["nodes"][0]["scale"] = {20, 20, 1};
  // A second, rotated copy gives the scene depth, so that the camera can be inside.
  builder.add("nodes", {{"mesh", 0}, {"scale", {20, 20, 1}}, {"translation", {0, 0, 8}}});
  builder.add("nodes", {{"camera", 0}, {"translation", {3, 3, 6}}});
  builder.json["scenes"][0]["nodes"] = {0, 1, 2};
  const Scene scene = builder.import();
  ASSERT_EQ(scene.cameras.size(), 1u);
  const Camera& camera = scene.cameras[0];
  EXPECT_NEAR(glm::distance(camera.eye, camera.target), 0.1f * scene.bounds.radius(), 1e-3f);
  EXPECT_LT(camera.target.z, camera.eye.z);
}

TEST(Cameras, OrthographicHeightIsFullHeight) {
  GltfBuilder builder = everything();
  builder.json["cameras"][0] = {
      {"type", "orthographic"},
      {"orthographic", {{"xmag", 2}, {"ymag", 1.5}, {"znear", 0.5}, {"zfar", 20}}}};
  const Camera camera = builder.import().cameras[0];
  EXPECT_FLOAT_EQ(camera.orthographic_height, 3.0f);
  EXPECT_FLOAT_EQ(camera.far_plane, 20.0f);
}

TEST(Cameras, TargetIsNeverBehindEye) {
  GltfBuilder builder = everything();
  builder.json["nodes"][1]["translation"] = {0, 0, -50};
  const Camera camera = builder.import().cameras[0];
  EXPECT_NEAR(camera.target.z, -50.1f, 1e-3f);
}

TEST(Cameras, CanAllBeChosenByNameAndNumber) {
  GltfBuilder builder = triangle();
  builder.add("cameras",
              {{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.2}}}});
  for (const char* const name : {"", "top", "top", "camera 5", "", "2"}) {
    builder.json["scenes"][0]["nodes"].push_back(builder.json["nodes"].size());
    builder.add("nodes", {{"camera", 0}, {"name", name}});
  }
  const Scene scene = builder.import();
  std::vector<std::string> names;
  for (const Camera& camera : scene.cameras) names.push_back(camera.name);
  EXPECT_EQ(names,
            (std::vector<std::string>{"camera 1", "top", "top 2", "camera 5", "camera 5 2", "2"}));
  for (const Camera& camera : scene.cameras) EXPECT_EQ(find_camera(scene, camera.name), &camera);
  EXPECT_EQ(find_camera(scene, "3"), &scene.cameras[2]);
  EXPECT_EQ(find_camera(scene, "2"), &scene.cameras[5]) << "names come first";
  for (const char* const wrong : {"", "0", "7", "-1", "1 ", "99999999999999999999"}) {
    EXPECT_EQ(find_camera(scene, wrong), nullptr) << wrong;
  }
}

TEST(Lights, AreTransformedToWorldSpace) {
  GltfBuilder builder = triangle();
  builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "spot"},
       {"name", "light"},
       {"color", {1, .5, .25}},
       {"intensity", 40},
       {"range", 9},
       {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.6}}}}};
  builder.add("nodes", {{"translation", {1, 2, 3}},
                        {"rotation", {-quarter_turn, 0, 0, quarter_turn}},
                        {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  builder.json["scenes"][0]["nodes"].push_back(1);
  const Scene scene = builder.import();
  ASSERT_EQ(scene.lights.size(), 1u);
  const shared::Light& light = scene.lights[0].device;
  EXPECT_EQ(scene.lights[0].name, "light");
  EXPECT_EQ(light.type, shared::light_spot);
  EXPECT_EQ(light.position, glm::vec3(1, 2, 3));
  EXPECT_LT(glm::distance(light.direction, glm::vec3(0, -1, 0)), 1e-5f);
  EXPECT_EQ(light.color, glm::vec3(40, 20, 10));
  EXPECT_EQ(light.range, 9.0f);
  // Full intensity inside the inner cone, zero at the outer one.
  EXPECT_NEAR(std::cos(0.2f) * light.spot_scale + light.spot_offset, 1.0f, 1e-4f);
  EXPECT_NEAR(std::cos(0.6f) * light.spot_scale + light.spot_offset, 0.0f, 1e-4f);
}

TEST(Lights, SunAngularDiameterComesFromNodeExtras) {
  GltfBuilder builder = everything();
  Light sun = builder.import().lights[0];
  EXPECT_FLOAT_EQ(sun.angular_diameter, 0.53f);
  builder.json["nodes"][2]["extras"] = {{"angularDiameterDeg", 4.0}, {"note", {1, "two"}}};
  sun = builder.import().lights[0];
  EXPECT_FLOAT_EQ(sun.angular_diameter, 4.0f);
  EXPECT_NEAR(sun.device.radius, 0.0349208f, 1e-6f);  // tan(2 degrees)
  builder.json["nodes"][2]["extras"] = "extras may be anything";
  EXPECT_FLOAT_EQ(builder.import().lights[0].angular_diameter, 0.53f);
}

}  // namespace
}  // namespace heliograph::scene::test
