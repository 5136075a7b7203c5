#include "render/resources/lights/light_grid.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <set>

#include "render/resources/lights/light_tree.hpp"

namespace heliograph::render {
namespace {

using Entries = std::array<shared::LightEntry, shared::most_light_entries>;

/// Point lights in a hall of 40 x 8 x 40 metres; one of `every` is 50 times as bright.
std::vector<shared::Light> hall_lights(int count, float range, int every = 1000000) {
  std::mt19937 generator(11);
  std::uniform_real_distribution<float> place(-20.0f, 20.0f), color(0.2f, 1.0f);
  std::vector<shared::Light> lights;
  for (int i = 0; i < count; ++i) {
    shared::Light light{};
    light.type = shared::light_point;
    light.position = {place(generator), 0.2f * place(generator) + 4.0f, place(generator)};
    light.color = glm::vec3(color(generator), color(generator), color(generator));
    if (i % every == every - 1) light.color *= 50.0f;
    light.range = range;
    lights.push_back(light);
  }
  return lights;
}

double irradiance(const shared::Light& light, const glm::vec3& at) {
  const glm::vec3 away = light.position - at;
  const double squared = glm::dot(away, away);
  if (light.range > 0.0f && squared > double{light.range} * light.range) return 0.0;
  return glm::dot(light.color, glm::vec3(0.2126f, 0.7152f, 0.0722f)) / squared;
}

LightBox around(const glm::vec3& at, float half) {
  return {at - half, at + half};
}

struct Estimate {
  double mean = 0.0;
  double variance = 0.0;
  std::size_t entries = 0;
};

/// Mean and variance of the sum over entries, each by a light drawn from its slots.
Estimate estimate(const LightTree& tree, std::span<const shared::Light> lights, const glm::vec3& at,
                  const LightBox& box) {
  Entries found;
  Estimate made;
  made.entries = tree.cut(box, 0.25f * (box.high.x - box.low.x), found);
  for (const shared::LightEntry& entry : std::span(found).first(made.entries)) {
    double first = 0.0, second = 0.0;
    for (const auto& slot : tree.slots().subspan(entry.first_slot, entry.slots)) {
      const double sent = irradiance(lights[slot.light], at) * slot.share * entry.slots;
      first += sent / entry.slots;
      second += sent * sent / entry.slots;
    }
    made.mean += first;
    made.variance += second - first * first;
  }
  return made;
}

double exact(std::span<const shared::Light> lights, const glm::vec3& at) {
  double sum = 0.0;
  for (const shared::Light& light : lights) sum += irradiance(light, at);
  return sum;
}

TEST(LightGrid, MeanOfACutIsTheSumOfAllLights) {
  for (const float range : {0.0f, 2.0f, 9.0f}) {
    const auto lights = hall_lights(1000, range, 100);
    const LightTree tree(lights);
    std::mt19937 generator(3);
    std::uniform_real_distribution<float> place(-25.0f, 25.0f), within(-0.5f, 0.5f);
    for (int i = 0; i < 200; ++i) {
      const glm::vec3 middle(place(generator), 0.3f * place(generator), place(generator));
      const glm::vec3 at =
          middle + glm::vec3(within(generator), within(generator), within(generator));
      const double expected = exact(lights, at);
      EXPECT_NEAR(estimate(tree, lights, at, around(middle, 0.5f)).mean, expected,
                  1e-5 * expected + 1e-9);
    }
  }
}

// Exact selection of one of the lights by their unshadowed light has a relative variance of
// v (1 - v) / v^2 where a fraction v of it arrives, 1 where v is a half. That of the sum adds to it
// with the same weight.
TEST(LightGrid, VarianceIsFarBelowThatOfOneShadowRay) {
  for (const int every : {1000000, 100}) {
    const auto lights = hall_lights(1000, 0.0f, every);
    const LightTree tree(lights);
    std::mt19937 generator(5);
    std::uniform_real_distribution<float> place(-20.0f, 20.0f), within(-0.5f, 0.5f);
    double relative = 0.0;
    constexpr int places = 400;
    for (int i = 0; i < places; ++i) {
      const glm::vec3 middle(place(generator), 0.0f, place(generator));
      const glm::vec3 at =
          middle + glm::vec3(within(generator), within(generator), within(generator));
      const Estimate made = estimate(tree, lights, at, around(middle, 0.5f));
      relative += made.variance / (made.mean * made.mean) / places;
    }
    RecordProperty(every == 100 ? "variance_uneven" : "variance", std::to_string(relative));
    EXPECT_LT(relative, 0.02) << every;
  }
}

TEST(LightGrid, CutsAreBounded) {
  const auto lights = hall_lights(5000, 0.0f);
  const LightTree tree(lights);
  const Estimate made = estimate(tree, lights, {0, 1, 0}, around({0, 1, 0}, 0.5f));
  EXPECT_GT(made.entries, 8u);
  EXPECT_LE(made.entries, shared::most_light_entries);
}

TEST(LightGrid, LightsOutOfReachAreInNoCut) {
  const auto lights = hall_lights(300, 1.5f);
  const LightTree tree(lights);
  Entries found;
  const LightBox box = around({3, 1, 3}, 0.4f);
  const std::size_t count = tree.cut(box, 0.2f, found);
  std::set<std::uint32_t> listed;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::uint32_t s = 0; s < found[i].slots; ++s) {
      listed.insert(tree.slots()[found[i].first_slot + s].light);
    }
  }
  for (std::uint32_t i = 0; i < lights.size(); ++i) {
    const glm::vec3 nearest = glm::clamp(lights[i].position, box.low, box.high);
    const bool reaches = glm::distance(nearest, lights[i].position) < 1.49f;
    EXPECT_TRUE(!reaches || listed.contains(i)) << i;
  }
  EXPECT_LT(listed.size(), 30u);
}

