#include "net/http/upload_requests.hpp"

#include <cerrno>
#include <nlohmann/json.hpp>
#include <utility>

namespace heliograph::net {

std::optional<HttpResponse> upload_refusal(const ServerContext& context, const HttpRequest& request,
                                           std::optional<std::uint64_t> length) {
  if (context.certificate && !request.secure) return text_response(400, "Use HTTPS.");
  Admission admission = context.access.admit(request);
  if (admission.refusal) return *std::move(admission.refusal);
  if (admission.role != Role::control) {
    return text_response(403, "This token is read-only and cannot upload.");
  }
  if (context.draining) return retry_later("The server is shutting down.");
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

bool is_of_disk(boost::system::error_code error) {
  return error == boost::system::errc::no_space_on_device ||
         error == boost::system::errc::io_error ||
         error == boost::system::error_code(EDQUOT, asio::error::get_system_category());
}

}  // namespace heliograph::net
