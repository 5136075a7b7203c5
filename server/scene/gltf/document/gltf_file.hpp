#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "scene/confined_folder.hpp"
#include "scene/gltf/document/json_value.hpp"
#include "scene/import_error.hpp"
#include "scene/import_limits.hpp"

namespace heliograph::scene {

struct BufferView {
  std::span<const std::uint8_t> bytes;
  std::uint32_t stride = 0;  // bytes; 0: tightly packed
};

struct Buffer {
  std::span<const std::uint8_t> bytes;  // empty: placeholder of a compressed view
  std::uint64_t length = 0;
};

/// A glTF document with its bytes: container, buffers and buffer views are read and checked, asset
/// version and required extensions accepted. No loader library is used: each value is checked where
/// it is read, before any narrowing, and a rejected file costs no more than its parsing.
class GltfFile {
 public:
  /// @throws ImportError
  GltfFile(const std::filesystem::path& path, const ImportLimits& limits);
  ~GltfFile();
  GltfFile(const GltfFile&) = delete;
  GltfFile& operator=(const GltfFile&) = delete;

  /// The document. Valid as long as this object.
  JsonValue root() const;
  const std::vector<BufferView>& views() const { return views_; }
  /// Bytes behind a "uri" member: base64 data or a file beside the scene. @throws ImportError
  std::vector<std::uint8_t> resource(const JsonValue& owner);
  /// The file itself and all files read with it, as they were before reading.
  std::vector<SourceFile> sources() const;
  /// Extensions in use that are ignored.
  const std::vector<std::string>& ignored_extensions() const { return ignored_extensions_; }

 private:
  void read_container(const std::vector<std::uint8_t>& file, const ImportLimits& limits);
  void check_asset() const;
  void check_extensions();
  void read_buffers();
  void read_views(const ImportLimits& limits);
  BufferView read_view(const JsonValue& view, std::uint64_t& unpacked_budget);

  SourceFile self_;
  ConfinedFolder folder_;
  std::vector<std::uint8_t> file_;
  std::span<const std::uint8_t> binary_chunk_;
  std::unique_ptr<nlohmann::json> json_;
  std::vector<std::vector<std::uint8_t>> loaded_buffers_;
  std::vector<std::vector<std::uint8_t>> unpacked_views_;
  std::vector<Buffer> buffers_;
  std::vector<BufferView> views_;
  std::vector<std::string> ignored_extensions_;
};

}  // namespace heliograph::scene
