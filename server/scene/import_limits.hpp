#pragma once

#include <cstdint>
#include <string>

namespace heliograph::scene {

/// Selects a scene and variant of a file; empty: the file's defaults.
struct SceneChoice {
  std::string scene;    // the name of one of its scenes, or its number from 0
  std::string variant;  // the name of one of its material variants
  bool operator==(const SceneChoice&) const = default;
};

/// Limits on the cost of a file. Exceeding one rejects the file with an error that names the limit.
struct ImportLimits {
  std::uint64_t file_bytes = 512ull << 20;
  std::uint64_t unpacked_bytes = 1ull << 30;  // of all decompressed buffer views
  std::uint64_t scene_bytes = 2ull << 30;     // of geometry and animations in memory
  std::uint64_t triangles = 20'000'000;
  std::uint64_t texels = 256ull << 20;
  std::uint32_t texture_size = 8192;
  std::uint32_t nodes = 200'000;
  std::uint32_t instances = 200'000;
  std::uint32_t node_depth = 256;
  std::uint32_t json_depth = 64;
  std::uint64_t json_values = 16'000'000;
  /// Whether an image that is missing or damaged refuses the file. Otherwise materials are shown
  /// without it, with a warning.
  bool strict_assets = false;
};

}  // namespace heliograph::scene
