#pragma once

#include <cstdint>
#include <string>

namespace heliograph::session {

/// The scene of a file that something belongs to.
struct ScenePart {
  std::string name;
  std::uint32_t part = 0;
  bool operator==(const ScenePart&) const = default;
};

}  // namespace heliograph::session
