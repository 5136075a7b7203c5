#include "scenes/generator/atrium.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <set>
#include <tuple>

#include "scenes/generator/glb.hpp"

namespace heliograph::scenes {
namespace {

const ClearSky& small_sky() {
  static const ClearSky sky = make_clear_sky(direction_to_sun(sun_elevation, sun_azimuth), 64, 32);
  return sky;
}

const Document& atrium() {
  static const Document document = make_atrium(1, small_sky());
  return document;
}

TEST(Atrium, HasTheSizeOfThePapersScene) {
  EXPECT_NEAR(double(atrium().drawn_triangles()), 344e3, 10e3);
  EXPECT_NEAR(double(atrium().instance_count()), 476.0, 8.0);
  EXPECT_GE(atrium().materials.size(), 22u);
}

TEST(Atrium, IndicesAreInRangeAndTrianglesHaveArea) {
  for (const NamedMesh& named : atrium().meshes) {
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

TEST(Atrium, NormalsAndTangentsAreOrthonormal) {
  for (const NamedMesh& named : atrium().meshes) {
    for (const Vertex& vertex : named.mesh.vertices) {
      const glm::vec3 tangent(vertex.tangent);
      ASSERT_NEAR(glm::length(vertex.normal), 1.0f, 1e-4f) << named.name;
      ASSERT_NEAR(glm::length(tangent), 1.0f, 1e-4f) << named.name;
      ASSERT_NEAR(glm::dot(vertex.normal, tangent), 0.0f, 1e-3f) << named.name;
      ASSERT_EQ(std::abs(vertex.tangent.w), 1.0f) << named.name;
    }
  }
}

// A wrong winding shows as a face that looks away from the normals of its corners; normals taken
// over a kink, as a face far from all of them.
TEST(Atrium, FacesLookWhereTheirNormalsPoint) {
  for (const NamedMesh& named : atrium().meshes) {
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

TEST(Atrium, TangentsFollowTheTextureCoordinates) {
  for (const NamedMesh& named : atrium().meshes) {
    const Mesh& mesh = named.mesh;
    if (!atrium().materials[std::size_t(named.material)].texture) continue;
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      const Vertex& a = mesh.vertices[mesh.indices[i]];
      const Vertex& b = mesh.vertices[mesh.indices[i + 1]];
      const Vertex& c = mesh.vertices[mesh.indices[i + 2]];
      // What the tangent says of the edges must be what their uv says.
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

TEST(Atrium, ClosedShapesAreWoundConsistently) {
  // Of a closed surface every edge is shared by two triangles that run along it in opposite
  // directions. Vertices are split at kinks and seams, so positions identify the edges.
  using Point = std::tuple<long, long, long>;
  const auto point = [](glm::vec3 p) {
    return Point{std::lround(p.x * 1e5), std::lround(p.y * 1e5), std::lround(p.z * 1e5)};
  };
  int checked = 0;
  for (const NamedMesh& named : atrium().meshes) {
    if (named.name != "hero_sphere" && named.name != "lamp_chain" && named.name != "corner_piers" &&
        named.name != "gallery_beams") {
      continue;
    }
    std::map<std::pair<Point, Point>, int> edges;
    const Mesh& mesh = named.mesh;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Point from = point(mesh.vertices[mesh.indices[i + k]].position);
        const Point to = point(mesh.vertices[mesh.indices[i + (k + 1) % 3]].position);
        if (from < to) ++edges[{from, to}];
        if (to < from) --edges[{to, from}];
      }
    }
    for (const auto& [edge, balance] : edges) ASSERT_EQ(balance, 0) << named.name;
    ++checked;
  }
  EXPECT_EQ(checked, 4);
}

TEST(Atrium, HasItsCamerasAndASunThatAgreesWithTheSky) {
  std::set<std::string> cameras;
  for (const Camera& camera : atrium().cameras) cameras.insert(camera.name);
  for (const char* name : {"main", "gallery", "courtyard", "floor"}) {
    EXPECT_TRUE(cameras.contains(name)) << name;
  }
  EXPECT_EQ(atrium().cameras.front().name, "main");

  const auto is_sun = [](const Node& node) { return node.name == "sun"; };
  const auto node = std::find_if(atrium().nodes.begin(), atrium().nodes.end(), is_sun);
  ASSERT_NE(node, atrium().nodes.end());
  EXPECT_FLOAT_EQ(node->angular_diameter.value(), 0.53f);
  const glm::vec3 travels = node->rotation * glm::vec3(0.0f, 0.0f, -1.0f);
  EXPECT_GT(glm::dot(-travels, direction_to_sun(sun_elevation, sun_azimuth)), 0.99999f);
  const Light& sun = atrium().lights[std::size_t(node->light)];
  EXPECT_NEAR(sun.intensity * sun.color.y, small_sky().sun_irradiance.y, 1e-3f);
}

TEST(Atrium, TheSunReachesTheFloorButNotAllOfIt) {
  // The shadow of the southern eaves, 13 m high at z = 4.4, must end on the floor of the nave.
  const glm::vec3 to_sun = direction_to_sun(sun_elevation, sun_azimuth);
  const float shadow = 13.0f * to_sun.z / to_sun.y;
  EXPECT_GT(4.4f - shadow, -3.0f);
  EXPECT_LT(4.4f - shadow, 3.0f);
}

TEST(Atrium, ClipsAreLoopsOfTenSecondsWithUnitRotations) {
  ASSERT_EQ(atrium().animations.size(), 2u);
  EXPECT_EQ(atrium().animations[0].name, "moving_camera");
  EXPECT_EQ(atrium().animations[1].name, "moving_objects_light");
  for (const Animation& animation : atrium().animations) {
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

TEST(Atrium, TheSameSceneGivesTheSameBytes) {
  constexpr int texture_size = 32;
  const auto first = encode_glb(make_atrium(1, small_sky()), texture_size);
  const auto second = encode_glb(make_atrium(1, small_sky()), texture_size);
  EXPECT_EQ(first, second);
}

TEST(Atrium, TheThreeCasesDifferInWhatIsSwept) {
  const auto swept = [](const Document& document) {
    return std::count_if(document.materials.begin(), document.materials.end(),
                         [](const Material& material) { return material.swept; });
  };
  const auto floor = swept(atrium());
  const auto columns = swept(make_atrium(2, small_sky()));
  const auto nearly_all = swept(make_atrium(3, small_sky()));
  EXPECT_GT(floor, 0);
  EXPECT_GT(columns, floor);
  EXPECT_GT(nearly_all, columns);
  EXPECT_THROW(make_atrium(4, small_sky()), std::invalid_argument);
}

}  // namespace
}  // namespace heliograph::scenes
