#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <stop_token>
#include <string_view>
#include <vector>

#include "scene/image/mipmaps.hpp"
#include "scene/import_error.hpp"
#include "scene/import_limits.hpp"
#include "scene/regular_file.hpp"
#include "scene/scene.hpp"

namespace heliograph::scene {

/// Seconds per stage of an import. Geometry and images are read in parallel, unless the scene is
/// given away without textures first.
struct ImportTimes {
  double parse = 0.0;  // the file read, its document parsed, buffers and views checked and unpacked
  double check = 0.0;  // every other table of the document
  double geometry = 0.0;  // vertices, triangles, tangents
  double images = 0.0;    // decoded, with mip levels
  double place = 0.0;     // nodes, instances, clips, lights, cameras
  double total = 0.0;
};

/// Progress callback: stage name and fraction of the whole, 0..1. Called on the loading thread.
using ImportProgress = std::function<void(std::string_view stage, float fraction)>;

struct ImportOptions {
  SceneChoice choice;
  ImportProgress progress;       // an exception of it cancels the import and is rethrown
  ImportTimes* times = nullptr;  // filled if given
  std::stop_token stop;  // asked by all threads: LoadCancelled is thrown soon after a request
  /// Other levels of images are not kept, but for alpha masks.
  KeptTextures kept_textures;
  /// Textures of materials in place of the file's. @throws NoSuchSlot where the file has no such
  /// material
  std::vector<TextureOverride> textures = {};
  /// Called once, on the loading thread, with the scene without its textures and the bytes of its
  /// images' files, before these are read and decoded; the whole scene shares its lists. Only where
  /// no textures are replaced and there are at least `untextured_from` bytes; otherwise, and
  /// without it, images are decoded beside the geometry, which takes less time for the whole. An
  /// exception of it cancels the import and is rethrown.
  std::function<void(std::unique_ptr<Scene>, std::uint64_t image_bytes)> untextured = {};
  std::uint64_t untextured_from = 0;
};

/// Reads a .glb or .gltf file with everything it refers to; opens nothing outside `path`'s folder.
/// @throws ImportError, LoadCancelled
Scene import_gltf(const std::filesystem::path& path, const ImportLimits& limits = {},
                  const ImportOptions& options = {});

/// Reads a .glb or .gltf file that is alone: others that it refers to are missing. Opens none.
/// @throws ImportError
Scene import_lone_gltf(RegularFile file, const ImportLimits& limits = {});

}  // namespace heliograph::scene
