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

/// Every arena of the allocator keeps what its threads have freed, and each new thread may get one
/// of its own: with two the process is 40 % smaller after sessions have come and gone.
void keep_few_arenas() {
#ifdef M_ARENA_MAX
  mallopt(M_ARENA_MAX, 2);
#endif
}

/// Pools are as large as the machine, whatever a control group's quota lasts for: on 64 processors
/// with a quota of two all threads would use it up in a moment and then rest for most of each
/// period. Holds for as long as what it gives is kept; before any pool is made, Mesa's among them.
std::unique_ptr<tbb::global_control> keep_to_quota() {
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
  keep_few_arenas();
  const auto thread_limit = keep_to_quota();
  try {
    const heliograph::cli::Command command = heliograph::cli::parse_command_line(count, arguments);
    return std::visit([](const auto& options) { return heliograph::cli::run(options); }, command);
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "heliograph: %s\n", failure.what());
    return 1;
  }
}
