#include "tests/support/engine.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <string_view>

#include "tracing/tracer_choice.hpp"

namespace heliograph::test {
namespace {

using Engines = std::map<std::string, std::unique_ptr<render::Engine>>;

Engines& engines() {
  static Engines all;
  return all;
}

}  // namespace

render::Engine& engine(const std::string& tracer) {
  auto& wanted = engines()[tracer];
  if (!wanted) {
    const char* device = std::getenv("HELIOGRAPH_TEST_DEVICE");
    const char* kernels = std::getenv("HELIOGRAPH_TEST_HOST_KERNELS");
    wanted = std::make_unique<render::Engine>(
        render::EngineOptions{.device = device ? device : "",
                              .tracer = tracer,
                              .validation = true,
                              .cache_folder = {},
                              .host_kernels = !kernels || std::string_view(kernels) != "off",
                              .as_gpu = std::getenv("HELIOGRAPH_TEST_AS_GPU") != nullptr});
    std::printf("device: %s, %s, tracer %s\n", wanted->device().name.c_str(),
                wanted->device().driver.c_str(), tracer.c_str());
  }
  return *wanted;
}

std::vector<std::string> supported_tracers() {
  std::vector<std::string> names;
  for (const protocol::TracerKind kind : tracing::supported_tracers(device().report())) {
    names.emplace_back(protocol::enum_name(kind));
  }
  return names;
}

bool is_supported(const std::string& tracer) {
  const std::vector<std::string> names = supported_tracers();
  return std::find(names.begin(), names.end(), tracer) != names.end();
}

std::string unsupported_reason(const std::string& tracer) {
  return device().report().name + " does not support the tracer " + tracer;
}

std::uint64_t validation_messages() {
  std::uint64_t messages = 0;
  for (const auto& [tracer, made] : engines()) {
    if (made) messages += made->validation_messages();
  }
  return messages;
}

void release_engines() {
  engines().clear();
}

}  // namespace heliograph::test
