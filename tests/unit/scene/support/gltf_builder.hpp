#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "scene/import.hpp"

namespace heliograph::scene::test {

using Bytes = std::vector<std::uint8_t>;

/// A temporary folder, removed by the destructor.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path write(std::string_view name, const Bytes& bytes) const;
  std::filesystem::path write(std::string_view name, std::string_view text) const;

 private:
  std::filesystem::path path_;
};

/// A glTF document under construction: JSON for tests to edit, and one binary buffer.
struct GltfBuilder {
  nlohmann::json json = {{"asset", {{"version", "2.0"}}}};
  Bytes binary;

  template <typename T>
  std::uint32_t add_view(const std::vector<T>& values, std::uint32_t stride = 0) {
    const auto* first = reinterpret_cast<const std::uint8_t*>(values.data());
    return add_view(Bytes(first, first + values.size() * sizeof(T)), stride);
  }
  std::uint32_t add_view(const Bytes& bytes, std::uint32_t stride = 0);
  std::uint32_t add_accessor(std::uint32_t view, int component_type, std::string_view type,
                             std::size_t count, bool normalized = false);
  template <typename T>
  std::uint32_t add_accessor(const std::vector<T>& values, int component_type,
                             std::string_view type, std::size_t count) {
    return add_accessor(add_view(values), component_type, type, count);
  }
  /// Appends to a top-level array and returns the index.
  std::uint32_t add(const std::string& array, nlohmann::json value);
  /// Adds a root node with a mesh of this primitive to the only scene.
  void show(nlohmann::json primitive);
  std::uint32_t add_image(const Bytes& file);

  Bytes glb() const;
  Scene import(const ImportLimits& limits = {}, const SceneChoice& choice = {}) const;
};

/// One triangle in the plane z = 0, counter-clockwise seen from +Z, without normals.
GltfBuilder triangle();

/// A valid document for tests to damage: indexed, textured, lit, with a camera, a skin and an
/// animation.
GltfBuilder everything();

/// Uncompressed PNG; `channels` 1..4, `depth` 8 or 16 (big-endian samples).
Bytes png(std::uint32_t width, std::uint32_t height, int channels, const Bytes& samples,
          int depth = 8);
Bytes jpeg(std::uint32_t width, std::uint32_t height, const Bytes& rgb, bool progressive = false);

std::string base64(const Bytes& bytes);

constexpr ImportLimits strict_limits = {.strict_assets = true};

/// The import's error message, or "" when the file is accepted.
std::string refusal_of(const std::filesystem::path& path,
                       const ImportLimits& limits = strict_limits);
std::string refusal_of(const GltfBuilder& builder, const ImportLimits& limits = strict_limits);

}  // namespace heliograph::scene::test
