#include "session/nodes/node_state.hpp"

#include <gtest/gtest.h>

#include "session/nodes/node_properties.hpp"

namespace heliograph::session {
namespace {

constexpr std::uint32_t car = 0, body = 1, wheel = 2, road = 3, origin = 4;
constexpr std::uint32_t body_mesh = 0, wheel_mesh = 1, road_mesh = 2;  // instances as well

/// A car of a body, which is skinned, and a wheel, on a road.
std::shared_ptr<const scene::Scene> street() {
  auto scene = std::make_shared<scene::Scene>();
  scene->nodes.resize(5);
  scene->nodes[car].name = "Car";
  scene->nodes[body].parent = scene->nodes[wheel].parent = car;
  scene->nodes[road].name = "road";
  scene->meshes.resize(3);
  scene->meshes[body_mesh].name = "hull";
  scene->instances = {{body_mesh, origin}, {wheel_mesh, wheel}, {road_mesh, road}};
  scene->deformations.push_back({.mesh = body_mesh, .shape = 0, .node = body, .skin = 0});
  return scene;
}

using Ids = std::vector<std::uint32_t>;

TEST(NodeState, HidesWhatIsBelowASkinnedMeshesNodeToo) {
  NodeState state(street());
  EXPECT_EQ(state.hidden_instances(), nullptr);
  EXPECT_TRUE(state.set_visible(Ids{car}, false));
  EXPECT_EQ(*state.hidden_instances(), (std::vector<bool>{true, true, false}));
  EXPECT_EQ(state.hidden(), Ids{car});
  EXPECT_FALSE(state.set_visible(Ids{car}, false)) << "nothing changes";
  EXPECT_TRUE(state.set_visible(Ids{car}, true));
  EXPECT_EQ(state.hidden_instances(), nullptr);
}

TEST(NodeState, IsolatesAmongWhatIsVisible) {
  NodeState state(street());
  state.isolate(Ids{car});
  EXPECT_EQ(*state.hidden_instances(), (std::vector<bool>{false, false, true}));
  state.set_visible(Ids{wheel}, false);
  EXPECT_EQ(*state.hidden_instances(), (std::vector<bool>{false, true, true}));
  state.isolate({});
  EXPECT_EQ(*state.hidden_instances(), (std::vector<bool>{false, true, false}));
}

TEST(NodeState, SelectsInstancesBelowNodesOnce) {
  NodeState state(street());
  EXPECT_TRUE(state.select(Ids{wheel, car, wheel}));
  EXPECT_EQ(state.selected(), (Ids{car, wheel}));
  EXPECT_EQ(*state.selected_instances(), (Ids{body_mesh, wheel_mesh}));
  EXPECT_TRUE(state.select({}));
  EXPECT_EQ(state.selected_instances(), nullptr);
}

TEST(NodeState, RefusesUnknownIdsByTheirPlace) {
  const auto refused = NodeState(street()).check(Ids{road, 5}, "nodes");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().path, "nodes[1]");
  EXPECT_EQ(refused.error().limit, "0..4");
}

TEST(NodeList, NamesNodesAfterTheirMeshesAndFindsThemInAnyCase) {
  const auto scene = street();
  const protocol::NodeList found =
      list_nodes(*scene, NodeState(scene), {.search = "HU", .first = 0, .count = 9});
  ASSERT_EQ(found.total, 1u);
  EXPECT_EQ(found.nodes[0].id, body);
  EXPECT_EQ(found.nodes[0].name, "hull");
  EXPECT_EQ(found.nodes[0].parent, car);
}

}  // namespace
}  // namespace heliograph::session
