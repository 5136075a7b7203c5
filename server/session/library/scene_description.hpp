#pragma once

#include <string>

#include "protocol/messages/messages.hpp"
#include "session/library/loaded_scene.hpp"

namespace heliograph::session {

/// What clients are told about a scene that is called `name` in the catalogue.
protocol::SceneInfo describe_scene(const LoadedScene& loaded);

protocol::Vec3 to_protocol(const glm::vec3& vector);
glm::vec3 from_protocol(const protocol::Vec3& vector);

}  // namespace heliograph::session
