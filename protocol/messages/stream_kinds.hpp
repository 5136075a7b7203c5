#pragma once

#include "protocol/json/enum_names.hpp"

namespace heliograph::protocol {

/// Codec of the frames of a changing view.
HELIOGRAPH_ENUM(StreamCodec, jpeg, h264)
/// Format of the final image of a static view.
HELIOGRAPH_ENUM(StillFormat, jpeg, png)
/// State of a stream: it follows changes, refines a static view, or sends nothing.
HELIOGRAPH_ENUM(StreamPhase, interactive, refining, idle)

}  // namespace heliograph::protocol
