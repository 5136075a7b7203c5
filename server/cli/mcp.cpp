#include <condition_variable>
#include <iostream>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "cli/commands.hpp"
#include "cli/engine_options.hpp"
#include "cli/log.hpp"
#include "cli/scene_roots.hpp"
#include "protocol/json/mcp_server.hpp"
#include "session/session_host.hpp"

namespace heliograph::cli {
namespace {

constexpr std::uint32_t mcp_width = 640, mcp_height = 360;

session::HostOptions mcp_host_options(const McpOptions& options) {
  session::HostOptions result;
  result.session.width = options.width.value_or(mcp_width);
  result.session.height = options.height.value_or(mcp_height);
  result.session.settings = parse_settings(options.settings);
  result.scene_roots = choose_scene_roots(options.scene_roots);
  if (!options.environment.empty()) result.environment = options.environment;
  result.import_limits = options.limits;
  return result;
}

/// Answers on stdout, a line each, in the order in which they are ready.
class Answers {
 public:
  protocol::Dispatcher::Reply expect() {
    const std::lock_guard lock(mutex_);
    ++expected_;
    return [this](const std::string& text) { write(text); };
  }
  /// Waits for those that are expected.
  void finish() {
    std::unique_lock lock(mutex_);
    all_written_.wait(lock, [this] { return expected_ == 0; });
  }

 private:
  void write(const std::string& text) {
    const std::lock_guard lock(mutex_);
    if (!text.empty()) std::cout << text << std::endl;
    if (--expected_ == 0) all_written_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable all_written_;
  int expected_ = 0;
};

/// Returns when the scene is shown. @throws std::runtime_error where it cannot be
void load_and_wait(session::SessionHost& host, const std::string& scene) {
  std::mutex mutex;
  std::condition_variable loaded;
  std::optional<protocol::Result<protocol::SceneInfo>> result;
  host.load_scene(host.sessions().main(), {.name = scene}, {}, [&](auto outcome) {
    const std::lock_guard lock(mutex);
    result = std::move(outcome);
    loaded.notify_all();
  });
  std::unique_lock lock(mutex);
  loaded.wait(lock, [&] { return result.has_value(); });
  if (!*result) throw std::runtime_error(scene + ": " + result->error().reason);
}

}  // namespace

int run(const McpOptions& options) {
  set_up_log(options.log);
  session::HostOptions hosting = mcp_host_options(options);
  const std::optional<std::string> scene =
      choose_scene(session::SceneCatalogue(hosting.scene_roots), options.scene);
  hosting.session.starts_empty = !scene;
  const std::unique_ptr<render::Engine> engine = make_engine(options.device);
  Answers answers;
  session::SessionHost host({*engine}, hosting);
  if (scene) load_and_wait(host, *scene);
  const protocol::McpServer server(host.dispatcher(), HELIOGRAPH_VERSION);
  for (std::string line; std::getline(std::cin, line);) {
    if (!line.empty()) server.handle(line, {}, answers.expect());
  }
  answers.finish();
  host.stop();
  return 0;
}

}  // namespace heliograph::cli
