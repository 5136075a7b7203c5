#pragma once

#include "protocol/json/enum_names.hpp"

namespace heliograph::protocol {

/// How pictures are encoded while something moves.
HELIOGRAPH_ENUM(StreamCodec, jpeg, h264)
/// How the final picture of a resting view is encoded.
HELIOGRAPH_ENUM(StillFormat, jpeg, png)
/// What a stream does: it follows changes, shows how a resting picture gets better, or is silent.
HELIOGRAPH_ENUM(StreamPhase, interactive, refining, still)

}  // namespace heliograph::protocol
