#pragma once

#include <optional>
#include <vector>

#include "session/rendering/fair_share.hpp"

namespace heliograph::session {

/// What the next frame of a view is.
enum class TurnKind {
  moving,    // of an image that moves
  starting,  // the first one of its passes and images, which may take many times as long
  refining   // adds samples to a static image
};

/// The order in which views use a device. Views whose image moves get equal parts of its time.
/// Those that refine a static image share one such part: users who have stopped looking around
/// would otherwise, each with seconds of samples to go, slow down one who has not. While no image
/// moves they get everything. Of those that start, one at a time has a turn, as often as a view
/// that moves: however many sessions are opened at once, another one waits for one first frame, not
/// for all of them. Not thread safe.
class DeviceTurns {
 public:
  /// A view that may have work.
  struct Contender {
    FairShare::Key view = nullptr;
    TurnKind kind = TurnKind::moving;
    bool operator==(const Contender&) const = default;
  };

  void sort(std::vector<Contender>& contenders) const;
  /// As FairShare::hold_back.
  std::optional<Clock::time_point> hold_back(const Contender& contender, Clock::time_point now);
  void charge(const Contender& contender, Clock::time_point begin, Clock::time_point end);
  void remove(FairShare::Key view);

 private:
  FairShare::Key all_starting() const { return &among_starting_; }
  FairShare::Key all_refining() const { return &among_refining_; }
  FairShare::Key in_shares(const Contender& contender) const;

  FairShare shares_;  // of each view that moves, of all that start, and of all that refine
  FairShare among_starting_;
  FairShare among_refining_;
  FairShare::Duration moving_frame_{0};  // how long one takes, smoothed; zero: there was none
};

}  // namespace heliograph::session
