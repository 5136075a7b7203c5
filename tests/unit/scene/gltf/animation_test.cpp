#include "scene/gltf/nodes/animation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/animation/pose.hpp"
#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene::test {
namespace {

using Numbers = std::vector<float>;

/// A skinned triangle with two joints, the second of which is animated upward.
GltfBuilder skinned_triangle() {
  GltfBuilder b = triangle();
  const auto joints = b.add_accessor(std::vector<std::uint8_t>{0, 9, 9, 9, 1, 0, 0, 0, 0, 1, 0, 0},
                                     5121, "VEC4", 3);
  const auto weights =
      b.add_accessor(Numbers{1, 0, 0, 0, 2, 0, 0, 0, 0.25f, 0.75f, 0, 0}, 5126, "VEC4", 3);
  auto& attributes = b.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] = joints;
  attributes["WEIGHTS_0"] = weights;
  b.json["nodes"][0]["skin"] = 0;
  b.json["nodes"][0]["translation"] = {7, 7, 7};
  b.json["nodes"][0]["children"] = {1, 2};
  b.add("nodes", {{"translation", {-7, -7, -7}}});
  b.add("nodes", {{"translation", {-7, -3, -7}}});
  b.add("skins", {{"joints", {1, 2}}});
  const auto times = b.add_accessor(Numbers{0.5f, 2.0f}, 5126, "SCALAR", 2);
  const auto places = b.add_accessor(Numbers{-7, -3, -7, -7, 1, -7}, 5126, "VEC3", 2);
  b.add("animations",
        {{"name", "rise"},
         {"samplers", {{{"input", times}, {"output", places}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 2}, {"path", "translation"}}}}}}});
  return b;
}

std::vector<glm::vec3> corners(const Mesh& mesh) {
  std::vector<glm::vec3> result;
  for (const std::uint32_t index : mesh.indices) result.push_back(mesh.vertices[index].position);
  return result;
}

TEST(Skins, MeshIsPlacedByJointsNotByNode) {
  const Scene scene = skinned_triangle().import();
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(scene.nodes[scene.instances[0].node].world, glm::mat4(1.0f));
  const std::vector<glm::vec3> expected{{0, 0, 0}, {1, 4, 0}, {0, 4, 0}};
  const auto found = corners(scene.meshes[scene.instances[0].mesh]);
  ASSERT_EQ(found.size(), 3u);
  for (int i = 0; i < 3; ++i) EXPECT_LE(glm::distance(found[i], expected[i]), 1e-5f) << i;
  EXPECT_LE(glm::distance(scene.bounds.maximum, {1, 4, 0}), 1e-5f);
}

TEST(Skins, InvalidJointIndicesAreRejected) {
  GltfBuilder b = skinned_triangle();
  b.json["skins"][0]["joints"] = {1};
  EXPECT_NE(refusal_of(b).find("joint 1 is out of range for a skin with 1 joints"),
            std::string::npos)
      << refusal_of(b);
}

TEST(Skins, JointsWithoutWeightsAreRejected) {
  GltfBuilder b = skinned_triangle();
  b.json["meshes"][0]["primitives"][0]["attributes"].erase("WEIGHTS_0");
  EXPECT_NE(refusal_of(b).find("WEIGHTS_0: is missing"), std::string::npos) << refusal_of(b);
}

TEST(Skins, EachSkinnedInstanceHasOwnMesh) {
  GltfBuilder b = skinned_triangle();
  b.json["scenes"][0]["nodes"].push_back(b.add("nodes", {{"mesh", 0}, {"skin", 0}}));
  const Scene scene = b.import();
  ASSERT_EQ(scene.deformations.size(), 2u);
  EXPECT_NE(scene.deformations[0].mesh, scene.deformations[1].mesh);
  EXPECT_EQ(scene.deformations[0].shape, scene.deformations[1].shape);
}

