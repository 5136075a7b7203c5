#pragma once

#include <cstdint>
#include <string>

#include "scene/import_error.hpp"

namespace heliograph::scene {

/// What may still be made of a file. A few bytes of it can ask for any number of vertices, keys or
/// matrices, so that everything is paid for here before it is made.
class ByteBudget {
 public:
  explicit ByteBudget(std::uint64_t bytes) : all_(bytes), left_(bytes) {}

  /// `count` things of `size` bytes each, wanted by the object at `path`.
  /// @throws ImportError when there is not so much left
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
