#include "scenes/generator/scenes/paper_scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "scenes/generator/gltf/glb.hpp"

namespace heliograph::scenes {
namespace {

constexpr int texture_size = 16;

const Document& document_of(const std::string& name) {
  static std::map<std::string, Document> documents;
  const auto known = documents.find(name);
  if (known != documents.end()) return known->second;
  const PaperScene& scene = find_paper_scene(name);
  return documents.emplace(name, scene.make_document(scene.make_sky(64, 32))).first->second;
}

// The JSON chunk of a GLB file, which follows the header of 12 bytes and its own of 8.
nlohmann::json parse_glb(const std::vector<std::uint8_t>& file) {
  std::size_t length = 0;
  for (std::size_t k = 0; k < 4; ++k) length |= std::size_t(file[12 + k]) << (8 * k);
  const auto begin = file.begin() + 20;
  return nlohmann::json::parse(begin, begin + std::ptrdiff_t(length));
}

class GeneratedScene : public testing::TestWithParam<const char*> {
 protected:
  const Document& document() const { return document_of(GetParam()); }
};

INSTANTIATE_TEST_SUITE_P(Paper, GeneratedScene,
                         testing::Values("cubes_distance", "icosphere", "glossy_sponza_1",
                                         "shadow_objects", "pillars", "breakfast_room"),
                         [](const auto& scene) { return std::string(scene.param); });

TEST_P(GeneratedScene, IndicesAreInRangeAndTrianglesHaveArea) {
  for (const NamedMesh& named : document().meshes) {
    const Mesh& mesh = named.mesh;
    ASSERT_FALSE(mesh.indices.empty()) << named.name;
    ASSERT_EQ(mesh.indices.size() % 3, 0u) << named.name;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      const std::uint32_t* corner = &mesh.indices[i];
      for (int k = 0; k < 3; ++k) ASSERT_LT(corner[k], mesh.vertices.size()) << named.name;
      const glm::vec3 a = mesh.vertices[corner[0]].position;
      const glm::vec3 facing =
          glm::cross(mesh.vertices[corner[1]].position - a, mesh.vertices[corner[2]].position - a);
      ASSERT_GT(glm::length(facing), 0.0f) << named.name;
    }
  }
}

TEST_P(GeneratedScene, NormalsAndTangentsAreOrthonormal) {
  for (const NamedMesh& named : document().meshes) {
    for (const Vertex& vertex : named.mesh.vertices) {
      const glm::vec3 tangent(vertex.tangent);
      ASSERT_NEAR(glm::length(vertex.normal), 1.0f, 1e-4f) << named.name;
      ASSERT_NEAR(glm::length(tangent), 1.0f, 1e-4f) << named.name;
      ASSERT_NEAR(glm::dot(vertex.normal, tangent), 0.0f, 1e-3f) << named.name;
      ASSERT_EQ(std::abs(vertex.tangent.w), 1.0f) << named.name;
    }
  }
}

// Wrong winding gives a face normal opposite to the vertex normals; normals smoothed over a crease
// give a large angle.
TEST_P(GeneratedScene, FaceNormalsAgreeWithVertexNormals) {
  for (const NamedMesh& named : document().meshes) {
    const Mesh& mesh = named.mesh;
    std::size_t off = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      const Vertex& a = mesh.vertices[mesh.indices[i]];
      const Vertex& b = mesh.vertices[mesh.indices[i + 1]];
      const Vertex& c = mesh.vertices[mesh.indices[i + 2]];
      const glm::vec3 face =
          glm::normalize(glm::cross(b.position - a.position, c.position - a.position));
      ASSERT_GT(glm::dot(face, a.normal + b.normal + c.normal), 0.0f) << named.name;
      const float best =
          std::max({glm::dot(face, a.normal), glm::dot(face, b.normal), glm::dot(face, c.normal)});
      off += best < 0.4f;
    }
    EXPECT_LE(double(off), 0.01 * double(mesh.triangle_count())) << named.name;
  }
}

TEST_P(GeneratedScene, TangentsFollowTextureCoordinates) {
  for (const NamedMesh& named : document().meshes) {
    const Mesh& mesh = named.mesh;
    if (!document().materials[std::size_t(named.material)].texture) continue;
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      const Vertex& a = mesh.vertices[mesh.indices[i]];
      const Vertex& b = mesh.vertices[mesh.indices[i + 1]];
      const Vertex& c = mesh.vertices[mesh.indices[i + 2]];
      // Tangents must agree with the uv derivatives along the edges.
      const glm::vec3 edges[2] = {b.position - a.position, c.position - a.position};
      const glm::vec2 uvs[2] = {b.uv - a.uv, c.uv - a.uv};
      const float area = uvs[0].x * uvs[1].y - uvs[1].x * uvs[0].y;
      if (std::abs(area) < 1e-10f) continue;
      const glm::vec3 along_u = glm::normalize((edges[0] * uvs[1].y - edges[1] * uvs[0].y) / area);
      const glm::vec3 along_v = glm::normalize((edges[1] * uvs[0].x - edges[0] * uvs[1].x) / area);
      const glm::vec3 tangent(a.tangent);
      const glm::vec3 to_image_top = a.tangent.w * glm::cross(a.normal, tangent);
      wrong += glm::dot(tangent, along_u) < 0.0f || glm::dot(to_image_top, along_v) > 0.0f;
    }
    EXPECT_LE(double(wrong), 0.02 * double(mesh.triangle_count())) << named.name;
  }
}

