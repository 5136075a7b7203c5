#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "scene/scene.hpp"
#include "tracing/alpha_mask.hpp"
#include "tracing/embree.hpp"

namespace heliograph::tracing {

/// A scene in Embree's hands: one Embree scene per mesh, and one of instances whose geometry
/// numbers are indices among the scene's instances.
class EmbreeScene {
 public:
  /// Keeps no reference to `scene`; `alpha_heap` is the scene's and must stay alive.
  /// @throws std::runtime_error when Embree fails
  EmbreeScene(RTCDevice device, const scene::Scene& scene,
              std::span<const std::uint8_t> alpha_heap);

  RTCScene handle() const { return top_.get(); }

 private:
  struct Mask {
    AlphaMask mask;
    std::span<const std::uint8_t> heap;
  };

  static void let_through(const RTCFilterFunctionNArguments* arguments);
  void add_mesh(RTCDevice device, const scene::Scene& scene, std::size_t index,
                std::span<const std::uint8_t> alpha_heap);
  void place(RTCDevice device, const scene::Scene& scene, std::size_t instance);

  std::vector<std::unique_ptr<const Mask>> masks_;  // by mesh, null where rays pass nowhere
  std::vector<EmbreeHandle<RTCScene>> meshes_;      // null where rays meet nothing
  EmbreeHandle<RTCScene> top_;
};

}  // namespace heliograph::tracing
