#pragma once

#include <string>

#include "protocol/messages/messages.hpp"
#include "session/library/loaded_scene.hpp"

namespace heliograph::session {

/// The description of a scene for clients.
protocol::SceneInfo describe_scene(const LoadedScene& loaded);

protocol::Vec3 to_protocol(const glm::vec3& vector);
glm::vec3 from_protocol(const protocol::Vec3& vector);

}  // namespace heliograph::session
