#pragma once

#include <memory>

#include "gpu/memory/image.hpp"
#include "protocol/settings/settings.hpp"
#include "scene/environment.hpp"

namespace heliograph::render {

/// Whether the environment is seen behind the scene, blurred or not, so that its intensity counts.
inline bool shows_environment(const protocol::Settings::Background& chosen) {
  return chosen.show == protocol::BackgroundKind::environment ||
         chosen.show == protocol::BackgroundKind::blurred;
}

/// The map of another background than the environment as it is. The sun of `environment` is no part
/// of a blurred one: it would light half of it.
scene::Environment background_map(const scene::Environment& environment,
                                  const protocol::Settings::Background& chosen);

/// What is seen behind the scene in place of the environment.
struct Background {
  Background(const gpu::Device& device, scene::Environment made);

  scene::Environment map;  // for host kernels
  gpu::Image image;
};

}  // namespace heliograph::render
