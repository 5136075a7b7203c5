#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace heliograph::jobs {

/// The CRC-32 of a file, as ZIP archives have it; nothing where it cannot be read.
std::optional<std::uint32_t> crc32_of(const std::filesystem::path& file);

}  // namespace heliograph::jobs
