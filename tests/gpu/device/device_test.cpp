#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "gpu/device/device_lost.hpp"
#include "gpu/frame_plan/frame_plan.hpp"
#include "tests/gpu/embedded.hpp"
#include "tests/support/engine.hpp"

namespace heliograph::gpu {
namespace {

const ShaderBinding& binding(const Reflection& reflection, const std::string& name) {
  for (const ShaderBinding& found : reflection.bindings) {
    if (found.name == name) return found;
  }
  throw std::out_of_range(name);
}

TEST(Reflection, ListsBindingsSortedBySetAndBinding) {
  const Reflection reflection = reflect(test::shaders::resources);
  ASSERT_EQ(reflection.bindings.size(), 6u);
  for (std::size_t i = 1; i < reflection.bindings.size(); ++i) {
    const ShaderBinding &a = reflection.bindings[i - 1], &b = reflection.bindings[i];
    EXPECT_LT(std::pair(a.set, a.binding), std::pair(b.set, b.binding));
  }
  EXPECT_EQ(reflection.constants_size, 20u);
  EXPECT_EQ(reflection.local_size.width, 4u);
  EXPECT_EQ(reflection.local_size.height, 2u);
  EXPECT_EQ(reflection.local_size.depth, 3u);
}

TEST(Reflection, ReportsTypesFormatsAndAccess) {
  const Reflection reflection = reflect(test::shaders::resources);
  const ShaderBinding& image = binding(reflection, "half_image");
  EXPECT_EQ(image.type, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
  EXPECT_EQ(image.format, VK_FORMAT_R16G16B16A16_SFLOAT);
  EXPECT_FALSE(image.reads);
  EXPECT_TRUE(image.writes);
  const ShaderBinding& sampled = binding(reflection, "sampled");
  EXPECT_EQ(sampled.type, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER);
  EXPECT_FALSE(sampled.writes);
  EXPECT_EQ(reflection.bindings[0].type, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER);
  EXPECT_EQ(reflection.bindings[0].set, 0u);
  const auto access = [&](std::uint32_t number) {
    for (const ShaderBinding& found : reflection.bindings) {
      if (found.set == pass_set && found.binding == number)
        return std::pair(found.reads, found.writes);
    }
    return std::pair(false, false);
  };
  EXPECT_EQ(access(1), std::pair(true, false)) << "readonly buffer";
  EXPECT_EQ(access(5), std::pair(false, true)) << "writeonly buffer";
  EXPECT_EQ(access(7), std::pair(true, true)) << "buffer";
}

/// Makes the next submission fail with a lost device during its lifetime.
class InjectedDeviceLoss {
 public:
  InjectedDeviceLoss()
      : file_(std::filesystem::temp_directory_path() / "heliograph_injected_loss") {
    std::ofstream(file_).put(' ');
    setenv("HELIOGRAPH_TEST_DEVICE_LOSS", file_.c_str(), 1);
  }
  ~InjectedDeviceLoss() {
    unsetenv("HELIOGRAPH_TEST_DEVICE_LOSS");
    std::filesystem::remove(file_);
  }
  InjectedDeviceLoss(const InjectedDeviceLoss&) = delete;
  InjectedDeviceLoss& operator=(const InjectedDeviceLoss&) = delete;

 private:
  std::filesystem::path file_;
};

// The validation layers report objects that outlive their device.
TEST(DeviceLoss, LeaksNoVulkanObjects) {
  const char* const wanted = std::getenv("HELIOGRAPH_TEST_DEVICE");
  const Instance instance(true);
  {
    const Device device(instance, {.name_part = wanted ? wanted : "", .cache_folder = {}});
    const InjectedDeviceLoss loss;
    EXPECT_THROW(Image(device, {.name = "image", .extent = {8, 8}, .format = VK_FORMAT_R8_UNORM}),
                 DeviceLost);
  }
  EXPECT_EQ(instance.validation_messages(), 0u);
}

TEST(Program, ErrorNamesMissingDescriptorSet) {
  try {
    const ComputeProgram program(test::device(), test::shaders::resources);
    FAIL() << "set 0 is missing";
  } catch (const GpuError& error) {
    EXPECT_NE(std::string(error.what()).find("resources.comp"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("set 0 binding 4"), std::string::npos) << error.what();
  }
}

TEST(DeviceSurvey, ChoosesOneDeviceAndGivesReasonForOthers) {
  const Instance instance(false);
  const auto reports = survey_devices(instance, "");
  ASSERT_FALSE(reports.empty());
  EXPECT_EQ(std::count_if(reports.begin(), reports.end(), [](const auto& r) { return r.chosen; }),
            1);
  for (const DeviceReport& report : reports) {
    EXPECT_FALSE(report.name.empty());
    EXPECT_FALSE(report.driver.empty());
    EXPECT_FALSE(report.reason.empty());
    EXPECT_TRUE(!report.chosen || report.missing.empty());
  }
}

TEST(DeviceSurvey, UnknownDeviceNameIsRejected) {
  const Instance instance(false);
  const auto reports = survey_devices(instance, "no such device");
  for (const DeviceReport& report : reports) EXPECT_FALSE(report.chosen);
  try {
    const Device device(instance, {"no such device", {}});
    FAIL() << "there is no such device";
  } catch (const GpuError& error) {
    EXPECT_NE(std::string(error.what()).find("no such device"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find(reports[0].name), std::string::npos) << error.what();
  }
}

TEST(DeviceSurvey, MatchesNamesCaseInsensitively) {
  const Instance instance(false);
  std::string name = survey_devices(instance, "")[0].name.substr(0, 4);
  for (char& c : name) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  const auto reports = survey_devices(instance, name);
  EXPECT_TRUE(std::any_of(reports.begin(), reports.end(), [](const auto& r) { return r.chosen; }));
}

TEST(Device, WritesPipelineCacheAndLeaksNoObjects) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(testing::TempDir()) / "heliograph_pipeline_cache";
  fs::remove_all(folder);
  Instance instance(true);
  for (int run = 0; run < 2; ++run) {
    const Device device(instance, {"", folder});
    const ComputeProgram program(device, test::shaders::add);
    FramePlan plan(device, {8, 8});
    const auto a = plan.image("a", VK_FORMAT_R32_SFLOAT), b = plan.image("b", VK_FORMAT_R32_SFLOAT);
    plan.pass("add", program).read(a).write(b).constants(1.0f).dispatch({8, 8});
    plan.compile();
    plan.execute();
  }
  // The validation layers report objects that outlive their device.
  EXPECT_EQ(instance.validation_messages(), 0u);
  ASSERT_TRUE(fs::exists(folder));
  EXPECT_FALSE(fs::is_empty(folder));
  fs::remove_all(folder);
}

TEST(Device, CountsValidationMessages) {
  Instance instance(true);
  const Device device(instance, {});
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;  // of size 0, which is not valid
  VkBuffer buffer = VK_NULL_HANDLE;
  vkCreateBuffer(device.handle(), &info, nullptr, &buffer);
  vkDestroyBuffer(device.handle(), buffer, nullptr);
  EXPECT_GE(instance.validation_messages(), 1u) << "validation layers are not active";
}

TEST(Image, UploadDownloadRoundTrip) {
  for (const bool mapped : {false, true}) {
    if (mapped && !test::device().is_cpu()) continue;
    ImageDesc desc{.name = "image", .extent = {7, 5}, .format = VK_FORMAT_R32_SFLOAT};
    desc.mapped = mapped;
    const Image image(test::device(), desc);
    std::vector<float> values(35);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i) * 0.5f;
    image.upload(std::as_bytes(std::span(values)));
    const auto bytes = image.download();
    ASSERT_EQ(bytes.size(), 35 * sizeof(float));
    EXPECT_EQ(std::memcmp(bytes.data(), values.data(), bytes.size()), 0);
    if (mapped) {
      EXPECT_EQ(image.host().row<float>(3)[2], values[3 * 7 + 2]);
    }
    image.clear();
    for (const std::byte byte : image.download()) ASSERT_EQ(byte, std::byte{0});
  }
}

}  // namespace
}  // namespace heliograph::gpu
