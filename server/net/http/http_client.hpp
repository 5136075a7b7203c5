#pragma once

#include <chrono>
#include <string>

#include "net/http/http_message.hpp"

namespace heliograph::net {

struct ClientRequest {
  std::string url;
  std::string method = "GET";
  std::string body;
  Headers headers;
  /// Over HTTPS the server's certificate must be signed by one in this file, or, if it is empty, by
  /// one that the system trusts; on loopback addresses it is then not verified.
  std::string authorities;
  std::chrono::milliseconds timeout{5000};  // of everything after the name's resolution
};

struct ClientAnswer {
  int status = 0;  // 0: none came
  std::string body;
  std::string error;
};

/// Sends one request and waits for its answer. Redirections are not followed.
ClientAnswer ask_server(const ClientRequest& request);

}  // namespace heliograph::net
