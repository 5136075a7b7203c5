#include "net/security/resource_limits.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace heliograph::net {
namespace {

namespace fs = std::filesystem;

class ResourceLimitsTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("resource_limits_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  void write(const fs::path& name, const std::string& text) {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text << "\n";
  }
  ResourceLimits limits() const { return read_resource_limits(folder_); }

 private:
  fs::path folder_;
};

TEST_F(ResourceLimitsTest, ReadsCgroupsVersion2) {
  write("memory.max", "1073741824");
  write("cpu.max", "150000 100000");
  EXPECT_EQ(limits().memory_bytes, 1073741824.0);
  EXPECT_EQ(limits().processors, 1.5);
}

TEST_F(ResourceLimitsTest, ReadsCgroupsVersion1) {
  write("memory/memory.limit_in_bytes", "536870912");
  write("cpu/cpu.cfs_quota_us", "50000");
  write("cpu/cpu.cfs_period_us", "100000");
  EXPECT_EQ(limits().memory_bytes, 536870912.0);
  EXPECT_EQ(limits().processors, 0.5);
}

TEST_F(ResourceLimitsTest, AreAbsentWithoutLimits) {
  write("memory.max", "max");
  write("cpu.max", "max 100000");
  EXPECT_FALSE(limits().memory_bytes);
  EXPECT_FALSE(limits().processors);
  write("memory/memory.limit_in_bytes", "9223372036854771712");
  write("cpu/cpu.cfs_quota_us", "-1");
  write("cpu/cpu.cfs_period_us", "100000");
  EXPECT_FALSE(limits().memory_bytes);
  EXPECT_FALSE(limits().processors);
}

TEST_F(ResourceLimitsTest, AreAbsentIfUnreadable) {
  EXPECT_FALSE(limits().memory_bytes);
  EXPECT_FALSE(limits().processors);
}

TEST(UsefulThreads, FollowTheQuota) {
  EXPECT_EQ(useful_threads({}, 64), 64u);
  EXPECT_EQ(useful_threads({.processors = 2.0}, 64), 2u);
  EXPECT_EQ(useful_threads({.processors = 1.5}, 64), 2u);
  EXPECT_EQ(useful_threads({.processors = 0.1}, 64), 1u);
  EXPECT_EQ(useful_threads({.processors = 8.0}, 4), 4u);
  EXPECT_EQ(useful_threads({.processors = 0.0}, 4), 1u);
  EXPECT_EQ(useful_threads({}, 0), 1u);  // the system does not tell
}

}  // namespace
}  // namespace heliograph::net
