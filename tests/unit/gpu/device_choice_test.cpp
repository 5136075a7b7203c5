#include <gtest/gtest.h>

#include "gpu/device/several_devices.hpp"

namespace heliograph::gpu {
namespace {

using Names = std::vector<std::string>;

DeviceReport report(const char* name, VkPhysicalDeviceType type) {
  DeviceReport made;
  made.name = name;
  made.type = type;
  return made;
}

const DeviceReport gpu = report("Graphics 100", VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU);
const DeviceReport small_gpu = report("Graphics 5", VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU);
const DeviceReport processor = report("llvmpipe (LLVM 15, 256 bits)", VK_PHYSICAL_DEVICE_TYPE_CPU);

TEST(DeviceChoice, AllMeansEveryGpu) {
  EXPECT_EQ(choose_devices({processor, small_gpu, gpu, gpu}, {"all"}), (Names{"#1", "#2", "#3"}));
}

TEST(DeviceChoice, AllMeansTheProcessorWhereThereIsNoGpu) {
  EXPECT_EQ(choose_devices({processor}, {"all"}), Names{"#1"});
}

TEST(DeviceChoice, AllLeavesOutWhatWillNotDo) {
  DeviceReport old = gpu;
  old.missing = {"Vulkan 1.3"};
  EXPECT_EQ(choose_devices({old, gpu}, {"all"}), Names{"#1"});
  EXPECT_EQ(choose_devices({old}, {"all"}), Names{""}) << "the engine tells what is missing";
}

TEST(DeviceChoice, ANameMeansAnotherOfSeveralDevicesEachTime) {
  EXPECT_EQ(choose_devices({gpu, processor, gpu}, {"GRAPHICS", "100", "graphics"}),
            (Names{"GRAPHICS#1", "100#2", "graphics#1"}));
}

TEST(DeviceChoice, ANumberMeansThatDevice) {
  EXPECT_EQ(choose_devices({gpu, gpu}, {"Graphics#2", "Graphics", "Graphics#1"}),
            (Names{"Graphics#2", "Graphics#1", "Graphics#1"}));
}

TEST(DeviceChoice, OneDeviceMayBeMeantSeveralTimes) {
  EXPECT_EQ(choose_devices({processor}, {"llvmpipe", "LLVM 15"}),
            (Names{"llvmpipe#1", "LLVM 15#1"}));
}

TEST(DeviceChoice, AnUnknownNameStaysForTheError) {
  EXPECT_EQ(choose_devices({processor}, {"llvmpipe", "nothing"}), (Names{"llvmpipe#1", "nothing"}));
}

}  // namespace
}  // namespace heliograph::gpu
