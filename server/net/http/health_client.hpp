#pragma once

#include <chrono>
#include <string>

namespace heliograph::net {

struct HealthAnswer {
  bool healthy = false;
  std::string text;  // one line of plain text
};

/// Requests `url` ("http://127.0.0.1:8080/health/ready") and waits at most `timeout`. Over HTTPS
/// the server's certificate must be signed by one in the file `authorities`, or, if it is empty, by
/// one that the system trusts; on loopback addresses it is then not verified.
HealthAnswer ask_health(const std::string& url, const std::string& authorities,
                        std::chrono::milliseconds timeout);

}  // namespace heliograph::net
