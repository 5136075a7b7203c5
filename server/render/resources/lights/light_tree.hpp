#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "shaders/shared/light_grid.h"
#include "shaders/shared/scene.h"

namespace heliograph::render {

/// Whether a light is a point or a spot: of those there is a tree.
inline bool is_punctual(const shared::Light& light) {
  return light.type == shared::light_point || light.type == shared::light_spot;
}

/// An axis-aligned box, world space.
struct LightBox {
  glm::vec3 low, high;
};

/// A binary tree of the punctual lights of a scene, whose nodes hold neighbours.
class LightTree {
 public:
  struct Node {
    LightBox box;
    float intensity = 0.0f;  // sum of the lights' luminances
    float reach = 0.0f;      // longest range, metres; infinite if any has none
    std::uint32_t first_slot = 0;
    std::uint32_t slots = 0;
    std::uint32_t single = shared::no_single_light;  // number of a leaf's light
    std::uint32_t second = 0;  // child; the first follows its parent. 0: a leaf
  };

  /// Lights that are not punctual are left out. There must be one that is.
  explicit LightTree(std::span<const shared::Light> lights);

  std::span<const Node> nodes() const { return nodes_; }
  /// In the order of the leaves: as many for each light as its share of all intensity is of
  /// `slots_per_light` for every light, and at least one.
  std::span<const shared::LightSlot> slots() const { return slots_; }

  /// The nodes by which receivers within `box` see the lights: those where lights differ most from
  /// each other as seen from there are replaced by their children. Lights that do not reach the box
  /// are left out. `near`: how near to lights in the box most receivers are, metres.
  /// @return how many of `found`
  std::size_t cut(const LightBox& box, float near,
                  std::span<shared::LightEntry, shared::most_light_entries> found) const;

  static constexpr std::size_t slots_per_light = 8;
  /// The most slots for so many lights, for each is rounded to the nearest.
  static constexpr std::size_t most_slots(std::size_t lights) {
    return (slots_per_light + 2) * lights;
  }

 private:
  std::uint32_t add_node(std::span<std::uint32_t> numbers);
  /// Sorts lights so that those before and from the result on belong together: the least sum of
  /// intensity x squared diagonal (as the heuristic of Conty Estevez and Kulla 2018).
  std::size_t divide(std::span<std::uint32_t> numbers) const;
  void add_leaf(Node& leaf, std::uint32_t number);

  std::span<const shared::Light> lights_;
  float slots_per_intensity_ = 0.0f;
  std::vector<Node> nodes_;
  std::vector<shared::LightSlot> slots_;
};

}  // namespace heliograph::render
