#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <stop_token>
#include <string>

#include "scene/regular_file.hpp"

namespace heliograph::scene {

/// A .glb or .gltf file. Of a .glb only the headers and the document are read at once; its binary
/// chunk is read straight to where it is used, so that there is no second copy.
class Container {
 public:
  /// @throws ImportError
  explicit Container(RegularFile file);

  /// The document's text, once.
  std::string take_text() { return std::move(text_); }
  bool has_binary() const { return binary_bytes_ != 0; }
  std::uint64_t binary_bytes() const { return binary_bytes_; }
  /// Fills `bytes`, which lie within the binary chunk, from `offset`.
  /// @throws ImportError, LoadCancelled
  void read_binary(std::uint64_t offset, std::span<std::uint8_t> bytes,
                   const std::stop_token& stop) const;

 private:
  void read_chunks();
  std::string read_text(std::uint64_t offset, std::uint64_t bytes) const;
  std::uint32_t read_word(std::uint64_t offset) const;

  RegularFile file_;
  std::string text_;
  std::uint64_t binary_offset_ = 0;
  std::uint64_t binary_bytes_ = 0;
};

}  // namespace heliograph::scene
