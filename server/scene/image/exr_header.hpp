#pragma once

#include <cstdint>
#include <span>

namespace heliograph::scene {

/// Checks the attributes of all headers of an OpenEXR file before OpenEXR reads them: OpenEXR
/// allocates what an attribute claims before it checks the file's size (2 GiB for a file of 300
/// bytes), and ignores the claimed length of most types.
/// @throws ImportError
void check_exr_attributes(std::span<const std::uint8_t> file);

}  // namespace heliograph::scene
