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

/// What of a file is wanted; empty: its defaults.
struct SceneChoice {
  std::string scene;    // the name of one of its scenes, or its number from 0
  std::string variant;  // the name of one of its material variants
  bool operator==(const SceneChoice&) const = default;
};

/// The file has no such scene or variant.
class NoSuchChoice : public ImportError {
 public:
  /// `member` of SceneChoice; `names` are those there are.
  NoSuchChoice(std::string member, const std::string& wanted, std::vector<std::string> names);

  const std::string& member() const { return member_; }
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::string member_;
  std::vector<std::string> names_;
};

/// What a file may cost. Exceeding one refuses the file with an error that names the limit.
struct ImportLimits {
  std::uint64_t file_bytes = 512ull << 20;
  std::uint64_t unpacked_bytes = 1ull << 30;  // that compressed buffer views grow to
  std::uint64_t scene_bytes = 2ull << 30;     // of geometry and animations, once read
  std::uint64_t triangles = 20'000'000;
  std::uint64_t texels = 256ull << 20;
  std::uint32_t texture_size = 8192;
  std::uint32_t nodes = 200'000;
  std::uint32_t instances = 200'000;
  std::uint32_t node_depth = 256;
  std::uint32_t json_depth = 64;
  std::uint64_t json_values = 16'000'000;
};

/// Seconds that the stages of an import took. Geometry and images are read side by side.
struct ImportTimes {
  double parse = 0.0;  // the file read, its document parsed, buffers and views checked and unpacked
  double check = 0.0;  // every other table of the document
  double geometry = 0.0;  // vertices, triangles, tangents
  double images = 0.0;    // decoded, with mip levels
  double place = 0.0;     // nodes, instances, clips, lights, cameras
  double total = 0.0;
};

/// Told as loading proceeds: stage name and fraction of the whole, 0..1. Called on the loading
/// thread.
using ImportProgress = std::function<void(std::string_view stage, float fraction)>;

/// Reads a .glb or .gltf file with everything it refers to; nothing outside `path`'s folder is
/// opened. `times`, where given, is filled in. What `progress` throws ends the import and comes
/// out.
/// @throws ImportError
Scene import_gltf(const std::filesystem::path& path, const ImportLimits& limits = {},
                  const ImportProgress& progress = {}, ImportTimes* times = nullptr,
                  const SceneChoice& choice = {});

}  // namespace heliograph::scene
