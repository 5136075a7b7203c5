#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "protocol/json/fields.hpp"

// Messages about clips: what moves in a scene, and when.

namespace heliograph::protocol {

struct ClipInfo {
  std::string name;
  float duration = 0.0f;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &ClipInfo::name, "Name for animation.play."),
        field("duration", &ClipInfo::duration, "Length; the clip loops.").unit("seconds"),
    };
  }
  bool operator==(const ClipInfo&) const = default;
};

struct AnimationState {
  std::vector<ClipInfo> clips;
  std::optional<std::string> clip;
  bool playing = false;
  double seconds = 0.0;
  double rate = 1.0;
  bool lockstep = false;
  std::uint32_t rev = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("clips", &AnimationState::clips, "The clips of the scene."),
        field("clip", &AnimationState::clip, "The clip that poses the scene, null at rest.")
            .or_null(),
        field("playing", &AnimationState::playing, "Whether time passes."),
        field("seconds", &AnimationState::seconds, "Where the clip stands.").unit("seconds"),
        field("rate", &AnimationState::rate, "Seconds of the clip that pass in a second."),
        field("lockstep", &AnimationState::lockstep,
              "Whether time passes by frame.step alone, also while playing."),
        field("rev", &AnimationState::rev, "Revision of the session's state."),
    };
  }
  bool operator==(const AnimationState&) const = default;
};

struct AnimationChanged {
  AnimationState animation;
  std::string by;

  static constexpr auto fields() {
    return std::tuple{
        field("animation", &AnimationChanged::animation, "Where the clip stands now, and how."),
        field("by", &AnimationChanged::by, "The viewer that changed it; empty: the server."),
    };
  }
  bool operator==(const AnimationChanged&) const = default;
};

struct AnimationPlay {
  std::optional<std::string> clip;
  std::optional<double> rate;

  static constexpr auto fields() {
    return std::tuple{
        field("clip", &AnimationPlay::clip,
              "The clip to play from its start; left out: go on with the one that is there, or "
              "play the first.")
            .length(1, 256),
        field("rate", &AnimationPlay::rate, "Seconds of the clip that pass in a second.")
            .range(0.01, 100),
    };
  }
  bool operator==(const AnimationPlay&) const = default;
};

struct AnimationSeek {
  double seconds = 0.0;

  static constexpr auto fields() {
    return std::tuple{
        field("seconds", &AnimationSeek::seconds, "Where the clip shall stand.")
            .range(0, 1e6)
            .unit("seconds"),
    };
  }
  bool operator==(const AnimationSeek&) const = default;
};

struct AnimationRate {
  double rate = 1.0;

  static constexpr auto fields() {
    return std::tuple{
        field("rate", &AnimationRate::rate, "Seconds of the clip that pass in a second.")
            .range(0.01, 100),
    };
  }
  bool operator==(const AnimationRate&) const = default;
};

}  // namespace heliograph::protocol
