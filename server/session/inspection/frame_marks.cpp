#include "session/inspection/frame_marks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "session/inspection/snapping.hpp"
#include "session/library/scene_description.hpp"

namespace heliograph::session {
namespace {

using Places = std::vector<glm::vec3>;

constexpr int arc_steps = 16;
constexpr float arc_radius = 0.3f;  // of the shorter arm

stream::MarkPoint to_mark(const glm::vec2& place) {
  return {.x = place.x, .y = place.y};
}

/// Adds what lies within the image.
class MarkBuilder {
 public:
  MarkBuilder(stream::ImageMarks& marks, const FrameView& view) : marks_(marks), view_(view) {}

  void line(const glm::vec3& from, const glm::vec3& to, bool thin = false) {
    const auto ends = view_.image_line(from, to);
    if (!ends) return;
    marks_.lines.push_back(
        {.from = to_mark(ends->first), .to = to_mark(ends->second), .thin = thin});
  }

  void point(const glm::vec3& position) {
    if (const auto place = view_.image_point(position)) marks_.points.push_back(to_mark(*place));
  }

  void label(const glm::vec3& position, const std::string& text) {
    const auto place = view_.image_point(position);
    if (place) marks_.labels.push_back({.at = to_mark(*place), .text = text});
  }

  void pin(const protocol::Annotation& annotation, bool hidden) {
    const auto place = view_.image_point(from_protocol(annotation.position));
    if (!place) return;
    marks_.pins.push_back({.at = to_mark(*place),
                           .number = annotation.id,
                           .author = annotation.author,
                           .text = annotation.text,
                           .hidden = hidden});
  }

 private:
  stream::ImageMarks& marks_;
  const FrameView& view_;
};

/// Points of the arc at b from the direction of a to that of c; only b where these are none or one.
Places arc_between(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const glm::vec3 first = a - b, second = c - b;
  const glm::vec3 normal = glm::cross(first, second);
  if (glm::length(normal) <= 1e-6f * glm::length(first) * glm::length(second)) return {b};
  const glm::vec3 along = glm::normalize(first);
  const glm::vec3 across = glm::cross(glm::normalize(normal), along);
  const float angle = std::atan2(glm::length(normal), glm::dot(first, second));
  const float radius = arc_radius * std::min(glm::length(first), glm::length(second));
  Places arc;
  for (int i = 0; i <= arc_steps; ++i) {
    const float turn = angle * static_cast<float>(i) / arc_steps;
    arc.push_back(b + radius * (std::cos(turn) * along + std::sin(turn) * across));
  }
  return arc;
}

void add_angle(MarkBuilder& marks, const Places& points, const std::string& text) {
  marks.line(points[1], points[0]);
  marks.line(points[1], points[2]);
  const Places arc = arc_between(points[0], points[1], points[2]);
  for (std::size_t i = 1; i < arc.size(); ++i) marks.line(arc[i - 1], arc[i]);
  marks.label(arc[arc.size() / 2], text);
}

/// Corners whose indices differ in one bit share an edge.
void add_box(MarkBuilder& marks, const protocol::Bounds& bounds, const std::string& text) {
  const std::array sides{from_protocol(bounds.min), from_protocol(bounds.max)};
  const auto corner = [&](std::uint32_t index) {
    return glm::vec3(sides[index & 1].x, sides[index >> 1 & 1].y, sides[index >> 2 & 1].z);
  };
  for (std::uint32_t index = 0; index < 8; ++index) {
    for (const std::uint32_t bit : {1u, 2u, 4u}) {
      if ((index & bit) == 0) marks.line(corner(index), corner(index | bit), true);
    }
  }
  marks.label(0.5f * (corner(2) + corner(7)), text);
}

void add_measurement(MarkBuilder& marks, const protocol::Measurement& measurement) {
  Places points;
  for (const protocol::MeasuredPoint& point : measurement.points) {
    if (point.position) points.push_back(from_protocol(*point.position));
  }
  using Kind = protocol::MeasurementKind;
  if (measurement.kind == Kind::distance && points.size() == 2) {
    marks.line(points[0], points[1]);
    marks.label(0.5f * (points[0] + points[1]), measurement.text);
  } else if (measurement.kind == Kind::angle && points.size() == 3) {
    add_angle(marks, points, measurement.text);
  } else if (measurement.bounds) {
    add_box(marks, *measurement.bounds, measurement.text);
  }
  for (const glm::vec3& point : points) marks.point(point);
}

}  // namespace

void add_measurements(stream::ImageMarks& marks, const FrameView& view,
                      const protocol::MeasurementList& measurements) {
  MarkBuilder builder(marks, view);
  for (const protocol::Measurement& measurement : measurements.measurements) {
    add_measurement(builder, measurement);
  }
}

protocol::Result<stream::ImageMarks> frame_marks(const render::Renderer& renderer,
                                                 const FrameView& view,
                                                 const protocol::MeasurementList& measurements,
                                                 const protocol::AnnotationList& annotations) {
  stream::ImageMarks marks;
  add_measurements(marks, view, measurements);
  const auto covered = hidden_annotations(renderer, view, annotations);
  if (!covered) return covered.error();
  MarkBuilder builder(marks, view);
  for (const protocol::Annotation& annotation : annotations.annotations) {
    const bool hidden = std::ranges::find(covered->hidden, annotation.id) != covered->hidden.end();
    builder.pin(annotation, hidden);
  }
  return marks;
}

}  // namespace heliograph::session
