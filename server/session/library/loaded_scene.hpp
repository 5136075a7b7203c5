#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "scene/scene.hpp"

namespace heliograph::render {
class SceneResources;
}

namespace heliograph::session {

/// A scene that is ready to be shown.
struct LoadedScene {
  std::string name;
  std::shared_ptr<const scene::Scene> scene;
  std::shared_ptr<const render::SceneResources> resources;
  std::string environment = {};    // name of its file; empty: none
  std::uint64_t host_bytes = 0;    // memory of `scene`
  std::uint64_t device_bytes = 0;  // memory of `resources`, acceleration structure included
};

}  // namespace heliograph::session
