#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "net/http/http_message.hpp"
#include "session/snapshot.hpp"

namespace heliograph::net {

struct ImageKind {
  std::string_view extension;
  protocol::ImageFormat format;
  std::string_view content_type;
};

/// The kind of image with this extension, or null.
const ImageKind* image_kind(std::string_view extension);

/// What the query of an image's address asks for.
struct ImageRequest {
  session::CaptureRequest capture;
  session::SnapshotView view;
};

/// Refuses members of the query that there are not. `limits`: of the session.
protocol::Result<ImageRequest> read_image_request(const HttpRequest& request,
                                                  const session::SessionLimits& limits);

/// Refuses a query that has other members than these and those of every address. A mistyped one
/// would silently change nothing.
protocol::Result<void> check_parameters(const HttpRequest& request,
                                        std::vector<std::string_view> known);

}  // namespace heliograph::net
