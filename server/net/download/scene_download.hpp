#pragma once

#include <string>

#include "net/http/http_message.hpp"
#include "session/edits/scene_exporter.hpp"

namespace heliograph::net {

/// The file of an edited scene called `name`. The header X-Heliograph-Warnings holds what it lacks,
/// as an array of strings in JSON, in ASCII.
HttpResponse scene_download(const std::string& name, const session::ExportedScene& exported);

}  // namespace heliograph::net
