#pragma once

#include <string>
#include <vector>

#include "protocol/messages/render_messages.hpp"

namespace heliograph::cli {

/// The entries of a manifest: a JSON array of objects, or an object on each line; `file` "-" is
/// standard input. Members that an entry lacks are those of `common`.
/// @throws std::runtime_error, std::invalid_argument naming file and entry
std::vector<protocol::RenderRequest> read_manifest(const std::string& file,
                                                   const protocol::RenderRequest& common);

}  // namespace heliograph::cli
