#pragma once

#include <algorithm>
#include <cstdint>
#include <set>

#include "gpu/frame_plan/pass_order.hpp"

namespace heliograph::gpu {

/// What some passes read and write.
class UsedResources {
 public:
  void add(const PassUses& pass) {
    for (const Use& use : pass.uses) {
      if (reads(use)) read_.insert(use.resource);
      if (writes(use)) written_.insert(use.resource);
    }
  }
  void clear() { *this = {}; }

  /// Whether the pass must wait for them: it uses what they write, or writes what they read.
  bool hold_up(const PassUses& pass) const {
    return std::ranges::any_of(pass.uses, [&](const Use& use) {
      return written_.contains(use.resource) || (writes(use) && read_.contains(use.resource));
    });
  }

 private:
  std::set<std::uint32_t> read_;
  std::set<std::uint32_t> written_;
};

}  // namespace heliograph::gpu
