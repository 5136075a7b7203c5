#include "stream/encoders/npy_encoder.hpp"

#include <bit>
#include <stdexcept>
#include <string>

namespace heliograph::stream {
namespace {

static_assert(std::endian::native == std::endian::little);

struct ElementType {
  std::string_view name;
  std::size_t bytes;
};

ElementType type_of(NpyElement element) {
  switch (element) {
    case NpyElement::uint8:
      return {"|u1", 1};
    case NpyElement::uint32:
      return {"<u4", 4};
    case NpyElement::float32:
      return {"<f4", 4};
  }
  throw std::invalid_argument("npy: unknown element type");
}

}  // namespace

std::vector<std::uint8_t> encode_npy(NpyElement element, std::span<const std::uint32_t> shape,
                                     std::span<const std::byte> values) {
  const ElementType type = type_of(element);
  std::size_t bytes = type.bytes;
  std::string sides;
  for (const std::uint32_t side : shape) {
    bytes *= side;
    sides += std::to_string(side) + ", ";
  }
  if (bytes != values.size())
    throw std::invalid_argument("npy: the number of values does not match the shape");

  std::string header = "{'descr': '" + std::string(type.name) +
                       "', 'fortran_order': False, 'shape': (" + sides + "), }";
  // The values start at a multiple of 64 bytes; ten bytes precede the header.
  header.append((64 - (10 + header.size() + 1) % 64) % 64, ' ').push_back('\n');
  std::string file("\x93NUMPY\x01\x00", 8);
  file.push_back(static_cast<char>(header.size() & 0xff));
  file.push_back(static_cast<char>(header.size() >> 8));
  file += header;
  std::vector<std::uint8_t> result(file.begin(), file.end());
  const auto* const first = reinterpret_cast<const std::uint8_t*>(values.data());
  result.insert(result.end(), first, first + values.size());
  return result;
}

}  // namespace heliograph::stream
