#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "protocol/json/fields.hpp"
#include "protocol/limits.hpp"

// Messages about animation clips and their playback.

namespace heliograph::protocol {

struct ClipInfo {
  std::string name;
  float duration = 0.0f;

  static constexpr auto fields() {
    return std::tuple{
        field("name", &ClipInfo::name, "Name for animation.play."),
        field("duration", &ClipInfo::duration, "Duration; the clip loops.").unit("seconds"),
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
        field("clip", &AnimationState::clip,
              "The clip that poses the scene; null: the default pose.")
            .or_null(),
        field("playing", &AnimationState::playing, "Whether the clip is playing."),
        field("seconds", &AnimationState::seconds, "Time in the clip.").unit("seconds"),
        field("rate", &AnimationState::rate, "Playback speed: clip seconds per second."),
        field("lockstep", &AnimationState::lockstep,
              "Whether time advances by frame.step only, also while playing."),
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
        field("animation", &AnimationChanged::animation, "The new state of playback."),
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
              "The clip to play from its start; absent: continue the current clip, or play the "
              "first.")
            .length(1, max_node_name),
        field("rate", &AnimationPlay::rate, "Playback speed: clip seconds per second.")
            .range(0.01, 100),
    };
  }
  bool operator==(const AnimationPlay&) const = default;
};

struct AnimationSeek {
  double seconds = 0.0;

  static constexpr auto fields() {
    return std::tuple{
        field("seconds", &AnimationSeek::seconds, "Time in the clip to seek to.")
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
        field("rate", &AnimationRate::rate, "Playback speed: clip seconds per second.")
            .range(0.01, 100),
    };
  }
  bool operator==(const AnimationRate&) const = default;
};

}  // namespace heliograph::protocol
