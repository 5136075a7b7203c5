#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <mutex>
#include <string>

#include "net/security/rate_limit.hpp"

namespace heliograph::net {

/// Rejects clients that fail too often, so that tokens cannot be guessed.
/// Thread safe.
class FailureLimit {
 public:
  using Clock = RateLimit::Clock;

  /// How long `client` is rejected; zero if it is not.
  std::chrono::seconds wait_of(const std::string& client, Clock::time_point now);
  void failed(const std::string& client, Clock::time_point now);

 private:
  void forget_old(Clock::time_point now);

  struct Record {
    double failures = 0.0;  // fades with time
    Clock::time_point at;
  };
  double faded(const Record& record, Clock::time_point now) const;

  std::mutex mutex_;
  std::map<std::string, Record> records_;
};

}  // namespace heliograph::net
