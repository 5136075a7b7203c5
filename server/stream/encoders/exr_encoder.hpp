#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace heliograph::stream {

/// One channel of an OpenEXR picture, row 0 on top: 32-bit floats, or whole numbers from 0.
struct ExrChannel {
  std::string name;  // "R", or of a layer: "normals.X"
  std::vector<float> values;
  bool counts = false;
};

/// A scan line OpenEXR file, compressed without loss (ZIP). The same channels give the same bytes.
/// @param remarks text attributes of the file, by name
/// @throws std::runtime_error, also where a channel is not of the picture's size
std::vector<std::uint8_t> encode_exr(
    std::uint32_t width, std::uint32_t height, const std::vector<ExrChannel>& channels,
    const std::vector<std::pair<std::string, std::string>>& remarks = {});

}  // namespace heliograph::stream
