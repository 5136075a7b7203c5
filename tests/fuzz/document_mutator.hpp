#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace heliograph::fuzz {

/// Changes the bytes from `data` on, of which there are `size` and room for `most`; returns how
/// many there are then.
using MutateBytes = std::size_t (*)(std::uint8_t* data, std::size_t size, std::size_t most);

/// Changes a GLB file so that it stays one: a member of its document, the document's text, or the
/// binary data, with the lengths put right. Bytes that are no GLB file are changed as bytes.
std::size_t mutate_document(std::uint8_t* data, std::size_t size, std::size_t most,
                            std::mt19937& random, MutateBytes mutate_bytes);

}  // namespace heliograph::fuzz
