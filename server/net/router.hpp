#pragma once

#include <atomic>
#include <chrono>
#include <functional>

#include "net/access_control.hpp"
#include "net/http_message.hpp"
#include "session/session_host.hpp"

namespace heliograph::net {

/// Answers everything over HTTP but the WebSocket: the web client, JSON-RPC, single pictures, the
/// schema, health and metrics.
class Router {
 public:
  using Reply = std::function<void(HttpResponse)>;

  Router(session::SessionHost& host, const AccessControl& access);

  /// Calls `reply` once, here or on another thread.
  void handle(const HttpRequest& request, Reply reply) const;
  /// From now on the server is not ready for new work.
  void drain() { draining_ = true; }

 private:
  HttpResponse answer_get(const HttpRequest& request) const;
  HttpResponse health(bool ready) const;
  void call(const HttpRequest& request, Reply reply) const;
  void picture(const HttpRequest& request, std::string_view session, std::string_view extension,
               Reply reply) const;

  session::SessionHost& host_;
  const AccessControl& access_;
  const std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
  std::atomic<bool> draining_ = false;
};

/// Every response's protection against misuse of the page: content security policy and the like.
const std::vector<std::pair<std::string, std::string>>& security_headers();

}  // namespace heliograph::net
