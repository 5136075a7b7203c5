#include "session/inspection/measurement_set.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "session/inspection/anchors.hpp"
#include "session/inspection/measured_text.hpp"

namespace heliograph::session {
namespace {

using protocol::MeasuredPoint;
using protocol::MeasurementKind;

/// A node with two meshes, of one and two triangles, turned by 45 degrees and moved by a clip.
std::shared_ptr<const scene::Scene> turned_square() {
  auto scene = std::make_shared<scene::Scene>();
  scene->nodes.resize(2);
  scene->nodes[1].world = glm::rotate(glm::mat4(1.0f), glm::radians(45.0f), {0, 0, 1});
  scene->nodes[1].local = scene->nodes[1].world;
  scene->nodes[1].transform =
      scene::Transform{.rotation = glm::angleAxis(glm::radians(45.0f), glm::vec3(0, 0, 1))};
  scene->meshes.resize(2);
  for (const glm::vec3 corner : {glm::vec3(-1, -1, 0), glm::vec3(1, -1, 0), glm::vec3(1, 1, 0)}) {
    shared::Vertex vertex{};
    vertex.position = corner;
    scene->meshes[0].vertices.push_back(vertex);
    scene->meshes[1].vertices.push_back(vertex);
  }
  scene->meshes[0].indices = {0, 1, 2};
  scene->meshes[1].indices = {0, 1, 2, 2, 1, 0};
  scene->instances = {{0, 1}, {1, 1}};
  scene->clips.push_back({.name = "slide",
                          .duration = 1.0f,
                          .channels = {{{.times = {0.0f, 1.0f}, .values = {0, 0, 0, 3, 0, 0}},
                                        1,
                                        scene::Property::translation}}});
  return scene;
}

class MeasurementSetTest : public testing::Test {
 protected:
  protocol::Result<void> add(const protocol::MeasurementAdd& request) {
    return set_.add(part_, *scene_, nodes_, request);
  }
  protocol::MeasurementList list(double seconds = 0.0) const {
    const scene::Clip* const clip = seconds > 0.0 ? scene::find_clip(*scene_, "slide") : nullptr;
    return set_.list(part_, *scene_, scene::pose_at(*scene_, clip, seconds));
  }
  static MeasuredPoint place(float x, float y, float z) { return {.position = {{x, y, z}}}; }
  static MeasuredPoint corner(std::uint32_t triangle, protocol::Vec3 weights) {
    return {.surface = {{.node = 1, .triangle = triangle, .barycentrics = weights}}};
  }

