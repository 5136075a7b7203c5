#include "scenes/generator/geometry/profile.hpp"

#include <cmath>

namespace heliograph::scenes {
namespace {

glm::vec2 right_of(glm::vec2 direction) {
  return glm::normalize(glm::vec2(direction.y, -direction.x));
}

}  // namespace

void Profile::add_run(std::vector<ProfilePoint> run) {
  run.front().distance = length_;
  for (std::size_t i = 1; i < run.size(); ++i) {
    length_ += glm::distance(run[i].position, run[i - 1].position);
    run[i].distance = length_;
  }
  pen_ = run.back().position;
  runs_.push_back(std::move(run));
}

Profile& Profile::line_to(glm::vec2 end) {
  const glm::vec2 normal = right_of(end - pen_);
  add_run({{pen_, normal, 0.0f}, {end, normal, 0.0f}});
  return *this;
}

Profile& Profile::arc_to(glm::vec2 end, float bulge, int segments) {
  const glm::vec2 chord = end - pen_;
  const glm::vec2 outward = right_of(chord);
  const float half_chord = 0.5f * glm::length(chord);
  const float sagitta = std::abs(bulge) * half_chord;
  const float radius = (half_chord * half_chord + sagitta * sagitta) / (2.0f * sagitta);
  const float side = bulge > 0.0f ? 1.0f : -1.0f;
  const glm::vec2 center = pen_ + 0.5f * chord + outward * side * (sagitta - radius);
  // Half the opening angle, also right when the arc is larger than a half circle.
  const float half_angle = std::atan2(half_chord, radius - sagitta);
  const glm::vec2 along = glm::normalize(chord);
  std::vector<ProfilePoint> run;
  for (int i = 0; i <= segments; ++i) {
    const float angle = half_angle * (2.0f * float(i) / float(segments) - 1.0f);
    const glm::vec2 spoke = outward * side * std::cos(angle) + along * std::sin(angle);
    run.push_back({center + radius * spoke, spoke * side, 0.0f});
  }
  run.front().position = pen_;
  run.back().position = end;
  add_run(std::move(run));
  return *this;
}

Profile& Profile::curve_through(const std::vector<glm::vec2>& points, int segments_per_span) {
  std::vector<glm::vec2> knots{pen_};
  knots.insert(knots.end(), points.begin(), points.end());
  const int last = int(knots.size()) - 1;
  // Mirrored end points make the curve leave and arrive without bending.
  const auto knot = [&](int i) {
    if (i < 0) return 2.0f * knots[0] - knots[1];
    if (i > last) return 2.0f * knots[last] - knots[last - 1];
    return knots[i];
  };
  std::vector<ProfilePoint> run;
  for (int span = 0; span < last; ++span) {
    const glm::vec2 start = knot(span);
    const glm::vec2 end = knot(span + 1);
    const glm::vec2 leave = 0.5f * (end - knot(span - 1));
    const glm::vec2 arrive = 0.5f * (knot(span + 2) - start);
    for (int i = span == 0 ? 0 : 1; i <= segments_per_span; ++i) {
      const float t = float(i) / float(segments_per_span);
      const float t2 = t * t;
      const float t3 = t2 * t;
      const glm::vec2 position = (2 * t3 - 3 * t2 + 1) * start + (t3 - 2 * t2 + t) * leave +
                                 (-2 * t3 + 3 * t2) * end + (t3 - t2) * arrive;
      const glm::vec2 slope = (6 * t2 - 6 * t) * start + (3 * t2 - 4 * t + 1) * leave +
                              (-6 * t2 + 6 * t) * end + (3 * t2 - 2 * t) * arrive;
      run.push_back({position, right_of(slope), 0.0f});
    }
  }
  add_run(std::move(run));
  return *this;
}

}  // namespace heliograph::scenes
