#include <gtest/gtest.h>

#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene::test {
namespace {

using nlohmann::json;

json& attributes_of(GltfBuilder& builder) {
  return builder.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
}

GltfBuilder instanced() {
  GltfBuilder builder = triangle();
  builder.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  builder.json["nodes"][0]["name"] = "leaf";
  builder.json["nodes"][0]["translation"] = {10, 0, 0};
  attributes_of(builder)["TRANSLATION"] =
      builder.add_accessor(std::vector<float>{0, 1, 0, 0, 2, 0, 0, 3, 0}, 5126, "VEC3", 3);
  attributes_of(builder)["SCALE"] =
      builder.add_accessor(std::vector<float>{1, 1, 1, 2, 2, 2, 1, 1, -1}, 5126, "VEC3", 3);
  const auto turns = builder.add_view(
      std::vector<std::int16_t>{0, 0, 0, 32767, 0, 0, 23170, 23170, 0, 0, 0, 32767});
  attributes_of(builder)["ROTATION"] = builder.add_accessor(turns, 5122, "VEC4", 3, true);
  return builder;
}

TEST(Instancing, TransformsAreRelativeToNode) {
  const Scene scene = instanced().import();
  ASSERT_EQ(scene.instances.size(), 3u);
  EXPECT_EQ(scene.triangle_count(), 3u);
  const auto corner = [&](std::size_t i) {
    return glm::vec3(scene.nodes[scene.instances[i].node].world * glm::vec4(1, 0, 0, 1));
  };
  EXPECT_LT(glm::distance(corner(0), glm::vec3(11, 1, 0)), 1e-4f);
  EXPECT_LT(glm::distance(corner(1), glm::vec3(10, 4, 0)), 1e-4f)
      << "rotated by 90 degrees, scaled by 2";
  EXPECT_LT(glm::distance(corner(2), glm::vec3(11, 3, 0)), 1e-4f);
  EXPECT_EQ(scene.nodes[scene.instances[1].node].parent, 0u);
  EXPECT_EQ(scene.nodes[scene.instances[1].node].name, "leaf");
}

TEST(Instancing, CustomAttributesAreIgnored) {
  GltfBuilder builder = instanced();
  attributes_of(builder)["_ID"] =
      builder.add_accessor(std::vector<float>{1, 2, 3}, 5126, "SCALAR", 3);
  EXPECT_EQ(builder.import().instances.size(), 3u);
}

TEST(Instancing, DamageIsRejected) {
  const auto refusal_with = [](auto change, const ImportLimits& limits = {}) {
    GltfBuilder builder = instanced();
    change(builder, attributes_of(builder));
    return refusal_of(builder, limits);
  };
  const auto expect = [](const std::string& refusal, std::string_view part) {
    EXPECT_NE(refusal.find(part), std::string::npos) << refusal;
  };
  expect(refusal_with([](auto&, auto& a) { a["TRANSLATION"] = 90; }), "TRANSLATION: 90");
  expect(refusal_with([](auto&, auto& a) { a["TRANSLATION"] = a["ROTATION"]; }), "element type");
  expect(refusal_with([](auto&, auto& a) { a = json::object(); }), "at least one");
  expect(refusal_with([](auto& b, auto& a) {
           a["_ID"] = b.add_accessor(std::vector<float>{1}, 5126, "SCALAR", 1);
         }),
         "differs in count");
  expect(refusal_with([](auto& b, auto& a) {
           a["ROTATION"] = b.add_accessor(std::vector<float>(12, 0.0f), 5126, "VEC4", 3);
         }),
         "of zero length");
  expect(refusal_with([](auto& b, auto& a) {
           const auto index = a["ROTATION"].template get<std::size_t>();
           b.json["accessors"][index].erase("normalized");
         }),
         "component type");
  expect(refusal_with([](auto& b, auto&) {
           b.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"].erase("attributes");
         }),
         "missing");
  ImportLimits limits;
  limits.instances = 2;
  expect(refusal_with([](auto&, auto&) {}, limits), "limit of 2 instances");
}

// Ten nodes, each with as many instances as the limit: the sum is limited.
TEST(Instancing, LimitAppliesToWholeScene) {
  GltfBuilder builder = instanced();
  for (int i = 0; i < 9; ++i) builder.add("nodes", builder.json["nodes"][0]);
  builder.json["scenes"][0]["nodes"] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  ImportLimits limits;
  limits.instances = 29;
  EXPECT_NE(refusal_of(builder, limits).find("instances"), std::string::npos);
  limits.instances = 30;
  EXPECT_EQ(refusal_of(builder, limits), "");
}

}  // namespace
}  // namespace heliograph::scene::test
