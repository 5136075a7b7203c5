#include "render/frame/buffer_list.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "render/api/buffer_names.hpp"
#include "render/views/view_colors.hpp"

namespace heliograph::render {
namespace {

using Rgb = std::array<int, 3>;

Rgb texel(const Frame& frame, std::size_t i) {
  return {frame.rgba[i * 4], frame.rgba[i * 4 + 1], frame.rgba[i * 4 + 2]};
}

/// A row of pixels.
FloatImage row(std::initializer_list<std::array<float, 4>> texels) {
  FloatImage image{static_cast<std::uint32_t>(texels.size()), 1, {}};
  for (const auto& t : texels) image.rgba.insert(image.rgba.end(), t.begin(), t.end());
  return image;
}

int brightness(const Rgb& c) {
  return 2 * c[0] + 5 * c[1] + c[2];
}

constexpr Rgb dark_blue{68, 1, 84}, yellow{253, 231, 37};

TEST(Heat, RunsFromDarkBlueToYellowMonotonically) {
  FloatImage ramp{101, 1, {}};
  for (int i = 0; i <= 100; ++i) {
    ramp.rgba.insert(ramp.rgba.end(), {static_cast<float>(i) / 100.0f, 0, 0, 1});
  }
  const Frame frame = colorize(ViewColors::fraction, ramp);
  EXPECT_EQ(texel(frame, 0), dark_blue);
  EXPECT_EQ(texel(frame, 100), yellow);
  for (std::size_t i = 1; i <= 100; ++i) {
    EXPECT_GE(brightness(texel(frame, i)), brightness(texel(frame, i - 1))) << i;
  }
}

TEST(Heat, OutlierDoesNotDimOtherPixels) {
  FloatImage image{100, 1, {}};
  for (int i = 0; i < 100; ++i)
    image.rgba.insert(image.rgba.end(), {i == 7 ? 1e6f : 2.0f, 0, 0, 1});
  EXPECT_EQ(texel(colorize(ViewColors::heat, image), 50), yellow);
}

TEST(Colors, DistancesAreLogarithmic) {
  const Frame frame = colorize(ViewColors::distance,
                               row({{1, 0, 0, 1}, {10, 0, 0, 1}, {100, 0, 0, 1}, {0, 0, 0, 1}}));
  EXPECT_EQ(texel(frame, 0), dark_blue);
  EXPECT_EQ(texel(frame, 3), (Rgb{0, 0, 0})) << "background";
  const Frame scaled = colorize(ViewColors::distance,
                                row({{7, 0, 0, 1}, {70, 0, 0, 1}, {700, 0, 0, 1}, {0, 0, 0, 1}}));
  EXPECT_EQ(frame.rgba, scaled.rgba) << "must be scale invariant";
}

TEST(Colors, NaNIsBlack) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const ViewColors colors :
       {ViewColors::output, ViewColors::radiance, ViewColors::squared, ViewColors::channels,
        ViewColors::grey, ViewColors::direction, ViewColors::octahedral, ViewColors::fraction,
        ViewColors::heat, ViewColors::distance, ViewColors::stops, ViewColors::pixels}) {
    EXPECT_EQ(texel(colorize(colors, row({{nan, nan, nan, nan}, {1, 1, 1, 1}})), 0), (Rgb{0, 0, 0}))
        << static_cast<int>(colors);
  }
}

TEST(Views, ColorsFollowTheKindOfBuffer) {
  const auto colors = [](std::string_view name) { return find_view(name).colors(); };
  EXPECT_EQ(colors("shadows.visibility"), ViewColors::grey);
  EXPECT_EQ(colors("gbuffer.normals"), ViewColors::octahedral);
  EXPECT_EQ(colors("gbuffer.normals.geometric"), ViewColors::octahedral);
  EXPECT_EQ(colors("gbuffer.motion.view_z"), ViewColors::distance);
  EXPECT_EQ(colors("specular.history_length"), ViewColors::heat);
  EXPECT_EQ(colors("visibility.blur.even"), ViewColors::channels);
  EXPECT_EQ(colors("hdr"), ViewColors::radiance);
}

