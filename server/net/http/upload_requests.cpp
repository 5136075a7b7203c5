#include "net/http/upload_requests.hpp"

#include <boost/beast/http/read.hpp>
#include <cerrno>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <utility>

#include "net/io_handler.hpp"
#include "session/event_log.hpp"

namespace heliograph::net {
namespace {

namespace http = beast::http;
using boost::system::error_code;

constexpr std::chrono::minutes max_upload_duration{10};

/// Why a client may not change the uploads. `what` it wants to do to them: "upload".
std::optional<HttpResponse> change_refusal(const ServerContext& context, const HttpRequest& request,
                                           const std::string& what) {
  if (context.certificate && !request.secure) return text_response(400, "Use HTTPS.");
  Admission admission = context.access.admit(request);
  if (admission.refusal) return *std::move(admission.refusal);
  if (admission.role != Role::control) {
    return text_response(403, "This token is read-only and cannot " + what + ".");
  }
  if (context.draining) return retry_later("The server is shutting down.");
  return std::nullopt;
}

/// `length`: of the body, bytes, where the request tells it.
std::optional<HttpResponse> upload_refusal(const ServerContext& context, const HttpRequest& request,
                                           std::optional<std::uint64_t> length) {
  if (auto refused = change_refusal(context, request, "upload")) return refused;
  const std::optional<UploadAddress> address = upload_address(request.path);
  if (!address) {
    return text_response(404,
                         "Scenes go to /api/v1/scenes/NAME, environments to "
                         "/api/v1/environments/NAME, images to /api/v1/images/NAME.");
  }
  if (!length) return text_response(411, "An upload needs a Content-Length.");
  if (*length == 0) return text_response(400, "The upload is empty.");
  return context.router.name_conflict(*address);
}

/// 201 Created, with what the file has.
HttpResponse upload_response(const session::UploadedFile& file) {
  nlohmann::json described{{"name", file.name}, {"bytes", file.bytes}};
  if (file.kind == session::UploadKind::scene) {
    described["triangles"] = file.triangles;
  } else {
    described["width"] = file.width;
    described["height"] = file.height;
  }
  HttpResponse response = json_response(described.dump());
  response.status = 201;
  return response;
}

/// Of the file that an upload is written to; all other errors are the connection's.
bool is_of_disk(error_code error) {
  return error == boost::system::errc::no_space_on_device ||
         error == boost::system::errc::io_error ||
         error == error_code(EDQUOT, asio::error::get_system_category());
}

}  // namespace

std::optional<HttpResponse> UploadReceiver::begin(const HttpRequest& request,
                                                  http::request_parser<http::string_body>& parser) {
  std::optional<std::uint64_t> size;
  if (const auto told = parser.content_length()) size = *told;
  if (auto refused = upload_refusal(context_, request, size)) return refused;
  const UploadAddress address = *upload_address(request.path);
  auto begun = context_.uploads->begin(address.kind, std::string(address.name), *size);
  if (!begun) return error_response(begun.error());
  incoming_ = *begun;
  parser_.emplace(std::move(parser));
  error_code error;
  parser_->get().body().open(incoming_->path().c_str(), beast::file_mode::write, error);
  if (error) {
    incoming_.reset();
    return error_response(protocol::error::internal());
  }
  deadline_ = std::chrono::steady_clock::now() + max_upload_duration;
  return std::nullopt;
}

HttpResponse delete_upload(const ServerContext& context, const HttpRequest& request) {
  if (auto refused = change_refusal(context, request, "delete uploads")) return *std::move(refused);
  const UploadAddress address = *upload_address(request.path);
  const auto removed =
      context.host.delete_upload(*context.uploads, address.kind, std::string(address.name));
  if (removed) return {.status = 204, .content_type = {}};
  // A file of this name that another has put there stays.
  const bool missing = removed.error().code == protocol::ErrorCode::not_found;
  if (missing && context.router.name_conflict(address)) {
    return text_response(409, "It was not uploaded: only uploads can be deleted.");
  }
  return error_response(removed.error());
}

void UploadReceiver::receive(ClientStream& stream, beast::flat_buffer& buffer, Answer answer) {
  stream.next_layer().expires_after(handshake_timeout);
  http::async_read_some(
      stream, buffer, *parser_,
      IoHandler([this, &stream, &buffer, answer = std::move(answer)](error_code error) mutable {
        received(error, stream, buffer, std::move(answer));
      }));
}

void UploadReceiver::received(error_code error, ClientStream& stream, beast::flat_buffer& buffer,
                              Answer answer) {
  const bool late = std::chrono::steady_clock::now() > deadline_;
  if (is_of_disk(error)) {
    session::log_error({}, "an upload could not be written: " + error.message());
    incoming_.reset();
    return answer(error_response(protocol::error::full("the server's disk is full or has failed")));
  }
  if (error || late) return incoming_.reset();
  if (!parser_->is_done()) return receive(stream, buffer, std::move(answer));
  parser_->get().body().close();
  stream.next_layer().expires_never();
  check(stream, std::move(answer));
}

void UploadReceiver::check(ClientStream& stream, Answer answer) {
  context_.uploads->finish(
      std::exchange(incoming_, nullptr),
      [&host = context_.host, executor = stream.get_executor(),
       answer = std::move(answer)](const protocol::Result<session::UploadedFile>& accepted) {
        if (accepted) host.uploads_changed({.kind = accepted->kind, .name = accepted->name});
        HttpResponse response =
            accepted ? upload_response(*accepted) : error_response(accepted.error());
        run_later(executor, [answer, response = std::move(response)]() mutable {
          answer(std::move(response));
        });
      });
}

}  // namespace heliograph::net
