#pragma once

#include <cstdint>
#include <string>

#include "protocol/messages/measurement_messages.hpp"
#include "protocol/result.hpp"
#include "scene/surface/surface_anchor.hpp"

namespace heliograph::session {

/// Of the protocol's form, whose node may have several meshes. `path` names it in errors.
protocol::Result<scene::SurfaceAnchor> to_anchor(const scene::Scene& scene,
                                                 const protocol::SurfaceAnchor& request,
                                                 const std::string& path);
protocol::SurfaceAnchor to_protocol(const scene::Scene& scene, const scene::SurfaceAnchor& anchor);

}  // namespace heliograph::session
