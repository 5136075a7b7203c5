#pragma once

#include <boost/system/error_code.hpp>
#include <cstdint>
#include <optional>

#include "net/connection.hpp"
#include "net/http/http_message.hpp"

// For the sources of this folder only: it brings Boost.

namespace heliograph::net {

/// Why a body is not received: the client may not upload, or the address or the length is wrong.
/// `length`: of the body, bytes, where the request tells it.
std::optional<HttpResponse> upload_refusal(const ServerContext& context, const HttpRequest& request,
                                           std::optional<std::uint64_t> length);

/// 201 Created, with what the file has.
HttpResponse upload_response(const session::UploadedFile& file);

/// Of the file that an upload is written to; all other errors are the connection's.
bool is_of_disk(boost::system::error_code error);

}  // namespace heliograph::net
