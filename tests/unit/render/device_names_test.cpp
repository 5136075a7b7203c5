#include <gtest/gtest.h>

#include "render/api/devices.hpp"

namespace heliograph::render {
namespace {

using Names = std::vector<std::string>;

TEST(DeviceNames, AreSeparatedByCommas) {
  EXPECT_EQ(device_names("H100, llvmpipe,all"), (Names{"H100", "llvmpipe", "all"}));
}

TEST(DeviceNames, ACommaInParenthesesBelongsToTheName) {
  EXPECT_EQ(device_names("llvmpipe (LLVM 15.0.6, 256 bits),llvmpipe"),
            (Names{"llvmpipe (LLVM 15.0.6, 256 bits)", "llvmpipe"}));
}

TEST(DeviceNames, EmptyOnesMeanNoDevice) {
  EXPECT_EQ(device_names(""), Names());
  EXPECT_EQ(device_names(" , ,"), Names());
}

}  // namespace
}  // namespace heliograph::render
