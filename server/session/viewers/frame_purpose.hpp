#pragma once

namespace heliograph::session {

/// Why a frame is sent: to follow changes, to show how a static image converges, or as the last one
/// of a static image, in the best quality.
enum class FramePurpose { interactive, refining, final };

}  // namespace heliograph::session
