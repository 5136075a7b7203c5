#include "net/http/health_client.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "net/http/http_client.hpp"

namespace heliograph::net {
namespace {

/// An address without a path asks for readiness.
std::string health_address(const std::string& url) {
  const std::size_t scheme = url.find("://");
  if (scheme == std::string::npos) return url;
  const std::size_t slash = url.find('/', scheme + 3);
  const bool has_path = slash != std::string::npos && slash + 1 < url.size();
  return has_path ? url : url.substr(0, slash) + "/health/ready";
}

}  // namespace

HealthAnswer ask_health(const std::string& url, const std::string& authorities,
                        std::chrono::milliseconds timeout) {
  const ClientAnswer answer =
      ask_server({.url = health_address(url), .authorities = authorities, .timeout = timeout});
  if (answer.status == 0) return {.healthy = false, .text = answer.error};
  const std::string line = answer.body.substr(0, answer.body.find('\n'));
  return {.healthy = answer.status == 200, .text = fmt::format("{} {}", answer.status, line)};
}

}  // namespace heliograph::net
