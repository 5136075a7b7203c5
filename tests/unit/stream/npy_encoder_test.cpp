#include "stream/encoders/npy_encoder.hpp"

#include <gtest/gtest.h>

#include <array>
#include <stdexcept>
#include <string>

namespace heliograph::stream {
namespace {

TEST(Npy, HasTheHeaderOfTheFormatAndTheValues) {
  const std::array values{1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f};
  const std::array shape{3u, 2u};
  const auto file = encode_npy(NpyElement::float32, shape, std::as_bytes(std::span(values)));
  ASSERT_EQ(file.size() % 64, sizeof values);
  const std::string text(file.begin(), file.end() - sizeof values);
  EXPECT_EQ(text.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  EXPECT_EQ(static_cast<std::size_t>(file[8] | file[9] << 8), text.size() - 10);
  EXPECT_NE(text.find("{'descr': '<f4', 'fortran_order': False, 'shape': (3, 2, ), }"),
            std::string::npos);
  EXPECT_EQ(text.back(), '\n');
  EXPECT_EQ(std::string(file.end() - 4, file.end()), std::string("\x00\x00\xc0\x40", 4));
}

TEST(Npy, RefusesValuesThatDoNotMatchTheShape) {
  const std::array<std::byte, 5> values{};
  const std::array shape{2u, 3u};
  EXPECT_THROW(encode_npy(NpyElement::uint8, shape, values), std::invalid_argument);
}

}  // namespace
}  // namespace heliograph::stream
