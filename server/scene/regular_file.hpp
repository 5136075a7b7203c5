#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace heliograph::scene {

/// An open regular file of a known size, read in parts.
class RegularFile {
 public:
  /// `label` stands for the file in errors. @throws ImportError
  RegularFile(const std::filesystem::path& path, std::uint64_t max_bytes, std::string label);
  ~RegularFile();
  RegularFile(const RegularFile&) = delete;
  RegularFile& operator=(const RegularFile&) = delete;

  std::uint64_t size() const { return size_; }
  /// Fills `bytes`, which lie within the file, from `offset`. @throws ImportError
  void read(std::uint64_t offset, std::span<std::uint8_t> bytes) const;

 private:
  std::string label_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace heliograph::scene