TEST(LightGrid, SlotsFollowIntensity) {
  auto lights = hall_lights(64, 0.0f);
  for (auto& light : lights) light.color = glm::vec3(1.0f);
  lights[7].color = glm::vec3(10.0f);
  lights[8].color = glm::vec3(0.0f);
  const LightTree tree(lights);
  std::vector<std::size_t> slots(lights.size());
  for (const shared::LightSlot& slot : tree.slots()) ++slots[slot.light];
  EXPECT_NEAR(double(slots[7]) / double(slots[0]), 10.0, 1.0);
  EXPECT_EQ(slots[8], 1u);
  EXPECT_LE(tree.slots().size(), LightTree::most_slots(lights.size()));
}

/// A table of a grid alone.
struct Written {
  explicit Written(std::span<const shared::Light> lights, const scene::Bounds& bounds)
      : texels(light_grid_texels(lights)) {
    write_light_grid(lights, bounds, reinterpret_cast<std::byte*>(texels.data()), 0);
    header = reinterpret_cast<const shared::LightGridHeader*>(texels.data());
  }
  std::vector<glm::uvec4> texels;
  const shared::LightGridHeader* header;
};

TEST(LightGrid, CoversWhatLiesNearItsLightsWithCubes) {
  const auto lights = hall_lights(100, 0.0f);
  scene::Bounds bounds;
  bounds.include(glm::vec3(-22, 0, -22));
  bounds.include(glm::vec3(22, 9, 22));
  const Written written(lights, bounds);
  const shared::LightGridHeader& grid = *written.header;
  EXPECT_LE(grid.cells.x * grid.cells.y * grid.cells.z, shared::most_light_cells);
  EXPECT_GT(grid.cells.x * grid.cells.y * grid.cells.z, shared::most_light_cells / 2);
  const glm::vec3 end = grid.origin + glm::vec3(grid.cells) / grid.inverse_size;
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LT(grid.origin[axis], bounds.minimum[axis]);
    EXPECT_GT(end[axis], bounds.maximum[axis]);
  }
  EXPECT_EQ(grid.outside_count, 0u);
  EXPECT_EQ(grid.has_spots, 0u);
}

TEST(LightGrid, ListsLightsThatAreNotPunctual) {
  auto lights = hall_lights(40, 0.0f);
  lights[3].type = shared::light_directional;
  lights[9].type = shared::light_disk;
  lights[10].type = shared::light_spot;
  scene::Bounds flat;
  flat.include(glm::vec3(-30, 0, -30));
  flat.include(glm::vec3(30, 0, 30));
  ASSERT_TRUE(needs_light_grid(lights));
  const Written written(lights, flat);
  ASSERT_EQ(written.header->outside_count, 2u);
  EXPECT_EQ(written.texels[written.header->first_outside].x, 3u);
  EXPECT_EQ(written.texels[written.header->first_outside + 1].x, 9u);
  EXPECT_EQ(written.header->has_spots, 1u);
  EXPECT_FALSE(needs_light_grid(std::span(lights).first(16)));
}

}  // namespace
}  // namespace heliograph::render