TEST(Views, AspectNamesFindTheirBuffer) {
  for (const char* name : {"gbuffer.normals", "gbuffer.motion", "visibility.history_length"}) {
    const View buffer = find_view(name);
    ASSERT_TRUE(buffer) << name;
    EXPECT_EQ(buffer.aspect, nullptr);
    ASSERT_FALSE(aspect_names(*buffer.buffer).empty()) << name;
    for (const std::string& aspect : aspect_names(*buffer.buffer)) {
      const View view = find_view(aspect);
      ASSERT_TRUE(view.aspect) << aspect;
      EXPECT_EQ(view.buffer, buffer.buffer);
      EXPECT_FALSE(view.description().empty());
    }
  }
  EXPECT_FALSE(find_view("hdr.view_z"));
  EXPECT_FALSE(find_view("gbuffer.motion."));
  EXPECT_FALSE(find_view("gbuffer"));
}

TEST(Views, NamesAreUniqueAndDescribed) {
  std::set<std::string> names;
  for (const std::string& name : buffer_names()) {
    EXPECT_TRUE(names.insert(name).second) << name << " is there twice";
    EXPECT_GT(find_view(name).description().size(), 10u) << name;
  }
  EXPECT_GE(names.size(), 60u);
}

class Extract : public testing::Test {
 protected:
  Extract() {
    constants_.extent = {4, 2};
    constants_.inverse_view = constants_.unjittered = glm::mat4(1.0f);
    constants_.previous_unjittered = glm::mat4(1.0f);
    constants_.unproject = {1, 1, 0, 0};
    // Clip w is the distance along -Z: a camera of 90 degrees.
    for (glm::mat4* m : {&constants_.unjittered, &constants_.previous_unjittered}) {
      (*m)[2][3] = -1.0f;
      (*m)[3][3] = 0.0f;
    }
  }
  FloatImage extract_from(std::string_view view, const std::array<float, 4>& value) {
    FloatImage source{4, 2, {}};
    for (int i = 0; i < 8; ++i) source.rgba.insert(source.rgba.end(), value.begin(), value.end());
    return extract(find_view(view), source, {constants_, 2.0f});
  }
  shared::FrameConstants constants_{};
};

TEST_F(Extract, TakesChannelsOfAspect) {
  EXPECT_EQ(extract_from("gbuffer.motion.view_z", {1, 2, 3, 4}).rgba[0], 4.0f);
  EXPECT_EQ(extract_from("gbuffer.normals.geometric", {1, 2, 3, 4}).rgba[1], 4.0f);
  EXPECT_EQ(extract_from("gbuffer.surface.metallic", {1, 2, 3, 4}).rgba[0], 2.0f);
}

TEST_F(Extract, CameraMotionAloneIsNoError) {
  constants_.previous_unjittered[3][0] = 0.5f;  // the camera moved by half a metre
  const float uv = 0.5f / 2.0f * 0.5f;          // at two metres
  for (const float value : {0.0f, 1.0f}) {
    const FloatImage error = extract_from("gbuffer.motion.error", {uv + value / 4.0f, 0, 0, 2});
    for (std::size_t i = 0; i < error.rgba.size(); i += 4) {
      EXPECT_NEAR(error.rgba[i], value, 1e-5f) << "pixels";
    }
  }
  EXPECT_EQ(extract_from("gbuffer.motion.error", {0.3f, 0, 0, 0}).rgba[0], 0.0f) << "background";
}

TEST_F(Extract, StopsAreRelativeToExposedMiddleGray) {
  EXPECT_NEAR(extract_from("accumulated.stops", {0.09f, 0.09f, 0.09f, 1}).rgba[0], 0.0f, 1e-5f);
  EXPECT_NEAR(extract_from("accumulated.stops", {0.72f, 0.72f, 0.72f, 1}).rgba[0], 3.0f, 1e-5f);
}

}  // namespace
}  // namespace heliograph::render
