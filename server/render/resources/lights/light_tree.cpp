#include "render/resources/lights/light_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace heliograph::render {
namespace {

/// Of the sum of all lights: errors below it are not worth another entry.
/// ManyLights.OneFrameByTheGridIsNotFarFromTheSum measures what is left.
constexpr float cut_tolerance = 0.04f;
/// Of the numbers that positions are made of, for rounding.
constexpr float range_tolerance = 1e-4f;

float intensity_of(const shared::Light& light) {
  return std::max(glm::dot(light.color, glm::vec3(0.2126f, 0.7152f, 0.0722f)), 0.0f);
}

/// A node as some receivers see it.
struct SeenNode {
  const LightTree::Node* node;
  float light;  // mean irradiance, in the units of the intensity per square metre
  float error;  // by how much it differs between the node's lights
};

/// How receivers see nodes.
class LightReceivers {
 public:
  LightReceivers(const LightBox& box, float near) : box_(box), softening_(near * near) {}

  /// @return whether any light of the node reaches them
  bool look_at(const LightTree::Node& node, SeenNode& seen) const {
    const glm::vec3 away =
        glm::max(glm::max(box_.low - node.box.high, node.box.low - box_.high), glm::vec3(0.0f));
    const float squared = glm::dot(away, away);
    const float reach = node.reach * (1.0f + range_tolerance);
    if (squared > reach * reach) return false;
    const float near = std::sqrt(squared);
    const float far = near + glm::distance(node.box.low, node.box.high);
    const auto falls = [this](float d) { return 1.0f / (d * d + softening_); };
    seen.node = &node;
    seen.light = node.intensity * falls(0.5f * (near + far));
    seen.error = node.second == 0 ? 0.0f : node.intensity * (falls(near) - falls(far));
    return true;
  }

 private:
  LightBox box_;
  float softening_;
};

}  // namespace

LightTree::LightTree(std::span<const shared::Light> lights) : lights_(lights) {
  std::vector<std::uint32_t> numbers;
  double sum = 0.0;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (!is_punctual(lights[i])) continue;
    numbers.push_back(static_cast<std::uint32_t>(i));
    sum += intensity_of(lights[i]);
  }
  if (sum > 0.0) {
    slots_per_intensity_ = static_cast<float>(slots_per_light * numbers.size() / sum);
  }
  nodes_.reserve(2 * numbers.size());
  slots_.reserve(most_slots(numbers.size()));
  add_node(numbers);
}

void LightTree::add_leaf(Node& leaf, std::uint32_t number) {
  const float intensity = intensity_of(lights_[number]);
  const long slots = std::max(std::lround(intensity * slots_per_intensity_), 1l);
  leaf.single = number;
  leaf.first_slot = static_cast<std::uint32_t>(slots_.size());
  leaf.slots = static_cast<std::uint32_t>(slots);
  slots_.insert(slots_.end(), leaf.slots, {number, 1.0f / static_cast<float>(slots), 0, 0});
}

std::size_t LightTree::divide(std::span<std::uint32_t> numbers) const {
  const std::size_t count = numbers.size();
  const auto sort_along = [&](int axis) {
    std::ranges::sort(numbers, [&](std::uint32_t a, std::uint32_t b) {
      const float x = lights_[a].position[axis], y = lights_[b].position[axis];
      return x != y ? x < y : a < b;
    });
  };
  std::vector<float> costs(count);
  float least = std::numeric_limits<float>::infinity();
  int best_axis = 0;
  std::size_t best = count / 2;
  for (int axis = 0; axis < 3; ++axis) {
    sort_along(axis);
    LightBox box{glm::vec3(std::numeric_limits<float>::max()),
                 glm::vec3(std::numeric_limits<float>::lowest())};
    float intensity = 0.0f;
    const auto cost_with = [&](std::uint32_t number) {
      box.low = glm::min(box.low, lights_[number].position);
      box.high = glm::max(box.high, lights_[number].position);
      intensity += intensity_of(lights_[number]);
      const glm::vec3 size = box.high - box.low;
      return intensity * glm::dot(size, size);
    };
    for (std::size_t i = 0; i < count; ++i) costs[i] = cost_with(numbers[i]);
    box = {glm::vec3(std::numeric_limits<float>::max()),
           glm::vec3(std::numeric_limits<float>::lowest())};
    intensity = 0.0f;
    for (std::size_t i = count - 1; i > 0; --i) {
      const float cost = costs[i - 1] + cost_with(numbers[i]);
      if (!(cost < least)) continue;
      least = cost;
      best_axis = axis;
      best = i;
    }
  }
  sort_along(best_axis);
  return best;
}

std::uint32_t LightTree::add_node(std::span<std::uint32_t> numbers) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  Node node;
  node.box = {glm::vec3(std::numeric_limits<float>::max()),
              glm::vec3(std::numeric_limits<float>::lowest())};
  for (const std::uint32_t number : numbers) {
    const shared::Light& light = lights_[number];
    node.box.low = glm::min(node.box.low, light.position);
    node.box.high = glm::max(node.box.high, light.position);
    node.intensity += intensity_of(light);
    const bool ends = light.range > 0.0f;
    node.reach = std::max(node.reach, ends ? light.range : std::numeric_limits<float>::infinity());
  }
  nodes_.push_back(node);
  if (numbers.size() == 1) {
    add_leaf(node, numbers[0]);
  } else {
    const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(divide(numbers));
    node.first_slot = static_cast<std::uint32_t>(slots_.size());
    add_node({numbers.begin(), middle});
    node.second = add_node({middle, numbers.end()});
    node.slots = static_cast<std::uint32_t>(slots_.size()) - node.first_slot;
  }
  nodes_[index] = node;
  return index;
}

std::size_t LightTree::cut(const LightBox& box, float near,
                           std::span<shared::LightEntry, shared::most_light_entries> found) const {
  const LightReceivers receivers(box, near);
  std::array<SeenNode, shared::most_light_entries> seen;
  std::size_t count = receivers.look_at(nodes_[0], seen[0]) ? 1 : 0;
  while (count > 0 && count < seen.size()) {
    float sum = 0.0f, errors = 0.0f;
    std::size_t worst = 0;
    for (std::size_t i = 0; i < count; ++i) {
      sum += seen[i].light;
      errors += seen[i].error * seen[i].error;
      if (seen[i].error > seen[worst].error) worst = i;
    }
    if (!(errors > cut_tolerance * cut_tolerance * sum * sum)) break;
    const LightTree::Node* const parent = seen[worst].node;
    const bool first = receivers.look_at(parent[1], seen[worst]);
    const bool second = receivers.look_at(nodes_[parent->second], seen[first ? count : worst]);
    if (first && second) ++count;
    if (!first && !second) seen[worst] = seen[--count];
  }
  for (std::size_t i = 0; i < count; ++i) {
    const LightTree::Node& node = *seen[i].node;
    found[i] = {node.first_slot, node.slots, node.single, 0};
  }
  return count;
}

}  // namespace heliograph::render
