#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string_view>

#include "scene/scene.hpp"

namespace heliograph::scene {

/// Why a file was refused: one line that names the object and the reason, never a path or a size
/// of anything outside the scene.
class ImportError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What a file may cost. Exceeding one refuses the file with an error that names the limit.
struct ImportLimits {
  std::uint64_t file_bytes = 512ull << 20;
  std::uint64_t unpacked_bytes = 1ull << 30;  // that compressed buffer views grow to
  std::uint64_t triangles = 20'000'000;
  std::uint64_t texels = 256ull << 20;
  std::uint32_t texture_size = 8192;
  std::uint32_t nodes = 200'000;
  std::uint32_t instances = 200'000;
  std::uint32_t node_depth = 256;
  std::uint32_t json_depth = 64;
  std::uint64_t json_values = 16'000'000;
};

/// Told as loading proceeds: stage name and fraction of the whole, 0..1. Called on the loading
/// thread.
using ImportProgress = std::function<void(std::string_view stage, float fraction)>;

/// Reads a .glb or .gltf file with everything it refers to; nothing outside `path`'s folder is
/// opened.
/// @throws ImportError
Scene import_gltf(const std::filesystem::path& path, const ImportLimits& limits = {},
                  const ImportProgress& progress = {});

}  // namespace heliograph::scene
