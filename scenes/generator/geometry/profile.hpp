#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace heliograph::scenes {

struct ProfilePoint {
  glm::vec2 position{0.0f};
  glm::vec2 normal{0.0f};
  float distance = 0.0f;  // arc length from the start, metres
};

/// A line made of smooth runs, drawn like a draughtsman draws a moulding: lines, arcs, curves.
/// Every run carries its own exact normals, so a kink between two runs stays sharp. Normals point
/// to the right of the drawing direction: going up, that is away from the axis of a lathe.
class Profile {
 public:
  explicit Profile(glm::vec2 start) : pen_(start) {}

  Profile& line_to(glm::vec2 end);
  Profile& line_by(glm::vec2 step) { return line_to(pen_ + step); }

  /// Circular arc to `end`; `bulge` is its sagitta divided by half the chord (1 = half circle),
  /// positive to the right of the drawing direction (a convex torus), negative for a hollow.
  Profile& arc_to(glm::vec2 end, float bulge, int segments);
  Profile& arc_by(glm::vec2 step, float bulge, int segments) {
    return arc_to(pen_ + step, bulge, segments);
  }

  /// Catmull-Rom curve through the pen and `points`, as one smooth run.
  Profile& curve_through(const std::vector<glm::vec2>& points, int segments_per_span);

  const std::vector<std::vector<ProfilePoint>>& runs() const { return runs_; }
  glm::vec2 pen() const { return pen_; }
  float length() const { return length_; }

 private:
  void add_run(std::vector<ProfilePoint> run);

  glm::vec2 pen_;
  float length_ = 0.0f;
  std::vector<std::vector<ProfilePoint>> runs_;
};

}  // namespace heliograph::scenes
