#include "cli/job_options.hpp"

#include <string_view>
#include <unordered_map>
#include <utility>

#include "cli/option_groups.hpp"
#include "net/http/http_client.hpp"
#include "protocol/json/suggestions.hpp"
#include "session/library/scene_catalogue.hpp"

namespace heliograph::cli {
namespace {

namespace fs = std::filesystem;
using protocol::Result;

/// What "heliograph render" has to be told of this server.
std::vector<std::string> render_arguments(const ServeOptions& options,
                                          const std::vector<fs::path>& image_roots) {
  std::vector<std::string> arguments;
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) arguments.insert(arguments.end(), {name, value});
  };
  for (const std::string& device : options.device.devices) add("--device", device);
  add("--tracer", options.device.tracer);
  if (!options.device.shader_dir.empty()) {
    add("--shader-dir", fs::absolute(options.device.shader_dir).string());
  }
  if (!options.environment.empty()) {
    add("--environment", fs::absolute(options.environment).string());
  }
  for (const fs::path& root : image_roots) add("--images", fs::absolute(root).string());
  add("--preset", options.settings.preset);
  for (const std::string& assignment : options.settings.assignments) add("--set", assignment);
  const std::vector<std::string> limits = limit_arguments(options.limits);
  arguments.insert(arguments.end(), limits.begin(), limits.end());
  return arguments;
}

/// Files by their names, with or without extension.
class NamedFiles {
 public:
  explicit NamedFiles(const std::vector<session::CatalogueEntry>& entries) {
    for (const session::CatalogueEntry& entry : entries) {
      files_.emplace(entry.name, entry.path);
      files_.emplace(entry.name + entry.path.extension().string(), entry.path);
      names_.push_back(entry.name);
    }
  }

  Result<fs::path> find(const std::string& name) const {
    if (const auto found = files_.find(name); found != files_.end()) return found->second;
    return protocol::error::not_found(
        "name",
        "is not in the catalogue" + protocol::suggestion(name, {names_.begin(), names_.end()}));
  }

 private:
  std::unordered_map<std::string, fs::path> files_;
  std::vector<std::string> names_;
};

jobs::QueueOptions::Catalogue read_catalogue(const session::SceneCatalogue& scenes,
                                             const session::SceneCatalogue& environments) {
  const auto lookup = [](const std::vector<session::CatalogueEntry>& entries) {
    return [files = std::make_shared<const NamedFiles>(entries)](const std::string& name) {
      return files->find(name);
    };
  };
  return {.scene = lookup(scenes.list()),
          .environment = lookup(environments.list_files({".hdr", ".exr"}))};
}

bool deliver(const jobs::QueueOptions::Delivery& delivery) {
  const net::ClientAnswer answer =
      net::ask_server({.url = delivery.url,
                       .method = "POST",
                       .body = delivery.body,
                       .headers = {{"Content-Type", "application/json"},
                                   {"X-Heliograph-Signature", delivery.signature}}});
  return answer.status >= 200 && answer.status < 300;
}

}  // namespace

std::unique_ptr<jobs::JobQueue> make_job_queue(const ServeOptions& options,
                                               const session::HostOptions& hosting) {
  if (options.jobs.empty()) return nullptr;
  const auto scenes = std::make_shared<session::SceneCatalogue>(hosting.scene_roots);
  const auto environments =
      std::make_shared<session::SceneCatalogue>(hosting.all_environment_roots());
  jobs::QueueOptions queue{
      .folder = fs::absolute(options.jobs),
      .quota = options.job_quota,
      .max_waiting = options.max_waiting_jobs,
      .keep_seconds = static_cast<double>(options.keep_jobs),
      .render_arguments = render_arguments(options, hosting.image_roots),
      .webhook_hosts = options.webhook_hosts,
      .webhook_secret = options.webhook_secret,
      .catalogue = [scenes, environments] { return read_catalogue(*scenes, *environments); },
      .deliver = deliver};
  return std::make_unique<jobs::JobQueue>(std::move(queue));
}

}  // namespace heliograph::cli
