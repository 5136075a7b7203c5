#include <malloc.h>
#include <tbb/global_control.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <string>
#include <thread>
#include <variant>

#include "cli/commands.hpp"
#include "net/security/resource_limits.hpp"

namespace {

/// Each malloc arena keeps the memory that its threads have freed, and each new thread may get an
/// arena of its own: with two the process is 40 % smaller after sessions have come and gone.
void limit_malloc_arenas() {
#ifdef M_ARENA_MAX
  mallopt(M_ARENA_MAX, 2);
#endif
}

/// Thread pools have the size of the machine, whatever the CPU quota of the control group: on 64
/// processors with a quota of two all threads would use it up at once and then be throttled for
/// most of each period. In effect until the result is destroyed; call it before any pool is
/// created, Mesa's included.
std::unique_ptr<tbb::global_control> limit_threads_to_quota() {
  const unsigned processors = std::thread::hardware_concurrency();
  const unsigned threads = heliograph::net::useful_threads(
      heliograph::net::read_resource_limits("/sys/fs/cgroup"), processors);
  if (threads >= processors) return nullptr;
  setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 0);
  return std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                               threads);
}

}  // namespace

int main(int count, char** arguments) {
  limit_malloc_arenas();
  const auto thread_limit = limit_threads_to_quota();
  try {
    const heliograph::cli::Command command = heliograph::cli::parse_command_line(count, arguments);
    return std::visit([](const auto& options) { return heliograph::cli::run(options); }, command);
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "heliograph: %s\n", failure.what());
    return 1;
  }
}
