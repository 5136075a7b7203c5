#include "net/download/scene_download.hpp"

#include <nlohmann/json.hpp>
#include <utility>

namespace heliograph::net {
namespace {

// Clients refuse heads of responses that are much longer.
constexpr std::size_t max_warning_bytes = 4096;

std::string ascii_json(const nlohmann::json& value) {
  return value.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

/// As many as fit, and how many more there are.
std::string warning_header(const std::vector<std::string>& warnings) {
  nlohmann::json shown = nlohmann::json::array();
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < warnings.size(); ++i) {
    bytes += ascii_json(warnings[i]).size() + 1;
    if (bytes > max_warning_bytes) {
      shown.push_back("and " + std::to_string(warnings.size() - i) + " more");
      break;
    }
    shown.push_back(warnings[i]);
  }
  return ascii_json(shown);
}

/// Of characters that every file system takes.
std::string download_name(const std::string& scene) {
  std::string name;
  for (const char c : scene) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    name += plain || c == '-' || c == '_' ? c : '_';
  }
  return (name.empty() ? "scene" : name) + "_edited.glb";
}

}  // namespace

HttpResponse scene_download(const std::string& name, const session::ExportedScene& exported) {
  Content content;
  content.add_file(exported.file->path(), exported.bytes, exported.file);
  HttpResponse response{.content_type = "model/gltf-binary", .body = {}, .headers = {}};
  response.content = std::move(content);
  response.headers = {
      {"Content-Disposition", "attachment; filename=\"" + download_name(name) + "\""}};
  if (!exported.warnings.empty()) {
    response.headers.emplace_back("X-Heliograph-Warnings", warning_header(exported.warnings));
  }
  return response;
}

}  // namespace heliograph::net
