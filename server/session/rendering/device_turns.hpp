#pragma once

#include <optional>
#include <vector>

#include "session/rendering/fair_share.hpp"

namespace heliograph::session {

/// The order in which views use a device. Views whose image moves get equal parts of its time.
/// Those that refine a static image share one such part: users who have stopped looking around
/// would otherwise, each with seconds of samples to go, slow down one who has not. While no image
/// moves they get everything. Not thread safe.
class DeviceTurns {
 public:
  /// A view that may have work.
  struct Contender {
    FairShare::Key view = nullptr;
    bool refines = false;
    bool operator==(const Contender&) const = default;
  };

  void sort(std::vector<Contender>& contenders) const;
  /// As FairShare::hold_back.
  std::optional<Clock::time_point> hold_back(const Contender& contender, Clock::time_point now);
  void charge(const Contender& contender, Clock::time_point begin, Clock::time_point end);
  void remove(FairShare::Key view);

 private:
  FairShare::Key all_refining() const { return &among_refining_; }

  FairShare shares_;  // of each view that moves, and of all that refine
  FairShare among_refining_;
};

}  // namespace heliograph::session
