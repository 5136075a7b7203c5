#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "net/download/content.hpp"

namespace heliograph::net {

struct ZipEntry {
  std::string name;  // UTF-8, with '/' between folders
  std::filesystem::path file;
  std::uint64_t bytes = 0;
  std::uint32_t crc = 0;  // CRC-32 of the file
};

/// A ZIP archive of files as they are, without compression: images and videos are compressed
/// already. It is never written anywhere: its size and every byte are known before the files are
/// read, so that it can be sent at once, with its length, and in parts. Larger ones than 4 GiB or
/// 65,535 files use ZIP64 (APPNOTE.TXT 6.3.10, section 4.3). `seconds`: the time of the files,
/// since 1970.
Content zip_archive(const std::vector<ZipEntry>& entries, double seconds);

}  // namespace heliograph::net
