#include "jobs/checksum.hpp"

#include <zlib.h>

#include <fstream>
#include <vector>

namespace heliograph::jobs {

std::optional<std::uint32_t> crc32_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return std::nullopt;
  std::vector<char> buffer(256 * 1024);
  uLong crc = crc32(0, nullptr, 0);
  while (stream) {
    stream.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    crc = crc32(crc, reinterpret_cast<const Bytef*>(buffer.data()),
                static_cast<uInt>(stream.gcount()));
  }
  if (stream.bad()) return std::nullopt;
  return static_cast<std::uint32_t>(crc);
}

}  // namespace heliograph::jobs
