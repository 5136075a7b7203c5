#include "net/security/failure_limit.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace heliograph::net {
namespace {

constexpr double most_failures = 20.0;
constexpr double forgiven_per_second = 0.5;
constexpr std::size_t most_records = 4096;

}  // namespace

std::chrono::seconds FailureLimit::wait_of(const std::string& client, Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  const auto found = records_.find(client);
  if (found == records_.end()) return std::chrono::seconds(0);
  const double excess = faded(found->second, now) - (most_failures - 1.0);
  if (excess <= 0.0) return std::chrono::seconds(0);
  return std::chrono::seconds(static_cast<int>(std::ceil(excess / forgiven_per_second)));
}

void FailureLimit::failed(const std::string& client, Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  forget_old(now);
  Record& record = records_[client];
  record.failures = std::min(most_failures, faded(record, now) + 1.0);
  record.at = now;
}

/// Bounds the number of entries: expired ones are removed first, then any.
void FailureLimit::forget_old(Clock::time_point now) {
  if (records_.size() < most_records) return;
  std::erase_if(records_, [&](const auto& entry) { return faded(entry.second, now) < 1.0; });
  if (records_.size() >= most_records) {
    records_.erase(records_.begin(), std::next(records_.begin(), most_records / 2));
  }
}

double FailureLimit::faded(const Record& record, Clock::time_point now) const {
  const std::chrono::duration<double> elapsed = now - record.at;
  return std::max(0.0, record.failures - forgiven_per_second * elapsed.count());
}

}  // namespace heliograph::net
