#pragma once

#include <cstdint>
#include <optional>

#include "protocol/messages/messages.hpp"
#include "protocol/settings/settings.hpp"

namespace heliograph::session {

/// The path traced reference of a session, which reference.start and reference.stop switch by
/// patches of the settings. Not thread safe.
class ReferenceMode {
 public:
  /// The settings patch of reference.start.
  static protocol::RawJson start_patch(const protocol::ReferenceStart& request);
  /// It was applied; `before` are the settings without it.
  void start(const protocol::Settings& before);
  /// The settings patch of reference.stop: what start changed, as it was.
  protocol::RawJson stop_patch() const;
  /// Ends where the settings show no reference any more.
  void settings_changed(const protocol::Settings& settings);

  /// Whether it was started and has not ended: it is rendered with or without viewers.
  bool started() const { return started_; }
  /// The newest frame: the version of the state that it shows, and its samples.
  void report_frame(std::uint64_t version, std::uint32_t samples, bool converged);
  protocol::ReferenceState state(const protocol::Settings& settings, std::uint64_t version,
                                 std::uint32_t rev) const;
  /// Takes over what stop has to restore.
  void copy_from(const ReferenceMode& other);

 private:
  struct Restored {
    protocol::Settings::Reference reference;
    protocol::Settings::Accumulation accumulation;
  };
  struct FrameReport {
    std::uint64_t version = 0;
    std::uint32_t samples = 0;
    bool converged = false;
  };

  std::optional<Restored> restored_;  // by stop; nothing where it was not started
  bool started_ = false;
  FrameReport newest_frame_;
};

}  // namespace heliograph::session
