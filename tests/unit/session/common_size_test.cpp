#include "session/viewers/common_size.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace heliograph::session {
namespace {

constexpr FrameSize most{3840, 2160};

TEST(CommonSize, IsThatOfASingleViewer) {
  for (const FrameSize size : {FrameSize{973, 611}, FrameSize{390, 844}, FrameSize{1, 7}}) {
    EXPECT_EQ(common_size(std::array{size}, most), size);
    EXPECT_EQ(common_size(std::array{size, size}, most), size);
  }
}

TEST(CommonSize, HasTheWidestShapeAndTheMostPixels) {
  EXPECT_EQ(common_size(std::array{FrameSize{390, 844}, FrameSize{1280, 720}}, most),
            (FrameSize{1280, 720}));
  const FrameSize both = common_size(std::array{FrameSize{800, 1000}, FrameSize{640, 320}}, most);
  EXPECT_EQ(both, (FrameSize{1265, 632}));
}

TEST(CommonSize, KeepsItsShapeWithinTheLimits) {
  const FrameSize size = common_size(std::array{FrameSize{2000, 2160}, FrameSize{3840, 100}}, most);
  EXPECT_EQ(size, (FrameSize{3840, 100}));
}

}  // namespace
}  // namespace heliograph::session
