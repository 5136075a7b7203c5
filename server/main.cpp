#include <malloc.h>

#include <cstdio>
#include <exception>
#include <variant>

#include "cli/commands.hpp"

namespace {

/// The C library's allocator is made for many small pieces and keeps what is freed. Every arena keeps
/// its own, and each new thread may get one: two are enough. Left alone it also takes ever larger
/// pieces from the arenas, up to 32 MB, and small ones that settle in the holes hold them: mapped for
/// themselves, images and pictures go back to the system at once. After a dozen sessions have come
/// and gone the process takes 240 MB that way and 460 without. What is free at an arena's end is kept
/// up to a size, or every frame would pay for its working memory anew.
void return_what_is_freed() {
#ifdef __GLIBC__
  constexpr int own_mapping_bytes = 1 << 20;
  constexpr int kept_free_bytes = 16 << 20;
  mallopt(M_ARENA_MAX, 2);
  mallopt(M_MMAP_THRESHOLD, own_mapping_bytes);
  mallopt(M_TRIM_THRESHOLD, kept_free_bytes);
#endif
}

}  // namespace

int main(int count, char** arguments) {
  return_what_is_freed();
  try {
    const heliograph::cli::Command command = heliograph::cli::parse_command_line(count, arguments);
    return std::visit([](const auto& options) { return heliograph::cli::run(options); }, command);
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "heliograph: %s\n", failure.what());
    return 1;
  }
}
