#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace heliograph::gpu {

/// SPIR-V words of one shader stage and the name of its source file.
struct ShaderBinary {
  std::string_view name;
  std::span<const std::uint32_t> words;
};

}  // namespace heliograph::gpu
