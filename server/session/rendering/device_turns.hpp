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

  /// A frame that the device works on.
  struct Frame {
    Clock::time_point begun{};
    FairShare::Duration used_before{};  // DeviceTurns::used_
  };
  /// Frames that have begun and are not over share the time of the device in equal parts. Charged
  /// from one end to the next, the first to end of many would pay for all, and its view starve.
  Frame begin(Clock::time_point now);
  void finish(const Contender& contender, const Frame& frame, Clock::time_point now);
  /// Ends a frame without charging a view.
  void drop(Clock::time_point now);
  void remove(FairShare::Key view);

 private:
  FairShare::Key all_starting() const { return &among_starting_; }
  FairShare::Key all_refining() const { return &among_refining_; }
  FairShare::Key in_shares(const Contender& contender) const;
  void pass_time(Clock::time_point now);
  void charge(const Contender& contender, Clock::time_point begin, Clock::time_point end,
              FairShare::Duration used);

  FairShare shares_;  // of each view that moves, of all that start, and of all that refine
  FairShare among_starting_;
  FairShare among_refining_;
  FairShare::Duration moving_frame_{0};  // how long one takes, smoothed; zero: there was none
  int frames_ = 0;                       // that have begun and are not over
  FairShare::Duration used_{0};  // what a frame that has been there all the time would be charged
  Clock::time_point used_until_{};  // when that was
};

}  // namespace heliograph::session
