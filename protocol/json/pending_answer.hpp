#pragma once

#include <atomic>
#include <cstddef>
#include <memory>

#include "protocol/result.hpp"

namespace heliograph::protocol {

/// Memory that large parts of answers take while they are made, of all callers together.
struct AnswerMemory {
  explicit AnswerMemory(std::size_t limit_bytes) : limit(limit_bytes) {}

  const std::size_t limit;
  std::atomic<std::size_t> used = 0;
};

/// The answer to one message while it is being made, as the transport sees it: how large it may
/// become, and whether its caller still waits for it. Exists until the answer was handed to the
/// transport. Thread safe.
class PendingAnswer {
 public:
  /// `limit`: bytes of this answer.
  PendingAnswer(std::size_t limit, std::shared_ptr<AnswerMemory> all);
  ~PendingAnswer();
  PendingAnswer(const PendingAnswer&) = delete;
  PendingAnswer& operator=(const PendingAnswer&) = delete;

  /// Takes memory for a large part of the answer, before that part is made. ErrorCode::too_large
  /// where the answer would exceed its limit, ErrorCode::full where those of all callers would.
  Result<void> reserve(std::size_t bytes);

  /// The caller has gone and waits for no answer.
  void abandon() { abandoned_ = true; }
  bool abandoned() const { return abandoned_; }

 private:
  const std::size_t limit_;
  const std::shared_ptr<AnswerMemory> all_;
  std::atomic<std::size_t> reserved_ = 0;
  std::atomic<bool> abandoned_ = false;
};

}  // namespace heliograph::protocol