TEST(Clips, HaveNamesDurationsAndChannels) {
  GltfBuilder b = skinned_triangle();
  b.json["animations"].push_back(b.json["animations"][0]);
  b.json["animations"].push_back(b.json["animations"][0]);
  b.json["animations"][2].erase("name");
  const Scene scene = b.import();
  ASSERT_EQ(scene.clips.size(), 3u);
  EXPECT_EQ(scene.clips[0].name, "rise");
  EXPECT_EQ(scene.clips[1].name, "rise 2");
  EXPECT_EQ(scene.clips[2].name, "clip 3");
  EXPECT_EQ(scene.clips[0].duration, 2.0f);
  ASSERT_EQ(scene.clips[0].channels.size(), 1u);
  EXPECT_EQ(scene.nodes[scene.clips[0].channels[0].node].world[3], glm::vec4(0, 4, 0, 1));
}

struct Damage {
  const char* name;
  void (*damage)(GltfBuilder&);
  const char* reason;
};

class MalformedAnimation : public testing::TestWithParam<Damage> {};

TEST_P(MalformedAnimation, IsRejectedWithReason) {
  GltfBuilder b = skinned_triangle();
  GetParam().damage(b);
  const std::string refusal = refusal_of(b);
  EXPECT_NE(refusal.find(GetParam().reason), std::string::npos) << refusal;
}

const Damage damages[] = {
    {"TimesThatDoNotAscend",
     [](auto& b) {
       b.json["animations"][0]["samplers"][0]["input"] =
           b.add_accessor(Numbers{1, 0}, 5126, "SCALAR", 2);
     },
     "must ascend"},
    {"TimesBeforeTheStart",
     [](auto& b) {
       b.json["animations"][0]["samplers"][0]["input"] =
           b.add_accessor(Numbers{-1, 1}, 5126, "SCALAR", 2);
     },
     "before 0"},
    {"ValuesOfTheWrongKind",
     [](auto& b) { b.json["animations"][0]["channels"][0]["target"]["path"] = "rotation"; },
     "wrong element type"},
    {"TooFewValuesForASpline",
     [](auto& b) { b.json["animations"][0]["samplers"][0]["interpolation"] = "CUBICSPLINE"; },
     "number of keys"},
    {"TheSameTwice",
     [](auto& b) {
       auto& channels = b.json["animations"][0]["channels"];
       channels.push_back(channels[0]);
     },
     "animated twice"},
    {"NegativeWeights",
     [](auto& b) {
       b.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] =
           b.add_accessor(Numbers{-1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, 5126, "VEC4", 3);
     },
     "negative weight"},
};

INSTANTIATE_TEST_SUITE_P(, MalformedAnimation, testing::ValuesIn(damages),
                         [](const auto& test) { return test.param.name; });

GltfBuilder morphing_triangle() {
  GltfBuilder b = triangle();
  const auto lift = b.add_accessor(Numbers{0, 0, 0, 0, 0, 0, 0, 2, 0}, 5126, "VEC3", 3);
  b.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", lift}}};
  b.json["meshes"][0]["weights"] = {0.5};
  return b;
}

TEST(MorphTargets, DefaultWeightsComeFromMeshOrNode) {
  GltfBuilder b = morphing_triangle();
  EXPECT_FLOAT_EQ(b.import().meshes[0].bounds.maximum.y, 2.0f);
  b.json["nodes"][0]["weights"] = {1.0};
  EXPECT_FLOAT_EQ(b.import().meshes[0].bounds.maximum.y, 3.0f);
  b.json["nodes"][0]["weights"] = {1.0, 2.0};
  EXPECT_NE(refusal_of(b).find("array of 1 numbers"), std::string::npos) << refusal_of(b);
}

