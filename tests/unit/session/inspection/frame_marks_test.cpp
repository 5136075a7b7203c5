#include "session/inspection/frame_marks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace heliograph::session {
namespace {

using protocol::Measurement;
using protocol::MeasurementKind;
using protocol::MeasurementList;
using protocol::Vec3;

/// From (0, 0, 10) towards the origin, where it shows 20 metres in height and 40 in width.
RenderState seen_from_the_front() {
  RenderState state;
  state.scene = std::make_shared<scene::Scene>();
  state.width = 200;
  state.height = 100;
  state.camera = {.eye = {0, 0, 10}, .target = {0, 0, 0}, .vertical_fov = 90.0f};
  return state;
}

protocol::MeasuredPoint at(float x, float y, float z) {
  return {.position = Vec3{x, y, z}, .surface = {}};
}

stream::ImageMarks marks_of(const Measurement& measurement,
                            const RenderState& state = seen_from_the_front()) {
  MeasurementList list;
  list.measurements = {measurement};
  stream::ImageMarks marks;
  add_measurements(marks, FrameView(state), list);
  return marks;
}

void expect_at(const stream::MarkPoint& point, double x, double y) {
  EXPECT_NEAR(point.x, x, 1e-5);
  EXPECT_NEAR(point.y, y, 1e-5);
}

TEST(FrameMarks, DistancesAreLinesWithLabelsAtTheirMiddle) {
  Measurement measurement{.kind = MeasurementKind::distance, .text = "10 m"};
  measurement.points = {at(-10, 0, 0), at(0, 5, 0)};
  const stream::ImageMarks marks = marks_of(measurement);
  ASSERT_EQ(marks.lines.size(), 1u);
  expect_at(marks.lines[0].from, 0.25, 0.5);
  expect_at(marks.lines[0].to, 0.5, 0.25);
  EXPECT_EQ(marks.points.size(), 2u);
  ASSERT_EQ(marks.labels.size(), 1u);
  expect_at(marks.labels[0].at, 0.375, 0.375);
  EXPECT_EQ(marks.labels[0].text, "10 m");
}

TEST(FrameMarks, AnglesHaveAnArcBetweenTheirArms) {
  Measurement measurement{.kind = MeasurementKind::angle, .text = "90°"};
  measurement.points = {at(10, 0, 0), at(0, 0, 0), at(0, 10, 0)};
  const stream::ImageMarks marks = marks_of(measurement);
  EXPECT_EQ(marks.lines.size(), 2u + 16u);
  const double reach = 3.0 * std::sqrt(0.5);
  expect_at(marks.labels.at(0).at, 0.5 + reach / 40.0, 0.5 - reach / 20.0);
  measurement.points[2] = at(-10, 0, 0);
  const stream::ImageMarks straight = marks_of(measurement);
  EXPECT_EQ(straight.lines.size(), 2u) << "there is no plane for an arc";
  expect_at(straight.labels.at(0).at, 0.5, 0.5);
}

TEST(FrameMarks, SizesAreBoxes) {
  Measurement measurement{.kind = MeasurementKind::size, .text = "2 × 2 × 2 m"};
  measurement.bounds = {.min = {-1, -1, -1}, .max = {1, 1, 1}};
  const stream::ImageMarks marks = marks_of(measurement);
  EXPECT_EQ(marks.lines.size(), 12u);
  EXPECT_TRUE(marks.lines[0].thin);
  EXPECT_EQ(marks.labels.size(), 1u);
}

TEST(FrameMarks, LinesEndBeforeTheEyeAndNotFarFromTheImage) {
  Measurement measurement{.kind = MeasurementKind::distance, .text = "far"};
  measurement.points = {at(1, 0, 0), at(1, 0, 1000)};
  const stream::ImageMarks passing = marks_of(measurement);
  ASSERT_EQ(passing.lines.size(), 1u);
  expect_at(passing.lines[0].from, 0.525, 0.5);
  EXPECT_NEAR(passing.lines[0].to.x, 2.0, 1e-3);
  EXPECT_EQ(passing.points.size(), 1u);
  EXPECT_TRUE(passing.labels.empty());
  measurement.points = {at(0, 0, 11), at(0, 5, 12)};
  EXPECT_TRUE(marks_of(measurement).empty()) << "behind the eye";
  measurement.points = {at(-1e5f, 0, 0), at(1e5f, 0, 0)};
  const stream::ImageMarks wide = marks_of(measurement);
  ASSERT_EQ(wide.lines.size(), 1u);
  EXPECT_NEAR(wide.lines[0].from.x, -1.0, 1e-3);
  EXPECT_NEAR(wide.lines[0].to.x, 2.0, 1e-3);
}

TEST(FrameMarks, OrthographicCamerasShowThemTheSameAtAnyDepth) {
  RenderState state = seen_from_the_front();
  state.camera.orthographic_height = 20.0f;
  Measurement measurement{.kind = MeasurementKind::distance, .text = "5 m"};
  measurement.points = {at(10, 0, -50), at(10, 5, 5)};
  const stream::ImageMarks marks = marks_of(measurement, state);
  ASSERT_EQ(marks.lines.size(), 1u);
  expect_at(marks.lines[0].from, 0.75, 0.5);
  expect_at(marks.lines[0].to, 0.75, 0.25);
}

}  // namespace
}  // namespace heliograph::session
