#pragma once

#include <cstdint>
#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

#include "scene/source_file.hpp"

namespace heliograph::scene {

/// The only folder a scene file may read from, with one byte budget for everything read.
/// Regular files only; symbolic links are followed as long as they stay inside.
class ConfinedFolder {
 public:
  ConfinedFolder(const std::filesystem::path& folder, std::uint64_t byte_budget);
  /// No folder: every file is missing.
  ConfinedFolder() = default;

  /// Reads `relative` (already percent-decoded, '/' separated).
  /// @throws ImportError naming `relative` when it leaves the folder, is missing or exceeds the
  /// budget
  std::vector<std::uint8_t> read(const std::string& relative, const std::stop_token& stop = {});

  /// Bytes of the file at `relative`, which is not read. @throws ImportError as read() does
  std::uint64_t size_of(const std::string& relative) const;

  /// The files read, as they were before reading.
  const std::vector<SourceFile>& files() const { return files_; }

 private:
  /// Where the file lies. @throws ImportError
  std::filesystem::path resolve(const std::string& relative) const;

  std::filesystem::path root_;
  std::uint64_t budget_ = 0;
  std::vector<SourceFile> files_;
};

/// Reads a whole regular file of at most `max_bytes`. `label` stands for it in errors.
/// @throws ImportError, LoadCancelled
std::vector<std::uint8_t> read_regular_file(const std::filesystem::path& path,
                                            std::uint64_t max_bytes, const std::string& label,
                                            const std::stop_token& stop = {});

}  // namespace heliograph::scene
