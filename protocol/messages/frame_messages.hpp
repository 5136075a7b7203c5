#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "protocol/json/fields.hpp"
#include "protocol/limits.hpp"
#include "protocol/settings/settings.hpp"

// Messages about frames rendered on request: lockstep stepping and the path traced reference.

namespace heliograph::protocol {

struct FrameStep {
  std::uint32_t frames = 1;
  double dt = 0.0;

  static constexpr auto fields() {
    return std::tuple{
        field("frames", &FrameStep::frames,
              "Number of frames to render; 0 enters lockstep without rendering.")
            .range(0, 100000)
            .or_default(),
        field("dt", &FrameStep::dt, "Time step before each frame.").range(0, 10).unit("seconds"),
    };
  }
  bool operator==(const FrameStep&) const = default;
};

struct StepState {
  bool lockstep = false;
  double seconds = 0.0;
  std::uint64_t frames = 0;
  std::uint32_t samples = 0;
  std::uint32_t rev = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("lockstep", &StepState::lockstep, "Whether time advances by frame.step only."),
        field("seconds", &StepState::seconds, "Time since lockstep was entered.").unit("seconds"),
        field("frames", &StepState::frames, "Frames rendered since lockstep was entered."),
        field("samples", &StepState::samples, "Samples per pixel accumulated in the newest frame."),
        field("rev", &StepState::rev, "Revision of the session's state."),
    };
  }
  bool operator==(const StepState&) const = default;
};

struct LockstepChanged {
  StepState state;
  std::string by;

  static constexpr auto fields() {
    return std::tuple{
        field("state", &LockstepChanged::state, "The state that frame.step would return now."),
        field("by", &LockstepChanged::by,
              "The viewer that entered or left lockstep; empty: the server."),
    };
  }
  bool operator==(const LockstepChanged&) const = default;
};

struct ReferenceStart {
  ReferenceScope scope = ReferenceScope::same_paths;
  std::optional<std::uint32_t> samples;

  static constexpr auto fields() {
    return std::tuple{
        field("scope", &ReferenceStart::scope, "Light paths to trace: sets reference.scope.")
            .or_default(),
        field("samples", &ReferenceStart::samples,
              "Samples per pixel to accumulate: sets accumulation.max_samples.")
            .range(1, max_samples_per_pixel),
    };
  }
  bool operator==(const ReferenceStart&) const = default;
};

struct ReferenceState {
  bool shown = false;
  ReferenceScope scope = ReferenceScope::same_paths;
  std::uint32_t samples = 0;
  std::uint32_t target_samples = 0;
  bool finished = false;
  std::uint32_t rev = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("shown", &ReferenceState::shown,
              "Whether the reference image is shown: the setting reference.use is always."),
        field("scope", &ReferenceState::scope, "Light paths that are traced."),
        field("samples", &ReferenceState::samples, "Samples per pixel accumulated so far."),
        field("target_samples", &ReferenceState::target_samples,
              "Samples per pixel of the finished image."),
        field("finished", &ReferenceState::finished, "Whether the target is reached."),
        field("rev", &ReferenceState::rev, "Revision of the session's state."),
    };
  }
  bool operator==(const ReferenceState&) const = default;
};

}  // namespace heliograph::protocol
