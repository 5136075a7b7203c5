#include "net/http/router.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <utility>

#include "net/download/scene_download.hpp"
#include "net/http/image_request.hpp"
#include "net/http/job_routes.hpp"
#include "net/http/token_page.hpp"
#include "protocol/settings/settings_json.hpp"
#include "web_client/embedded_assets.hpp"

namespace heliograph::net {
namespace {

constexpr std::string_view sessions_prefix = "/api/v1/sessions/";
constexpr std::string_view scenes_prefix = "/api/v1/scenes/";
constexpr std::string_view environments_prefix = "/api/v1/environments/";
constexpr std::string_view images_prefix = "/api/v1/images/";
constexpr std::string_view exported_suffix = "/scene.glb";
constexpr std::string_view environment_suffix = "/thumbnail.png";
constexpr std::string_view scene_suffix = "/thumbnail.jpg";
constexpr std::string_view viewer_module = "/heliograph-viewer.js";

HttpResponse with_header(HttpResponse response, std::string name, std::string value) {
  response.headers.emplace_back(std::move(name), std::move(value));
  return response;
}

/// The query of a request with its '?', less one parameter; empty where nothing is left.
std::string query_without(const HttpRequest& request, std::string_view name) {
  std::string query;
  for (const auto& [key, value] : request.query) {
    if (key == name) continue;
    query += (query.empty() ? '?' : '&') + encode_query(key) + '=' + encode_query(value);
  }
  return query;
}

HttpResponse method_not_allowed(std::string allowed) {
  return with_header(text_response(405, "This address accepts only " + allowed + "."), "Allow",
                     allowed);
}

std::optional<HttpResponse> asset(const HttpRequest& request) {
  // Pages of their own have the names of their addresses.
  const bool page = is_page(request.path) && request.path != "/";
  const web::Asset* file = web::find_asset(page ? request.path + ".html" : request.path);
  if (!file) return std::nullopt;
  HttpResponse response;
  for (const std::string_view tag : header_elements(request.header("if-none-match"))) {
    if (tag == file->etag || tag == "*") response.status = 304;
  }
  response.content_type = file->content_type;
  if (response.status == 200) response.body.assign(file->bytes.begin(), file->bytes.end());
  response.headers.emplace_back("ETag", file->etag);
  response.headers.emplace_back("Cache-Control", "no-cache");
  return response;
}

HttpResponse schema() {
  const nlohmann::json document{{"openrpc", protocol::openrpc_document().value()},
                                {"settings", protocol::settings_schema()}};
  return json_response(document.dump());
}

/// "main/frame.jpg" -> main, jpg
std::optional<ImageAddress> image_address(std::string_view path) {
  if (!path.starts_with(sessions_prefix)) return std::nullopt;
  path.remove_prefix(sessions_prefix.size());
  constexpr std::string_view file = "/frame.";
  const std::size_t split = path.find(file);
  if (split == std::string_view::npos) return std::nullopt;
  return ImageAddress{path.substr(0, split), path.substr(split + file.size())};
}

/// "/api/v1/environments/sky/thumbnail.png" -> sky
std::optional<std::string_view> between(std::string_view prefix, std::string_view path,
                                        std::string_view suffix) {
  if (!path.starts_with(prefix) || !path.ends_with(suffix)) return {};
  path.remove_prefix(prefix.size());
  if (path.size() <= suffix.size()) return {};
  return path.substr(0, path.size() - suffix.size());
}

/// The value of frame-ancestors. @throws std::invalid_argument
std::string frame_ancestors(const std::vector<std::string>& allowed) {
  if (allowed.empty()) return "'none'";
  std::string value;
  for (const std::string& ancestor : allowed) {
    if (ancestor != "self" &&
        (!is_origin(ancestor) || ancestor.find_first_of(";,'\" ") != std::string::npos)) {
      throw std::invalid_argument("\"" + ancestor +
                                  "\" cannot embed pages: it is neither \"self\" nor an origin "
                                  "such as https://example.org");
    }
    value += (value.empty() ? "" : " ") + (ancestor == "self" ? "'self'" : ancestor);
  }
  return value;
}

protocol::CallContext call_context(const HttpRequest& request, Role role,
                                   const Router::Pending& pending) {
  return {.viewer = {},
          .session = session_of(request),
          .view_only = role == Role::view,
          .answer = pending};
}

Headers protecting_headers(const RouterOptions& options) {
  return {
      {"Content-Security-Policy",
       "default-src 'self'; img-src 'self' blob: data:; worker-src 'self' blob:; "
       "connect-src 'self' ws: wss:; object-src 'none'; base-uri 'none'; form-action 'none'; "
       "frame-ancestors " +
           frame_ancestors(options.frame_ancestors)},
      {"X-Content-Type-Options", "nosniff"},
      {"Referrer-Policy", "no-referrer"},
      {"Cross-Origin-Resource-Policy", "same-origin"},
      {"Cross-Origin-Opener-Policy", "same-origin"},
  };
}

}  // namespace

HttpResponse error_response(const protocol::Error& error) {
  using protocol::ErrorCode;
  switch (error.code) {
    case ErrorCode::not_found:
      return text_response(404, error.message);
    case ErrorCode::invalid_params:
      return text_response(400, error.message);
    case ErrorCode::conflict:
      return text_response(409, error.message);
    case ErrorCode::too_large:
      return text_response(413, error.message);
    case ErrorCode::full:
    case ErrorCode::not_ready:
      return text_response(503, error.message);
    default:
      return text_response(500, error.message);
  }
}

std::optional<UploadAddress> upload_address(std::string_view path) {
  for (const auto& [prefix, kind] :
       {std::pair(scenes_prefix, session::UploadKind::scene),
        std::pair(environments_prefix, session::UploadKind::environment),
        std::pair(images_prefix, session::UploadKind::image)}) {
    if (path.starts_with(prefix) && path.size() > prefix.size()) {
      return UploadAddress{kind, path.substr(prefix.size())};
    }
  }
  return std::nullopt;
}

HttpResponse retry_later(std::string_view why) {
  return with_header(text_response(503, why), "Retry-After", "1");
}

Router::Router(session::SessionHost& host, const AccessControl& access, const Traffic& traffic,
               const RouterOptions& options)
    : host_(host),
      access_(access),
      traffic_(traffic),
      options_(options),
      headers_(protecting_headers(options)),
      mcp_(host.dispatcher(), HELIOGRAPH_VERSION) {}

/// The module that shows our page in one of another origin: code that is no secret, for origins
/// that may embed the page. It comes with an Origin header and without a cookie.
std::optional<HttpResponse> Router::module_for_embedder(const HttpRequest& request) const {
  if (request.path != viewer_module || request.method != "GET") return std::nullopt;
  const std::string origin(request.header("origin"));
  if (std::ranges::find(options_.frame_ancestors, origin) == options_.frame_ancestors.end()) {
    return std::nullopt;
  }
  std::optional<HttpResponse> response = asset(request);
  const Headers cors = access_.cors_headers(request);  // are added to every response
  const bool listed = std::ranges::find(cors, "Access-Control-Allow-Origin",
                                        &Headers::value_type::first) != cors.end();
  if (response && !listed) {
    response->headers.emplace_back("Access-Control-Allow-Origin", origin);
    if (cors.empty()) response->headers.emplace_back("Vary", "Origin");
  }
  return response;
}

void Router::handle(const HttpRequest& request, const Pending& pending, Reply reply) const {
  if (auto module = module_for_embedder(request)) return reply(*std::move(module));
  const bool health_check = request.path.starts_with("/health/");
  const std::optional<std::string> token =
      is_page(request.path) ? request.parameter("token") : std::nullopt;
  Admission admission =
      token ? access_.admit_by(*token, request) : access_.admit(request, !health_check);
  if (admission.refusal) {
    const int status = admission.refusal->status;
    const bool for_token = status == 401 || status == 429;
    return reply(for_token && asks_for_page(request)
                     ? token_page(request, *std::move(admission.refusal))
                     : *std::move(admission.refusal));
  }
  if (token) {
    HttpResponse redirect = text_response(303, "Continue without the token in the address.");
    redirect.headers = {{"Location", request.path + query_without(request, "token")},
                        {"Set-Cookie", access_.token_cookie(*token, request)}};
    return reply(std::move(redirect));
  }
  if (draining_ && !health_check) return reply(retry_later("The server is shutting down."));
  if (request.path == "/rpc") {
    if (request.method != "POST") return reply(method_not_allowed("POST"));
    return call(request, admission.role, pending, std::move(reply));
  }
  if (request.path == "/mcp") {
    if (request.method != "POST") return reply(method_not_allowed("POST"));
    return call_tool(request, admission.role, pending, std::move(reply));
  }
  if (is_job_path(request.path)) {
    return reply(answer_job(request, host_.jobs(), admission.role));
  }
  const bool reads = request.method == "GET" || request.method == "HEAD";
  const auto environment = between(environments_prefix, request.path, environment_suffix);
  if (environment && reads) return environment_thumbnail(*environment, std::move(reply));
  const auto scene = between(scenes_prefix, request.path, scene_suffix);
  if (scene && reads) return reply(scene_thumbnail(*scene));
  if (!options_.uploads.empty() && upload_address(request.path)) {
    return reply(method_not_allowed("PUT, DELETE"));
  }
  if (!reads) return reply(method_not_allowed("GET"));
  if (const auto session = between(sessions_prefix, request.path, exported_suffix)) {
    if (request.method != "GET") return reply(method_not_allowed("GET"));
    return exported_scene(request, *session, admission.role, pending, std::move(reply));
  }
  if (const auto address = image_address(request.path)) {
    return image(request, *address, admission.role, pending, std::move(reply));
  }
  reply(answer_get(request));
}

std::optional<HttpResponse> Router::name_conflict(const UploadAddress& upload) const {
  if (upload.kind == session::UploadKind::image) return std::nullopt;  // all were uploaded
  const std::string name(upload.name);
  const bool scene = upload.kind == session::UploadKind::scene;
  const auto found =
      scene ? host_.catalogue().find_in_root(name) : host_.environments().find_in_root(name);
  const auto& uploads = scene ? options_.uploads : options_.uploaded_environments;
  if (!found || found->root == uploads) return std::nullopt;
  return text_response(
      409, scene ? "Another scene has this name." : "Another environment has this name.");
}

void Router::environment_thumbnail(std::string_view file, Reply reply) const {
  host_.environments().thumbnail(std::string(file),
                                 [reply](protocol::Result<std::vector<std::uint8_t>> png) {
                                   if (!png) return reply(error_response(png.error()));
                                   reply({.content_type = "image/png",
                                          .body = {png->begin(), png->end()},
                                          .headers = {{"Cache-Control", "private, max-age=60"}}});
                                 });
}

HttpResponse Router::scene_thumbnail(std::string_view scene) const {
  const auto image = host_.scene_thumbnail(std::string(scene));
  if (!image && image.error().code == protocol::ErrorCode::not_ready) {
    return with_header(text_response(202, image.error().message), "Retry-After", "1");
  }
  if (!image) return error_response(image.error());
  return {.content_type = "image/jpeg",
          .body = {image->begin(), image->end()},
          .headers = {{"Cache-Control", "private, max-age=60"}}};
}

HttpResponse Router::answer_metrics_listener(const HttpRequest& request) const {
  if (request.method != "GET" && request.method != "HEAD") return method_not_allowed("GET");
  if (request.headers.contains("origin") || embedded_by_other_origin(request)) {
    return text_response(403, "Web pages may not use this port.");
  }
  if (auto state = health(request)) return *std::move(state);
  if (request.path == "/metrics") return metrics();
  return text_response(404, "This port serves /metrics, /health/live and /health/ready.");
}

HttpResponse Router::answer_get(const HttpRequest& request) const {
  if (auto state = health(request)) return *std::move(state);
  if (request.path == "/metrics" && options_.metrics) return metrics();
  if (request.path == "/api/v1/schema") return schema();
  if (request.path == "/openrpc.json") {
    return json_response(protocol::openrpc_document().value().dump());
  }
  if (request.path == "/ws") {
    return with_header(text_response(426, "This address requires a WebSocket upgrade."), "Upgrade",
                       "websocket");
  }
  if (auto file = asset(request)) return *std::move(file);
  return text_response(404, "Not found.");
}

std::optional<HttpResponse> Router::health(const HttpRequest& request) const {
  if (request.path == "/health/live") return text_response(200, "live");
  if (request.path != "/health/ready") return std::nullopt;
  if (draining_) return retry_later("shutting down");
  if (!host_.ready()) return retry_later(host_.not_ready_reason());
  return text_response(200, "ready");
}

HttpResponse Router::metrics() const {
  return {.content_type = "text/plain; version=0.0.4; charset=utf-8",
          .body = metrics_text(
              {.host = host_, .traffic = traffic_, .started = started_, .draining = draining_})};
}

void Router::call(const HttpRequest& request, Role role, const Pending& pending,
                  Reply reply) const {
  const auto context = call_context(request, role, pending);
  host_.dispatcher().handle(request.body, context, [reply = std::move(reply)](std::string answer) {
    if (answer.empty()) return reply({.status = 204, .content_type = {}});
    reply(json_response(std::move(answer)));
  });
}

/// The Model Context Protocol's transport over HTTP, in which each message is a request and each
/// answer its response: nothing needs a stream or a session of the transport.
void Router::call_tool(const HttpRequest& request, Role role, const Pending& pending,
                       Reply reply) const {
  const std::string_view revision = request.header("mcp-protocol-version");
  if (!revision.empty() && !protocol::McpServer::knows(revision)) {
    return reply(text_response(400, "MCP-Protocol-Version: is not a known revision."));
  }
  const auto context = call_context(request, role, pending);
  mcp_.handle(request.body, context, [reply = std::move(reply)](std::string answer) {
    if (answer.empty()) return reply({.status = 202, .content_type = {}});
    reply(json_response(std::move(answer)));
  });
}

/// Geometry and textures as they are in the file, which images do not give away: not for those that
/// may only watch.
void Router::exported_scene(const HttpRequest& request, std::string_view session, Role role,
                            const Pending& pending, Reply reply) const {
  const auto found = host_.sessions().find(session);
  if (!found) return reply(error_response(found.error()));
  if (role != Role::control) {
    return reply(text_response(403, "This token is read-only and cannot export scenes."));
  }
  if (const auto known = check_parameters(request, {}); !known) {
    return reply(error_response(known.error()));
  }
  auto scene = (*found)->scene().exported();
  if (!scene) return reply(error_response(scene.error()));
  (*found)->mark_used();
  const std::string name = scene->scene->name;
  host_.exporter().write(*std::move(scene), pending,
                         [reply, name](protocol::Result<session::ExportedScene> exported) {
                           if (!exported) return reply(error_response(exported.error()));
                           reply(scene_download(name, *exported));
                         });
}

void Router::image(const HttpRequest& request, const ImageAddress& address, Role role,
                   const Pending& pending, Reply reply) const {
  const auto found = host_.sessions().find(address.session);
  if (!found) return reply(error_response(found.error()));
  const ImageKind* const kind = image_kind(address.extension);
  if (!kind) {
    return reply(text_response(
        404, "Images are frame.jpg, frame.png, frame.webp, frame.exr and frame.npy."));
  }
  auto asked = read_image_request(request, (*found)->limits());
  if (!asked) return reply(error_response(asked.error()));
  if (role != Role::control && !asked->view.as_shown()) {
    return reply(text_response(403, "This token is read-only: images show what viewers see."));
  }
  const bool of_output = asked->capture.buffer == "output";
  if (asked->view.transparent && (kind->format != protocol::ImageFormat::png || !of_output)) {
    return reply(error_response(
        protocol::error::invalid("transparent", "is possible for frame.png of output only")));
  }
  asked->capture.format = kind->format;
  asked->capture.answer = pending;
  asked->capture.done = [reply, kind](protocol::Result<session::Capture> result) {
    if (!result) return reply(error_response(result.error()));
    reply({.content_type = std::string(kind->content_type),
           .body = {result->file.begin(), result->file.end()},
           .headers = {{"X-Heliograph-Samples", std::to_string(result->samples)}}});
  };
  const auto accepted =
      session::request_snapshot(host_, *found, asked->view, std::move(asked->capture));
  if (!accepted) reply(error_response(accepted.error()));
}

}  // namespace heliograph::net
