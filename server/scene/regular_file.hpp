#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

namespace heliograph::scene {

/// An open regular file of a known size, read in parts.
class RegularFile {
 public:
  /// `label` stands for the file in errors. @throws ImportError
  RegularFile(const std::filesystem::path& path, std::uint64_t max_bytes, std::string label);
  /// The same of a file that is open already; takes the descriptor over.
  RegularFile(int descriptor, std::uint64_t max_bytes, std::string label);
  ~RegularFile();
  RegularFile(RegularFile&& other) noexcept;
  RegularFile(const RegularFile&) = delete;
  RegularFile& operator=(const RegularFile&) = delete;

  std::uint64_t size() const { return size_; }
  /// Fills `bytes`, which lie within the file, from `offset`. @throws ImportError, LoadCancelled
  void read(std::uint64_t offset, std::span<std::uint8_t> bytes,
            const std::stop_token& stop = {}) const;

 private:
  std::string label_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

/// All bytes of it. @throws ImportError, LoadCancelled
std::vector<std::uint8_t> read_all(const RegularFile& file, const std::stop_token& stop = {});

}  // namespace heliograph::scene
