#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "protocol/json/fields.hpp"
#include "protocol/settings/settings.hpp"

// Messages about frames that are rendered on request: in lockstep, and the path traced reference.

namespace heliograph::protocol {

struct FrameStep {
  std::uint32_t frames = 1;
  double dt = 0.0;

  static constexpr auto fields() {
    return std::tuple{
        field("frames", &FrameStep::frames,
              "How many frames to render; 0 enters lockstep and renders none.")
            .range(0, 100000)
            .or_default(),
        field("dt", &FrameStep::dt, "How much time passes before each of them.")
            .range(0, 10)
            .unit("seconds"),
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
        field("lockstep", &StepState::lockstep, "Whether time passes by frame.step alone."),
        field("seconds", &StepState::seconds, "Time that passed since lockstep was entered.")
            .unit("seconds"),
        field("frames", &StepState::frames, "Frames rendered since lockstep was entered."),
        field("samples", &StepState::samples, "Samples accumulated in the newest of them."),
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
        field("state", &LockstepChanged::state, "What frame.step would answer now."),
        field("by", &LockstepChanged::by,
              "The viewer that began or ended lockstep; empty: the server."),
    };
  }
  bool operator==(const LockstepChanged&) const = default;
};

struct ReferenceStart {
  ReferenceScope scope = ReferenceScope::same_paths;
  std::optional<std::uint32_t> samples;

  static constexpr auto fields() {
    return std::tuple{
        field("scope", &ReferenceStart::scope, "Which light paths: the setting reference.scope.")
            .or_default(),
        field("samples", &ReferenceStart::samples,
              "Samples per pixel to gather: the setting accumulation.max_samples.")
            .range(1, 65536),
    };
  }
  bool operator==(const ReferenceStart&) const = default;
};

struct ReferenceState {
  bool shown = false;
  ReferenceScope scope = ReferenceScope::same_paths;
  std::uint32_t samples = 0;
  std::uint32_t wanted = 0;
  bool finished = false;
  std::uint32_t rev = 0;

  static constexpr auto fields() {
    return std::tuple{
        field("shown", &ReferenceState::shown,
              "Whether the path traced truth is shown: the setting reference.use is always."),
        field("scope", &ReferenceState::scope, "Which light paths it follows."),
        field("samples", &ReferenceState::samples, "Samples gathered in each pixel so far."),
        field("wanted", &ReferenceState::wanted, "Samples that it will have at the end."),
        field("finished", &ReferenceState::finished, "Whether it has them."),
        field("rev", &ReferenceState::rev, "Revision of the session's state."),
    };
  }
  bool operator==(const ReferenceState&) const = default;
};

}  // namespace heliograph::protocol