TEST(Clips, NormalizedWeightsBecomeFloats) {
  GltfBuilder b = morphing_triangle();
  const auto times = b.add_accessor(Numbers{0, 1}, 5126, "SCALAR", 2);
  const auto values =
      b.add_accessor(b.add_view(std::vector<std::uint8_t>{0, 255}), 5121, "SCALAR", 2, true);
  b.add("animations",
        {{"samplers", {{{"input", times}, {"output", values}, {"interpolation", "STEP"}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}});
  const Scene scene = b.import();
  ASSERT_EQ(scene.clips.size(), 1u);
  EXPECT_EQ(scene.clips[0].channels[0].values, (Numbers{0.0f, 1.0f}));
}

TEST(Clips, NormalizedRotationsBecomeFloats) {
  GltfBuilder b = skinned_triangle();
  const auto times = b.add_accessor(Numbers{0, 1}, 5126, "SCALAR", 2);
  const auto with_values = [&](std::uint32_t values) {
    b.json["animations"][0]["samplers"][0] = {{"input", times}, {"output", values}};
    b.json["animations"][0]["channels"][0]["target"]["path"] = "rotation";
    return b.import().clips.at(0).channels.at(0).values;
  };
  const auto bytes = b.add_view(std::vector<std::int8_t>{0, 0, 0, 127, -127, 0, 0, 0});
  EXPECT_EQ(with_values(b.add_accessor(bytes, 5120, "VEC4", 2, true)),
            (Numbers{0, 0, 0, 1, -1, 0, 0, 0}));
  const auto words = b.add_view(std::vector<std::int16_t>{0, 0, 0, 32767, -32767, 0, 0, 0});
  EXPECT_EQ(with_values(b.add_accessor(words, 5122, "VEC4", 2, true)),
            (Numbers{0, 0, 0, 1, -1, 0, 0, 0}));
}

TEST(Clips, EveryInterpolationAnimatesEveryProperty) {
  const struct {
    const char* path;
    const char* type;
    Numbers first, second;
  } properties[] = {{"translation", "VEC3", {1, 2, 3}, {5, 4, 3}},
                    {"rotation", "VEC4", {0, 0, 0, 1}, {0, 0, 1, 0}},
                    {"scale", "VEC3", {1, 1, 1}, {3, 2, 1}},
                    {"weights", "SCALAR", {0.25f}, {0.75f}}};
  for (const auto& [path, type, first, second] : properties) {
    for (const char* const interpolation : {"STEP", "LINEAR", "CUBICSPLINE"}) {
      const bool spline = std::string_view(interpolation) == "CUBICSPLINE";
      const Numbers flat(first.size(), 0.0f);
      Numbers values;
      for (const Numbers* key : {&first, &second}) {
        if (spline) values.insert(values.end(), flat.begin(), flat.end());
        values.insert(values.end(), key->begin(), key->end());
        if (spline) values.insert(values.end(), flat.begin(), flat.end());
      }
      GltfBuilder b = morphing_triangle();
      const auto times = b.add_accessor(Numbers{0, 2}, 5126, "SCALAR", 2);
      const std::size_t keys = spline ? 6 : 2;
      const auto output = b.add_accessor(values, 5126, type, keys);
      b.add(
          "animations",
          {{"samplers", {{{"input", times}, {"output", output}, {"interpolation", interpolation}}}},
           {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}}});
      const Channel channel = b.import().clips.at(0).channels.at(0);
      Numbers found(first.size());
      sample(channel, 1.0f, found.data());
      const bool step = std::string_view(interpolation) == "STEP";
      for (std::size_t i = 0; i < found.size(); ++i) {
        // Halfway a spline with zero tangents equals linear interpolation; rotations are on an arc.
        const float straight = 0.5f * (first[i] + second[i]);
        const bool arc = std::string_view(path) == "rotation" && straight != 0.0f;
        const float expected = step ? first[i] : arc ? std::sqrt(0.5f) : straight;
        EXPECT_NEAR(found[i], expected, 1e-5f) << path << " " << interpolation << " " << i;
      }
    }
  }
}

TEST(LightsAndCameras, ReferToTheirNodes) {
  const Scene scene = everything().import();
  ASSERT_TRUE(scene.cameras[0].node && scene.lights[0].node);
  EXPECT_EQ(scene.nodes[*scene.cameras[0].node].world[3], glm::vec4(0, 0, 3, 1));
  EXPECT_NE(*scene.cameras[0].node, *scene.lights[0].node);
}

}  // namespace
}  // namespace heliograph::scene::test
