#pragma once

#include <cstdint>
#include <string>

#include "scene/import_error.hpp"

namespace heliograph::scene {

/// Memory that a file may still allocate. A few bytes can request any number of vertices, keys or
/// matrices, so that every allocation is charged here first.
class ByteBudget {
 public:
  explicit ByteBudget(std::uint64_t bytes) : all_(bytes), left_(bytes) {}

  /// Charges `count` elements of `size` bytes for the object at `path`.
  /// @throws ImportError when the budget is exceeded
  void take(std::uint64_t count, std::uint64_t size, const std::string& path) {
    if (size != 0 && count > left_ / size) {
      throw ImportError(path + ": the scene's geometry and animations exceed the limit of " +
                        std::to_string(all_) + " bytes");
    }
    left_ -= count * size;
  }

 private:
  std::uint64_t all_;
  std::uint64_t left_;
};

}  // namespace heliograph::scene
