#include "session/rendering/pixel_budget.hpp"

#include <string>
#include <utility>

namespace heliograph::session {

protocol::Result<void> PixelBudget::exchange(std::uint64_t held, std::uint64_t requested) {
  const std::lock_guard lock(mutex_);
  const std::uint64_t others = used_ - held;
  // A session may always shrink, even where the others exceed the limit already.
  if (requested > held && others + requested > limit_) {
    return protocol::error::full(
        "the frames of all sessions have too many pixels",
        std::to_string(limit_) + " pixels, " + std::to_string(others) + " used by other sessions");
  }
  used_ = others + requested;
  return {};
}

std::uint64_t PixelBudget::used() const {
  const std::lock_guard lock(mutex_);
  return used_;
}

void PixelShare::release() {
  // A release is never refused.
  if (budget_) (void)budget_->exchange(held_, 0);
  budget_.reset();
  held_ = 0;
}

protocol::Result<void> PixelShare::resize(std::uint64_t pixels) {
  if (budget_) {
    if (auto taken = budget_->exchange(held_, pixels); !taken) return taken;
  }
  held_ = pixels;
  return {};
}

}  // namespace heliograph::session
