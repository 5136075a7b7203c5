#include "scenes/generator/atrium/atrium_plan.hpp"

namespace heliograph::scenes::plan {

std::vector<Spot> bays() {
  std::vector<Spot> spots;
  for (const float side : {-1.0f, 1.0f}) {
    for (int i = 0; i < long_bays; ++i) {
      spots.push_back({{-arcade.x + bay * (float(i) + 0.5f), side * arcade.y},
                       side < 0.0f ? 0.0f : 180.0f,
                       true});
    }
  }
  for (const float side : {-1.0f, 1.0f}) {
    for (int i = 0; i < short_bays; ++i) {
      spots.push_back({{side * arcade.x, -arcade.y + short_bay * (float(i) + 0.5f)},
                       side < 0.0f ? 90.0f : -90.0f,
                       false});
    }
  }
  return spots;
}

std::vector<Spot> columns() {
  std::vector<Spot> spots;
  for (const float side : {-1.0f, 1.0f}) {
    for (int i = 0; i <= long_bays; ++i) {
      spots.push_back(
          {{-arcade.x + bay * float(i), side * arcade.y}, side < 0.0f ? 0.0f : 180.0f, true});
    }
  }
  for (const float side : {-1.0f, 1.0f}) {
    for (int i = 1; i < short_bays; ++i) {
      spots.push_back({{side * arcade.x, -arcade.y + short_bay * float(i)},
                       side < 0.0f ? 90.0f : -90.0f,
                       false});
    }
  }
  return spots;
}

std::vector<Spot> sides(float outwards) {
  const float x = arcade.x + outwards;
  const float z = arcade.y + outwards;
  return {{{0.0f, -z}, 0.0f, true},
          {{0.0f, z}, 180.0f, true},
          {{-x, 0.0f}, 90.0f, false},
          {{x, 0.0f}, -90.0f, false}};
}

}  // namespace heliograph::scenes::plan
