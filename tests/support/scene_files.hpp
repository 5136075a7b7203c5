#pragma once

#include <filesystem>
#include <optional>

namespace heliograph::test {

/// $HELIOGRAPH_TEST_ASSETS / `path`, or nullopt where the variable is not set.
std::optional<std::filesystem::path> asset(const std::filesystem::path& path);

}  // namespace heliograph::test
