#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace heliograph::fuzz {

/// Mutates `size` bytes at `data`, which has room for `most`; returns the new size.
using MutateBytes = std::size_t (*)(std::uint8_t* data, std::size_t size, std::size_t most);

/// Mutates a GLB file and keeps its structure valid: a member of its document, the document's text
/// or the binary data, with corrected lengths. Other bytes are mutated as they are.
std::size_t mutate_document(std::uint8_t* data, std::size_t size, std::size_t most,
                            std::mt19937& random, MutateBytes mutate_bytes);

}  // namespace heliograph::fuzz
