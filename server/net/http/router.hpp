#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "net/http/http_message.hpp"
#include "net/http/metrics.hpp"
#include "net/security/access_control.hpp"
#include "protocol/json/mcp_server.hpp"
#include "protocol/json/pending_answer.hpp"
#include "session/library/upload_store.hpp"
#include "session/session_host.hpp"

namespace heliograph::net {

struct RouterOptions {
  std::vector<std::string> frame_ancestors;  // origins whose pages may embed ours, or 'self'
  bool metrics = true;                       // at /metrics
  // Folders of uploaded scenes and environments; empty: uploads are disabled.
  std::filesystem::path uploads;
  std::filesystem::path uploaded_environments;
};

/// Where an upload goes.
struct UploadAddress {
  session::UploadKind kind = session::UploadKind::scene;
  std::string_view name;
};

/// Of an image of a session: "main/frame.jpg" below the address of sessions.
struct ImageAddress {
  std::string_view session;
  std::string_view extension;
};

/// Handles everything over HTTP but the WebSocket: the web client, JSON-RPC, single images, the
/// schema, health and metrics.
class Router {
 public:
  using Reply = std::function<void(HttpResponse)>;

  Router(session::SessionHost& host, const AccessControl& access, const Traffic& traffic,
         const RouterOptions& options);

  using Pending = std::shared_ptr<protocol::PendingAnswer>;

  /// Calls `reply` once, here or on another thread. `pending`: the answer while it is being made.
  void handle(const HttpRequest& request, const Pending& pending, Reply reply) const;
  /// 409 if a file that was not uploaded has this name.
  std::optional<HttpResponse> name_conflict(const UploadAddress& upload) const;
  /// The response on the metrics port: metrics and health, without a token.
  HttpResponse answer_metrics_listener(const HttpRequest& request) const;
  /// Security headers of every response: content security policy and the like.
  const Headers& headers() const { return headers_; }
  /// Reports from now on that the server is not ready.
  void drain() { draining_ = true; }

 private:
  std::optional<HttpResponse> module_for_embedder(const HttpRequest& request) const;
  HttpResponse answer_get(const HttpRequest& request) const;
  std::optional<HttpResponse> health(const HttpRequest& request) const;
  HttpResponse metrics() const;
  void call(const HttpRequest& request, Role role, const Pending& pending, Reply reply) const;
  void call_tool(const HttpRequest& request, Role role, const Pending& pending, Reply reply) const;
  void environment_thumbnail(std::string_view file, Reply reply) const;
  HttpResponse scene_thumbnail(std::string_view scene) const;
  void exported_scene(const HttpRequest& request, std::string_view session, Role role,
                      const Pending& pending, Reply reply) const;
  void image(const HttpRequest& request, const ImageAddress& address, Role role,
             const Pending& pending, Reply reply) const;

  session::SessionHost& host_;
  const AccessControl& access_;
  const Traffic& traffic_;
  const RouterOptions options_;
  const Headers headers_;
  const protocol::McpServer mcp_;
  const std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
  std::atomic<bool> draining_ = false;
};

/// Of "/api/v1/scenes/NAME" and the same of environments and images, where uploads go.
std::optional<UploadAddress> upload_address(std::string_view path);
HttpResponse error_response(const protocol::Error& error);
/// The response while the server shuts down: come back in a while.
HttpResponse retry_later(std::string_view why);

}  // namespace heliograph::net
