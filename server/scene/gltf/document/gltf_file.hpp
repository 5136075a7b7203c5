#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "scene/confined_folder.hpp"
#include "scene/gltf/document/container.hpp"
#include "scene/gltf/schema/document_check.hpp"
#include "scene/import_error.hpp"
#include "scene/import_limits.hpp"
#include "scene/warnings.hpp"

namespace heliograph::scene {

struct BufferView {
  std::span<const std::uint8_t> bytes;
  std::uint32_t stride = 0;  // bytes; 0: tightly packed
};

/// A glTF document with its bytes, in three steps: every member is checked against the table of
/// `schema.hpp`, tinygltf parses what has passed, and buffer views are unpacked. tinygltf alone
/// narrows numbers and replaces values of a wrong type. Files of images in the binary chunk of a
/// .glb are read on demand, straight to where they stay.
class GltfFile {
 public:
  /// Whether the whole document stays, with what no table lists.
  enum class Document { dropped, kept };

  /// @throws ImportError, LoadCancelled
  GltfFile(const std::filesystem::path& path, const ImportLimits& limits, Warnings& warnings,
           const std::stop_token& stop, Document document = Document::dropped);
  /// A file that is alone: others that it refers to are missing. @throws ImportError, LoadCancelled
  GltfFile(RegularFile file, const ImportLimits& limits, Warnings& warnings,
           const std::stop_token& stop);
  GltfFile(const GltfFile&) = delete;
  GltfFile& operator=(const GltfFile&) = delete;

  /// Valid as long as this object. References have been checked, but not what they refer to.
  const tinygltf::Model& model() const { return model_; }
  const std::vector<BufferView>& views() const { return views_; }
  /// The file of an image within a view. @throws ImportError, LoadCancelled
  std::vector<std::uint8_t> image_file(std::uint32_t view) const;
  /// Frees what was read for views, unless files of images are among it: accessors are not read any
  /// more.
  void drop_views();
  /// Bytes behind the "uri" of the object at `place`: base64 data or a file beside the scene.
  /// @throws ImportError
  std::vector<std::uint8_t> resource(const std::string& place);
  /// About how many these are, without reading them; 0 where they cannot be read.
  std::uint64_t resource_bytes(const std::string& place) const;
  /// The "uri" of the object at `place`, unless it was base64 data that resource() has returned.
  const std::string& address(const std::string& place) const { return document_.uris.at(place); }
  /// The file itself and all files read with it, as they were before reading.
  std::vector<SourceFile> sources() const;

  /// The whole document once, where it is kept, with empty addresses.
  nlohmann::json take_document();
  /// Whether a view uses a buffer that has data.
  bool has_data(std::size_t buffer) const { return document_.buffers_with_data[buffer]; }
  std::uint64_t buffer_bytes(std::size_t buffer) const { return document_.buffer_lengths[buffer]; }
  /// All bytes of a buffer with data, also those that nothing reads; `to` is as long.
  /// @throws ImportError, LoadCancelled
  void copy_buffer(std::size_t buffer, std::span<std::uint8_t> to) const;

 private:
  GltfFile(SourceFile self, ConfinedFolder folder, RegularFile file, const ImportLimits& limits,
           Warnings& warnings, const std::stop_token& stop, Document document);
  CheckedDocument read_document(const ImportLimits& limits, Warnings& warnings, Document document);
  void read_buffers();
  /// The bytes that views of the binary chunk need, less the files of images.
  void read_binary(std::span<std::uint8_t> bytes) const;
  void read_views(const ImportLimits& limits);
  BufferView read_view(std::size_t index, std::uint64_t& unpacked_budget);

  std::stop_token stop_;
  SourceFile self_;
  ConfinedFolder folder_;
  Container container_;
  std::shared_ptr<nlohmann::json> whole_;  // where it is kept
  CheckedDocument document_;
  tinygltf::Model model_;
  /// Of a buffer. What nothing reads of the binary chunk is not written, and takes no memory.
  struct Bytes {
    std::vector<std::uint8_t> file;
    std::unique_ptr<std::uint8_t[]> binary;
    std::span<const std::uint8_t> all;
  };
  std::vector<Bytes> buffers_;
  std::vector<bool> image_views_;  // in the binary chunk
  std::vector<std::vector<std::uint8_t>> unpacked_views_;
  std::vector<BufferView> views_;
};

}  // namespace heliograph::scene
