#pragma once

#include <cstdint>
#include <filesystem>

namespace heliograph::scene {

/// Identity of a file at the time of reading.
struct SourceFile {
  std::filesystem::path path;
  std::uint64_t bytes = 0;
  std::int64_t modified = 0;  // nanoseconds since 1970
  std::uint64_t inode = 0;

  bool operator==(const SourceFile&) const = default;
};

/// Current identity of a file; all members are 0 where it does not exist.
SourceFile examine_file(const std::filesystem::path& path);

}  // namespace heliograph::scene