  const std::shared_ptr<const scene::Scene> scene_ = turned_square();
  const NodeState nodes_{scene_};
  const ScenePart part_{.name = "square"};
  MeasurementSet set_;
};

TEST_F(MeasurementSetTest, MeasuresBetweenSurfacesThatMove) {
  ASSERT_TRUE(add({.points = {corner(0, {1, 0, 0}), corner(2, {1, 0, 0})}}));
  ASSERT_TRUE(add({.points = {place(0, 0, 0), corner(0, {0, 0, 1})}}));
  const protocol::MeasurementList at_rest = list(), later = list(1.0);
  EXPECT_NEAR(at_rest.measurements[0].value, std::sqrt(8.0), 1e-6) << "of two of its meshes";
  EXPECT_NEAR(later.measurements[0].value, std::sqrt(8.0), 1e-6) << "both ends move";
  EXPECT_NEAR(at_rest.measurements[1].value, std::sqrt(2.0), 1e-6);
  EXPECT_NEAR(later.measurements[1].value, std::sqrt(9.0 + 2.0), 1e-6);
  EXPECT_EQ(at_rest.measurements[1].text, "1.414 m");
}

TEST_F(MeasurementSetTest, MeasuresAnglesAtTheSecondPoint) {
  ASSERT_TRUE(add({.kind = MeasurementKind::angle,
                   .points = {place(1, 0, 0), place(0, 0, 0), place(1, 1, 0)}}));
  EXPECT_NEAR(list().measurements[0].value, 45.0, 1e-9);
  EXPECT_EQ(list().measurements[0].text, "45°");
}

TEST_F(MeasurementSetTest, TakesSizesFromTheVerticesOfTurnedNodes) {
  ASSERT_TRUE(add({.kind = MeasurementKind::size, .nodes = {1}}));
  const protocol::Measurement size = list().measurements[0];
  const float half = std::sqrt(2.0f);
  EXPECT_NEAR((*size.extent)[0], half, 1e-6f) << "a corner's box would be twice as wide";
  EXPECT_NEAR((*size.extent)[1], 2 * half, 1e-6f);
  set_.set_unit(protocol::LengthUnit::cm);
  EXPECT_EQ(list().measurements[0].text, "141.4 × 282.8 × 0 cm");
}

TEST_F(MeasurementSetTest, RefusesWhatDoesNotFitByField) {
  const auto path = [&](const protocol::MeasurementAdd& request) {
    const auto refused = add(request);
    return refused ? std::string("accepted") : refused.error().path;
  };
  const MeasuredPoint origin = place(0, 0, 0);
  EXPECT_EQ(path({.points = {origin}}), "points");
  EXPECT_EQ(path({.points = {origin, origin}, .nodes = {1}}), "nodes");
  EXPECT_EQ(path({.points = {origin, MeasuredPoint()}}), "points[1]");
  EXPECT_EQ(path({.points = {origin, corner(3, {1, 0, 0})}}), "points[1].surface.triangle");
  EXPECT_EQ(path({.points = {corner(0, {1, 1, 0}), origin}}), "points[0].surface.barycentrics");
  MeasuredPoint nowhere = corner(0, {1, 0, 0});
  nowhere.surface->node = 0;
  EXPECT_EQ(path({.points = {nowhere, origin}}), "points[0].surface.node");
  EXPECT_EQ(path({.kind = MeasurementKind::size, .nodes = {7}}), "nodes[0]");
  EXPECT_EQ(path({.kind = MeasurementKind::size, .nodes = {0}}), "nodes");
  EXPECT_TRUE(list().measurements.empty());
  EXPECT_EQ(list().changes, 0u) << "nothing changed";
}

TEST_F(MeasurementSetTest, KeepsIdsSoThatARemovedOneCanReturn) {
  const std::vector<MeasuredPoint> points{place(0, 0, 0), place(1, 0, 0)};
  ASSERT_TRUE(add({.points = points}));
  ASSERT_TRUE(add({.points = points}));
  ASSERT_TRUE(set_.remove(part_, 1));
  EXPECT_EQ(set_.remove(part_, 1).error().path, "id");
  ASSERT_TRUE(add({.points = points, .id = 1}));
  EXPECT_EQ(add({.points = points, .id = 1}).error().path, "id");
  ASSERT_TRUE(add({.points = points}));
  std::vector<std::uint32_t> ids;
  for (const protocol::Measurement& one : list().measurements) ids.push_back(one.id);
  EXPECT_EQ(ids, (std::vector<std::uint32_t>{1, 2, 3}));
}

TEST_F(MeasurementSetTest, KeepsThoseOfOtherScenesAndHasALimit) {
  const std::vector<MeasuredPoint> points{place(0, 0, 0), place(1, 0, 0)};
  for (std::size_t i = 0; i < protocol::max_measurements; ++i) ASSERT_TRUE(add({.points = points}));
  EXPECT_EQ(add({.points = points}).error().code, protocol::ErrorCode::full);
  set_.clear({.name = "square", .part = 1});
  EXPECT_EQ(list().measurements.size(), protocol::max_measurements);
  set_.clear(part_);
  EXPECT_TRUE(list().measurements.empty());
}

TEST(MeasuredText, HasFourDigitsAndNoExponent) {
  using protocol::LengthUnit;
  EXPECT_EQ(length_text(1.25, LengthUnit::m), "1.25 m");
  EXPECT_EQ(length_text(0.0254, LengthUnit::in), "1 in");
  EXPECT_EQ(length_text(123456.7, LengthUnit::mm), "123456700 mm");
  EXPECT_EQ(length_text(2e-5, LengthUnit::km), "0.00000002 km");
  EXPECT_EQ(length_text(0.0, LengthUnit::ft), "0 ft");
  EXPECT_EQ(angle_text(33.333333), "33.33°");
}

}  // namespace
}  // namespace heliograph::session
