#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/image/image_size.hpp"
#include "scene/image/ktx2/huffman.hpp"

namespace heliograph::scene::ktx2 {

/// Decodes images of ETC1S blocks that share codebooks (KTX 2.0, "BasisLZ/ETC1S Bitstream").
class Etc1sDecoder {
 public:
  /// The parts of the file's global data. @throws ImportError
  Etc1sDecoder(std::uint32_t endpoint_count, std::span<const std::uint8_t> endpoints,
               std::uint32_t selector_count, std::span<const std::uint8_t> selectors,
               std::span<const std::uint8_t> tables);

  /// Decodes a slice into RGBA8: its colours, or its green channel into alpha. @throws ImportError
  enum class Channels { color, alpha };
  void decode(std::span<const std::uint8_t> slice, ImageSize size, Channels channels,
              std::span<std::uint8_t> rgba) const;

 private:
  struct Endpoint {
    std::uint8_t red = 0;
    std::uint8_t green = 0;
    std::uint8_t blue = 0;
    std::uint8_t intensity = 0;
  };
  using Selector = std::array<std::uint8_t, 4>;  // a row each, two bits a texel

  struct Tables {
    HuffmanCode endpoint_prediction;
    HuffmanCode endpoint_delta;
    HuffmanCode selector;
    HuffmanCode selector_run;
    std::uint32_t history_size;
  };
  class SliceReader;

  static std::vector<Endpoint> read_endpoints(std::uint32_t count,
                                              std::span<const std::uint8_t> bytes);
  static std::vector<Selector> read_selectors(std::uint32_t count,
                                              std::span<const std::uint8_t> bytes);
  static Tables read_tables(std::span<const std::uint8_t> bytes);
  static void draw(const Endpoint& endpoint, const Selector& selector, std::uint32_t left,
                   std::uint32_t top, ImageSize size, Channels channels,
                   std::span<std::uint8_t> rgba);

  std::vector<Endpoint> endpoints_;
  std::vector<Selector> selectors_;
  Tables tables_;
};

}  // namespace heliograph::scene::ktx2
