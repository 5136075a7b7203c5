#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "gpu/device/device_choice.hpp"
#include "gpu/memory/image.hpp"
#include "gpu/pipelines/shader.hpp"

namespace heliograph::gpu {
namespace {

TEST(Check, ErrorNamesActionAndResult) {
  EXPECT_NO_THROW(check(VK_SUCCESS, "do something"));
  EXPECT_NO_THROW(check(VK_INCOMPLETE, "list things")) << "not an error";
  try {
    check(VK_ERROR_OUT_OF_DEVICE_MEMORY, "make a thing");
    FAIL();
  } catch (const GpuError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("make a thing"), std::string::npos) << text;
    EXPECT_NE(text.find(to_string(VK_ERROR_OUT_OF_DEVICE_MEMORY)), std::string::npos) << text;
  }
}

TEST(Formats, HaveTexelSize) {
  EXPECT_EQ(texel_bytes(VK_FORMAT_R32G32B32A32_SFLOAT), 16u);
  EXPECT_EQ(texel_bytes(VK_FORMAT_R16G16B16A16_SFLOAT), 8u);
  EXPECT_EQ(texel_bytes(VK_FORMAT_R32G32_SFLOAT), 8u);
  EXPECT_EQ(texel_bytes(VK_FORMAT_R32_SFLOAT), 4u);
  EXPECT_EQ(texel_bytes(VK_FORMAT_R32_UINT), 4u);
  EXPECT_EQ(texel_bytes(VK_FORMAT_R8G8B8A8_UNORM), 4u);
  EXPECT_EQ(texel_bytes(VK_FORMAT_R8G8B8A8_SRGB), 4u);
  EXPECT_THROW(texel_bytes(VK_FORMAT_BC7_UNORM_BLOCK), GpuError);
  EXPECT_TRUE(is_depth(VK_FORMAT_D32_SFLOAT));
  EXPECT_FALSE(is_depth(VK_FORMAT_R32_SFLOAT));
}

TEST(Formats, CompressedLevelsAreWholeBlocks) {
  EXPECT_EQ(level_bytes(VK_FORMAT_R8G8B8A8_SRGB, {5, 3}), 60u);
  EXPECT_EQ(level_bytes(VK_FORMAT_BC7_SRGB_BLOCK, {8, 4}), 32u);
  EXPECT_EQ(level_bytes(VK_FORMAT_BC7_UNORM_BLOCK, {5, 3}), 32u);
  EXPECT_EQ(level_bytes(VK_FORMAT_BC7_UNORM_BLOCK, {1, 1}), 16u);
  ImageDesc desc{.name = "levels", .extent = {8, 8}, .format = VK_FORMAT_BC7_UNORM_BLOCK};
  desc.levels = 4;
  EXPECT_EQ(packed_bytes(desc), 64u + 16u + 16u + 16u);
  desc.format = VK_FORMAT_R8G8B8A8_UNORM;
  desc.layers = 6;
  EXPECT_EQ(packed_bytes(desc), 6u * 4u * (64u + 16u + 4u + 1u));
}

TEST(Reflect, RejectsInvalidSpirv) {
  constexpr std::array<std::uint32_t, 4> words{1, 2, 3, 4};
  try {
    reflect({"broken.comp", words});
    FAIL();
  } catch (const GpuError& error) {
    EXPECT_NE(std::string(error.what()).find("broken.comp"), std::string::npos) << error.what();
  }
}

TEST(DriverFiles, ReportsEachErrorAndKeepsEnvironment) {
  const std::string broken = testing::TempDir() + "heliograph_driver.json";
  const std::string files = broken + ":/no/such/driver.json";
  std::ofstream(broken) << "{}";
  ::setenv("VK_DRIVER_FILES", files.c_str(), 1);
  const auto reports = examine_driver_files();
  EXPECT_EQ(std::getenv("VK_DRIVER_FILES"), files);
  ::unsetenv("VK_DRIVER_FILES");
  std::remove(broken.c_str());
  ASSERT_EQ(reports.size(), 2u);
  EXPECT_EQ(reports[0].file, broken);
  EXPECT_FALSE(reports[0].verdict.empty());
  EXPECT_EQ(reports[1].file, "/no/such/driver.json");
  EXPECT_NE(reports[1].verdict, reports[0].verdict);
}

TEST(DeviceTypes, HaveNames) {
  EXPECT_STREQ(type_name(VK_PHYSICAL_DEVICE_TYPE_CPU), "CPU");
  EXPECT_STRNE(type_name(VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU),
               type_name(VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU));
}

}  // namespace
}  // namespace heliograph::gpu
