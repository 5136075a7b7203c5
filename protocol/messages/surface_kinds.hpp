#pragma once

#include "protocol/json/enum_names.hpp"

namespace heliograph::protocol {

/// What of a mesh a point lies on.
HELIOGRAPH_ENUM(SurfaceFeature, vertex, edge, face)

}  // namespace heliograph::protocol
