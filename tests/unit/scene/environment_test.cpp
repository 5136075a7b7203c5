#include "scene/environment.hpp"

#include <gtest/gtest.h>

#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene::test {
namespace {

void append(Bytes& bytes, std::string_view text) {
  bytes.insert(bytes.end(), text.begin(), text.end());
}

Bytes header(std::string_view size) {
  Bytes file;
  append(file, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n");
  append(file, size);
  append(file, "\n");
  return file;
}

// 16 x 2 pixels in new-style run length encoding: the upper row radiance 1, the lower 0.5 red.
Bytes small_environment() {
  Bytes file = header("-Y 2 +X 16");
  for (int row = 0; row < 2; ++row) {
    file.insert(file.end(), {2, 2, 0, 16});
    const std::uint8_t other = row == 0 ? 128 : 0;
    const std::uint8_t exponent = row == 0 ? 129 : 128;
    for (const std::uint8_t value : {std::uint8_t(128), other, other, exponent}) {
      file.insert(file.end(), {128 + 16, value});
    }
  }
  return file;
}

std::string refusal(const Bytes& file) {
  const TemporaryFolder folder;
  try {
    load_environment(folder.write("sky.hdr", file));
  } catch (const ImportError& error) {
    return error.what();
  }
  return "";
}

TEST(Environment, ReadsLinearRadianceFromTopRow) {
  const TemporaryFolder folder;
  const Environment environment = load_environment(folder.write("sky.hdr", small_environment()));
  ASSERT_EQ(environment.width, 16u);
  ASSERT_EQ(environment.height, 2u);
  EXPECT_EQ(environment.radiance[0], glm::vec3(1.0f));
  EXPECT_EQ(environment.radiance[31], glm::vec3(0.5f, 0.0f, 0.0f));
}

TEST(Environment, ReadsUncompressedAndOldRunLengthEncodedRows) {
  Bytes file = header("-Y 2 +X 5");
  for (int x = 0; x < 5; ++x) file.insert(file.end(), {128, 0, 64, 129});
  file.insert(file.end(), {64, 128, 0, 130, 1, 1, 1, 3, 0, 0, 0, 0});
  const TemporaryFolder folder;
  const Environment environment = load_environment(folder.write("sky.hdr", file));
  EXPECT_EQ(environment.radiance[4], glm::vec3(1.0f, 0.0f, 0.5f));
  for (int x = 0; x < 4; ++x) EXPECT_EQ(environment.radiance[5 + x], glm::vec3(1.0f, 2.0f, 0.0f));
  EXPECT_EQ(environment.radiance[9], glm::vec3(0.0f));
}

TEST(Environment, RejectsRunsBeyondRow) {
  const Bytes good = small_environment();
  const std::size_t first_row = header("-Y 2 +X 16").size() + 4;
  for (const std::uint8_t code : {128 + 17, 17, 0}) {
    Bytes file = good;
    file[first_row] = code;
    EXPECT_NE(refusal(file), "") << int(code);
  }
  Bytes repeat_of_nothing = header("-Y 1 +X 4");
  repeat_of_nothing.insert(repeat_of_nothing.end(), {1, 1, 1, 4});
  EXPECT_NE(refusal(repeat_of_nothing), "");
}

TEST(Environment, RejectsTruncatedData) {
  const Bytes file = small_environment();
  for (std::size_t size = 0; size < file.size(); ++size) {
    EXPECT_NE(refusal(Bytes(file.begin(), file.begin() + size)), "")
        << size << " of " << file.size();
  }
}

TEST(Environment, RejectsEmptyAndOversizedImages) {
  for (const char* size : {"-Y 0 +X 0", "-Y 0 +X 16", "-Y 2 +X 0", "-Y -2 +X -2", "-Y 4097 +X 16",
                           "-Y 2 +X 8193", "-Y 2000000000 +X 2000000000", "nonsense"}) {
    Bytes file = header(size);
    file.resize(file.size() + 1000);
    EXPECT_NE(refusal(file), "") << size;
  }
}

TEST(Environment, RejectsOtherFileFormats) {
  EXPECT_NE(refusal({}), "");
  EXPECT_NE(refusal(png(2, 2, 3, Bytes(12, 1))).find("not a Radiance"), std::string::npos);
  EXPECT_THROW(load_environment("/nonexistent/sky.hdr"), ImportError);
  EXPECT_THROW(load_environment("/dev/zero"), ImportError);
}

TEST(Environment, ConstantEnvironmentIsUniform) {
  const Environment furnace = constant_environment({1, 2, 3});
  ASSERT_EQ(furnace.radiance.size(), std::size_t(furnace.width) * furnace.height);
  for (const glm::vec3& texel : furnace.radiance) EXPECT_EQ(texel, glm::vec3(1, 2, 3));
}

}  // namespace
}  // namespace heliograph::scene::test
