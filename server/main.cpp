#include <malloc.h>
#include <tbb/global_control.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <thread>
#include <variant>

#include "cli/commands.hpp"
#include "net/security/resource_limits.hpp"

namespace {

/// Every malloc arena keeps the memory that its threads freed, and new threads get new arenas: with
/// a limit of two the process is 40 % smaller after sessions were opened and closed.
void limit_malloc_arenas() {
#ifdef M_ARENA_MAX
  mallopt(M_ARENA_MAX, 2);
#endif
}

/// Limits thread pools to the CPU quota of the control group. By default they have a thread per
/// processor: on 64 processors with a quota of two, all threads would use up the quota at once and
/// then be throttled for most of each period. Must run before any pool is created, including
/// Mesa's; applies while the result exists.
std::unique_ptr<tbb::global_control> limit_threads_to_quota() {
  const unsigned processors = std::thread::hardware_concurrency();
  const unsigned threads = heliograph::net::useful_threads(
      heliograph::net::read_resource_limits("/sys/fs/cgroup"), processors);
  if (threads >= processors) return nullptr;
  setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 0);
  return std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                               threads);
}

/// An exception that nothing can handle, as where memory is exhausted in a destructor, ends the
/// program with one line.
[[noreturn]] void end_with_reason() noexcept {
  try {
    if (const auto failure = std::current_exception()) std::rethrow_exception(failure);
    std::fputs("heliograph: a library has given up, as where memory is exhausted\n", stderr);
    std::_Exit(EXIT_FAILURE);
  } catch (const std::bad_alloc&) {
    std::fputs("heliograph: out of memory\n", stderr);
    std::_Exit(EXIT_FAILURE);
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "heliograph: %s\n", failure.what());
  } catch (...) {
    std::fputs("heliograph: an exception of unknown type\n", stderr);
  }
  std::abort();
}

}  // namespace

int main(int count, char** arguments) {
  std::set_terminate(end_with_reason);
  limit_malloc_arenas();
  const auto thread_limit = limit_threads_to_quota();
  try {
    const heliograph::cli::Command command = heliograph::cli::parse_command_line(count, arguments);
    return std::visit([](const auto& options) { return heliograph::cli::run(options); }, command);
  } catch (const std::bad_alloc&) {
    std::fputs("heliograph: out of memory\n", stderr);
    return 1;
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "heliograph: %s\n", failure.what());
    return 1;
  }
}
