#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

namespace heliograph::scene {

/// Lets tinygltf write a .glb of this document and binary chunk, of fewer than 2^32 bytes. It
/// writes the container only: of a model it would lose extensions that it does not know, as those
/// of buffer views, and members of "extras" that are no 32-bit integers.
void write_glb(std::ostream& out, const std::string& document,
               const std::vector<std::uint8_t>& binary);

}  // namespace heliograph::scene
