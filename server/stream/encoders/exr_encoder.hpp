#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace heliograph::stream {

/// One channel of an OpenEXR image, row 0 on top: 32-bit floats or, with `counts`, unsigned
/// integers.
struct ExrChannel {
  std::string name;  // "R", or with a layer "normals.X"
  std::vector<float> values;
  bool counts = false;
};

/// A scan line OpenEXR file with lossless compression (ZIP). The same channels give the same bytes.
/// @param remarks text attributes of the file, by name
/// @throws std::runtime_error, also if a channel does not have width x height values
std::vector<std::uint8_t> encode_exr(
    std::uint32_t width, std::uint32_t height, const std::vector<ExrChannel>& channels,
    const std::vector<std::pair<std::string, std::string>>& remarks = {});

}  // namespace heliograph::stream
