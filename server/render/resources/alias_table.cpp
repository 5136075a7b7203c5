#include "render/resources/alias_table.hpp"

namespace heliograph::render {

std::vector<Alias> make_alias_table(std::vector<double> weights) {
  double total = 0.0;
  for (const double weight : weights) total += weight;
  std::vector<Alias> slots;
  slots.reserve(weights.size());
  // Every item below the mean is filled up by one above it.
  std::vector<std::uint32_t> poor, rich;
  for (std::uint32_t i = 0; i < weights.size(); ++i) {
    slots.push_back({1.0f, i});
    weights[i] *= static_cast<double>(weights.size()) / total;
    (weights[i] < 1.0 ? poor : rich).push_back(i);
  }
  while (!poor.empty() && !rich.empty()) {
    const std::uint32_t filled = poor.back(), giver = rich.back();
    poor.pop_back();
    slots[filled] = {static_cast<float>(weights[filled]), giver};
    weights[giver] -= 1.0 - weights[filled];
    if (weights[giver] >= 1.0) continue;
    rich.pop_back();
    poor.push_back(giver);
  }
  return slots;
}

}  // namespace heliograph::render
