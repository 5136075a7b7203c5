#include "tests/support/scene_files.hpp"

#include <cstdlib>

namespace heliograph::test {

std::optional<std::filesystem::path> asset(const std::filesystem::path& path) {
  const char* folder = std::getenv("HELIOGRAPH_TEST_ASSETS");
  if (!folder || !*folder) return std::nullopt;
  return std::filesystem::path(folder) / path;
}

}  // namespace heliograph::test
