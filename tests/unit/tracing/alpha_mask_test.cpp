#include "tracing/bvh/alpha_mask.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/traced_scene.hpp"

namespace heliograph::tracing {
namespace {

using test::plain_material;

shared::Material with_flags(std::uint32_t flags) {
  shared::Material material = plain_material();
  material.flags = flags;
  return material;
}

TEST(CoverAlike, TellsWhatAStructureDependsOn) {
  const std::vector plain{with_flags(0)};
  const std::vector double_sided{with_flags(shared::material_double_sided)};
  std::vector blended{with_flags(shared::material_alpha_blend)};
  blended[0].base_color.w = 0.5f;
  std::vector red = plain;
  red[0].base_color = {1, 0, 0, 1};
  EXPECT_TRUE(cover_alike(plain, red));
  EXPECT_FALSE(cover_alike(plain, double_sided));
  EXPECT_FALSE(cover_alike(blended, blended)) << "rays look up the mask";
  EXPECT_FALSE(cover_alike(plain, std::vector{plain[0], plain[0]}));
}

}  // namespace
}  // namespace heliograph::tracing
