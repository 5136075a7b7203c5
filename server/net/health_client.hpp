#pragma once

#include <chrono>
#include <string>

namespace heliograph::net {

struct HealthAnswer {
  bool healthy = false;
  std::string text;  // one line for people
};

/// Asks `url` ("http://127.0.0.1:8080/health/ready") and waits at most `patience`.
HealthAnswer ask_health(const std::string& url, std::chrono::milliseconds patience);

}  // namespace heliograph::net
