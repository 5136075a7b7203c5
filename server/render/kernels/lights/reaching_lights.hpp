#pragma once

#include <span>
#include <vector>

#include "gpu/memory/image.hpp"
#include "render/kernels/common/tile.hpp"
#include "shaders/shared/frame_constants.h"
#include "shaders/shared/scene.h"

namespace heliograph::render::kernels {

/// The lights whose range ends before all surfaces of some pixels do not cost anything there: the
/// others, in their order. Sums over them are the same to the bit.
class ReachingLights {
 public:
  /// `all` outlives this.
  ReachingLights(std::span<const shared::Light> all, const shared::FrameConstants& frame);

  /// Whether any could be left out.
  bool culls() const { return culls_; }
  /// Those that may reach what is seen in `tile`: all, or what is put into `found`. `motion`:
  /// rgba32f, the distance from the eye along -Z in its last channel. Thread safe.
  std::span<const shared::Light> of(const Tile& tile, const gpu::HostView& motion,
                                    std::vector<shared::Light>& found) const;

 private:
  struct Reach {
    glm::vec3 position;
    float squared_range;  // infinite: reaches everything
  };
  struct Box {
    glm::vec3 low, high;
  };
  /// World space, of what lies at these distances.
  Box bounds(const Tile& tile, float nearest, float farthest) const;

  std::span<const shared::Light> all_;
  const shared::FrameConstants& frame_;
  bool culls_;
  std::vector<Reach> reaches_;
};

}  // namespace heliograph::render::kernels
