#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>

#include "protocol/result.hpp"

namespace heliograph::session {

/// The number of pixels that the frames of all sessions may have together. Thread safe.
class PixelBudget {
 public:
  explicit PixelBudget(std::uint64_t limit) : limit_(limit) {}

  /// Takes `requested` pixels in place of the `held` ones; ErrorCode::full if there are too few.
  protocol::Result<void> exchange(std::uint64_t held, std::uint64_t requested);
  std::uint64_t used() const;
  std::uint64_t limit() const { return limit_; }

 private:
  const std::uint64_t limit_;
  mutable std::mutex mutex_;
  std::uint64_t used_ = 0;
};

/// One session's part of a budget, released by the destructor. Without a budget any size fits.
class PixelShare {
 public:
  PixelShare() = default;
  explicit PixelShare(std::shared_ptr<PixelBudget> budget) : budget_(std::move(budget)) {}
  PixelShare(PixelShare&& other) noexcept
      : budget_(std::move(other.budget_)), held_(std::exchange(other.held_, 0)) {}
  PixelShare& operator=(PixelShare&&) = delete;
  ~PixelShare() { release(); }

  protocol::Result<void> resize(std::uint64_t pixels);
  /// Releases all pixels; from now on there is no budget.
  void release();

 private:
  std::shared_ptr<PixelBudget> budget_;
  std::uint64_t held_ = 0;
};

}  // namespace heliograph::session
