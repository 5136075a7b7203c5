#pragma once

#include <cstdint>
#include <span>

namespace heliograph::scene {

/// Checks the attributes of all headers of an OpenEXR file before OpenEXR reads them: it makes room
/// for what an attribute claims before it looks whether there is so much, two gigabytes for a file
/// of 300 bytes, and takes the length of most types for granted, whatever the file says of it.
/// @throws ImportError
void check_exr_attributes(std::span<const std::uint8_t> file);

}  // namespace heliograph::scene
