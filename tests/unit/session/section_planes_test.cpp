#include "session/edits/section_planes.hpp"

#include <gtest/gtest.h>

namespace heliograph::session {
namespace {

TEST(SectionPlanes, HasUnitNormalsOfWhatIsEnabled) {
  SectionPlanes planes;
  ASSERT_TRUE(planes.set({.planes = {{.normal = {0, 3, 4}, .offset = 2.0f},
                                     {.normal = {1, 0, 0}, .offset = 1.0f, .enabled = false}},
                          .cap_color = {1, 0, 0}}));
  EXPECT_EQ(planes.get().planes[0].normal, (protocol::Vec3{0.0f, 0.6f, 0.8f}));
  ASSERT_TRUE(planes.enabled());
  EXPECT_EQ(planes.enabled()->planes, std::vector{glm::vec4(0.0f, 0.6f, 0.8f, 2.0f)});
  EXPECT_EQ(planes.enabled()->cap_color, glm::vec3(1, 0, 0));
}

TEST(SectionPlanes, AreNoneWhereAllAreSwitchedOff) {
  SectionPlanes planes;
  ASSERT_TRUE(planes.set({.planes = {{.normal = {1, 0, 0}, .enabled = false}}}));
  EXPECT_FALSE(planes.enabled());
  EXPECT_EQ(planes.get().planes.size(), 1u);
}

TEST(SectionPlanes, ARefusedNormalChangesNothing) {
  SectionPlanes planes;
  ASSERT_TRUE(planes.set({.planes = {{.normal = {1, 0, 0}, .offset = 0.5f}}}));
  const auto before = planes.enabled();
  const auto refused =
      planes.set({.planes = {{.normal = {1, 0, 0}}, {.normal = {0, 0, 0}}}}, "edits.section.");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().path, "edits.section.planes[1].normal");
  EXPECT_EQ(planes.enabled(), before);
}

}  // namespace
}  // namespace heliograph::session