TEST_P(GeneratedScene, ClipsLoopInTenSecondsWithUnitQuaternions) {
  ASSERT_EQ(document().animations.size(), 2u);
  EXPECT_EQ(document().animations[0].name, "moving_camera");
  EXPECT_EQ(document().animations[1].name, "moving_objects_light");
  for (const Animation& animation : document().animations) {
    ASSERT_FALSE(animation.channels.empty()) << animation.name;
    for (const Channel& channel : animation.channels) {
      EXPECT_FLOAT_EQ(channel.seconds.front(), 0.0f);
      EXPECT_FLOAT_EQ(channel.seconds.back(), 10.0f);
      const bool rotation = channel.path == Channel::Path::rotation;
      const float closing = glm::dot(channel.values.front(), channel.values.back()) /
                            glm::dot(channel.values.front(), channel.values.front());
      EXPECT_NEAR(rotation ? std::abs(closing) : closing, 1.0f, 1e-5f);
      for (std::size_t i = 1; rotation && i < channel.values.size(); ++i) {
        ASSERT_NEAR(glm::length(channel.values[i]), 1.0f, 1e-5f);
        ASSERT_GT(glm::dot(channel.values[i], channel.values[i - 1]), 0.9f);
      }
    }
  }
}

TEST_P(GeneratedScene, IsDeterministic) {
  const PaperScene& scene = find_paper_scene(GetParam());
  const auto again = scene.make_document(scene.make_sky(64, 32));
  EXPECT_EQ(encode_glb(document(), texture_size), encode_glb(again, texture_size));
}

TEST_P(GeneratedScene, MainCameraIsFirstAndSunMatchesSky) {
  EXPECT_EQ(document().cameras.front().name, "main");
  const PaperScene& scene = find_paper_scene(GetParam());
  const auto sun = std::find_if(document().nodes.begin(), document().nodes.end(),
                                [](const Node& node) { return node.name == "sun"; });
  ASSERT_NE(sun, document().nodes.end());
  EXPECT_FLOAT_EQ(sun->angular_diameter.value(), scene.sun.angular_diameter);
  const glm::vec3 travels = sun->rotation * glm::vec3(0.0f, 0.0f, -1.0f);
  EXPECT_GT(glm::dot(-travels, direction_to_sun(scene.sun.elevation, scene.sun.azimuth)), 0.99999f);
  const Light& light = document().lights[std::size_t(sun->light)];
  EXPECT_NEAR(light.intensity * light.color.y, scene.make_sky(64, 32).sun_irradiance.y, 1e-3f);
}

struct Size {
  const char* scene;
  double triangles;
  double instances;
};

// The counts of the paper's tables; small deviations only for the room and the objects.
TEST(PaperScenes, MatchSizesOfPaperTables) {
  for (const Size& size : {Size{"cubes_distance", 170, 15}, Size{"icosphere", 27e3, 17},
                           Size{"glossy_sponza_1", 344e3, 476}, Size{"shadow_objects", 18e3, 22},
                           Size{"pillars", 62e3, 77}, Size{"breakfast_room", 40e3, 167}}) {
    const Document& document = document_of(size.scene);
    EXPECT_NEAR(double(document.drawn_triangles()), size.triangles, 0.03 * size.triangles)
        << size.scene;
    EXPECT_EQ(double(document.instance_count()), size.instances) << size.scene;
  }
}

TEST(PaperScenes, AreFoundByName) {
  EXPECT_EQ(paper_scenes().size(), 8u);
  for (const PaperScene& scene : paper_scenes()) {
    EXPECT_EQ(find_paper_scene(scene.name).name, scene.name);
  }
  EXPECT_THROW(find_paper_scene("teapot"), std::invalid_argument);
}

TEST(Sweep, SetsUniformRoughnessOfSweptMaterials) {
  Document document = document_of("breakfast_room");
  apply({.roughness = 0.6f, .shadow_angle = {}}, document);
  const nlohmann::json gltf = parse_glb(encode_glb(document, texture_size));
  int swept = 0;
  for (const nlohmann::json& material : gltf.at("materials")) {
    const bool takes_part = material.contains("extras") && material.at("extras").at("sweep");
    const float factor = material.at("pbrMetallicRoughness").at("roughnessFactor");
    if (takes_part) {
      EXPECT_FLOAT_EQ(factor, 0.6f) << material.at("name");
      ++swept;
    } else {
      EXPECT_NE(factor, 0.6f) << material.at("name");
    }
  }
  EXPECT_EQ(swept, 5);  // floor, table, chairs, steel, brass
}

TEST(Sweep, WritesShadowAngleOfZero) {
  Document document = document_of("pillars");
  apply({.roughness = {}, .shadow_angle = 0.0f}, document);
  const nlohmann::json gltf = parse_glb(encode_glb(document, texture_size));
  int found = 0;
  for (const nlohmann::json& node : gltf.at("nodes")) {
    if (node.at("name") != "sun") continue;
    EXPECT_EQ(node.at("extras").at("angularDiameterDeg"), 0.0f);
    ++found;
  }
  EXPECT_EQ(found, 1);
}

}  // namespace
}  // namespace heliograph::scenes
