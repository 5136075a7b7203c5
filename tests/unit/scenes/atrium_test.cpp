#include "scenes/generator/atrium/atrium.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <set>
#include <stdexcept>
#include <tuple>

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

TEST(Atrium, MatchesSizeOfPaperScene) {
  EXPECT_NEAR(double(atrium().drawn_triangles()), 344e3, 10e3);
  EXPECT_NEAR(double(atrium().instance_count()), 476.0, 8.0);
  EXPECT_GE(atrium().materials.size(), 22u);
}

TEST(Atrium, ClosedShapesAreWoundConsistently) {
  // In a closed surface every edge belongs to two triangles of opposite direction. Vertices are
  // split at creases and seams, so positions identify edges.
  using Point = std::tuple<long, long, long>;
  const auto point = [](glm::vec3 p) {
    return Point{std::lround(p.x * 1e5), std::lround(p.y * 1e5), std::lround(p.z * 1e5)};
  };
  int checked = 0;
  for (const NamedMesh& named : atrium().meshes) {
    if (named.name != "hero_sphere" && named.name != "lantern_chain" &&
        named.name != "corner_piers" && named.name != "gallery_beams") {
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

TEST(Atrium, HasCamerasAndSunMatchesSky) {
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

TEST(Atrium, SunReachesPartOfFloor) {
  // The shadow of the southern eaves, 13 m high at z = 4.4, must end on the floor of the nave.
  const glm::vec3 to_sun = direction_to_sun(sun_elevation, sun_azimuth);
  const float shadow = 13.0f * to_sun.z / to_sun.y;
  EXPECT_GT(4.4f - shadow, -3.0f);
  EXPECT_LT(4.4f - shadow, 3.0f);
}

TEST(Atrium, CasesDifferInSweptMaterials) {
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
