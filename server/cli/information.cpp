#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/commands.hpp"
#include "cli/engine_options.hpp"
#include "net/http/health_client.hpp"
#include "protocol/methods.hpp"
#include "protocol/settings/settings_json.hpp"
#include "render/api/renderer.hpp"

// The commands that print information.

namespace heliograph::cli {

int run(const DevicesOptions& options) {
  std::fputs(render::describe_devices(engine_options(options.device)).c_str(), stdout);
  return 0;
}

int run(const SchemaOptions& options) {
  if (options.markdown) {
    std::fputs(protocol::settings_markdown().c_str(), stdout);
    return 0;
  }
  const nlohmann::json document{{"openrpc", protocol::openrpc_document().value()},
                                {"settings", protocol::settings_schema()}};
  std::printf("%s\n", document.dump(2).c_str());
  return 0;
}

int run(const HealthOptions& options) {
  const net::HealthAnswer answer =
      net::ask_health(options.url, options.authorities, std::chrono::seconds(5));
  std::fprintf(answer.healthy ? stdout : stderr, "%s: %s\n", options.url.c_str(),
               answer.text.c_str());
  return answer.healthy ? 0 : 1;
}

}  // namespace heliograph::cli
