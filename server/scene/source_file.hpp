#pragma once

#include <cstdint>
#include <filesystem>

namespace heliograph::scene {

/// A file as it was when it was read.
struct SourceFile {
  std::filesystem::path path;
  std::uint64_t bytes = 0;
  std::int64_t modified = 0;  // nanoseconds since 1970
  std::uint64_t inode = 0;

  bool operator==(const SourceFile&) const = default;
};

/// The file as it is now; no bytes, no time and no inode where there is none.
SourceFile examine_file(const std::filesystem::path& path);

}  // namespace heliograph::scene
