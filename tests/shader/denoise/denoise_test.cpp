#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/shader/embedded.hpp"
#include "tests/shader/random_inputs.hpp"
#include "tests/support/compute_harness.hpp"

namespace heliograph::test {
namespace {

enum Function : std::uint32_t {
  depth,
  normal,
  luminance,
  roughness,
  taps,
  same_depth,
  same_normal,
  reinhard,
  paper_inverse,
  boxes,
  ycocg,
  variance_box,
  variance,
  shortened,
  sharp,
  fitted,
  reflector,
  edge,
  others
};

std::vector<ShaderOutput> call(Function function, const std::vector<ShaderInput>& inputs) {
  return ShaderFunctions(shaders::denoise).call(function, inputs);
}

/// A public denoiser raises e to the weight once more: edges bleed, equal pixels count e^-1.
TEST(DepthWeight, IsOneOnThePlaneAndFallsWithTheDistanceFromIt) {
  const glm::vec4 pixel(10.0f, 0.2f, -0.1f, 0.1f);
  std::vector<ShaderInput> inputs;
  for (int i = 0; i <= 50; ++i) {
    inputs.push_back({.a = pixel,
                      .b = {10.0f + 0.1f * static_cast<float>(i), 0.0f, 0.0f, 0.02f},
                      .c = glm::vec4(1.0f)});
  }
  auto got = call(depth, inputs);
  EXPECT_EQ(got[0].x.x, 1.0f) << "the pixel itself";
  for (std::size_t i = 0; i < inputs.size(); ++i) inputs[i].b.y = 2.0f;
  got = call(depth, inputs);
  int peak = 0;
  for (int i = 1; i <= 50; ++i) {
    if (got[i].x.x > got[peak].x.x) peak = i;
  }
  // 1/Z is linear: the plane's Z two pixels on is 10 / (1 - 0.4 / 10).
  EXPECT_NEAR(10.0 + 0.1 * peak, 10.0 / (1.0 - 0.04), 0.06);
  for (int i = peak + 1; i <= 50; ++i) EXPECT_LT(got[i].x.x, got[i - 1].x.x) << i;
  EXPECT_LT(got[50].x.x, 0.01f) << "an edge stops the filter";
}

TEST(DepthWeight, IsOneOnAnyPlaneInPerspective) {
  // z = 1 / (a + b x + c y)
  const double a = 0.1, b = 0.0007, c = -0.0011;
  std::vector<ShaderInput> inputs;
  RandomInputs random(1);
  for (int i = 0; i < 500; ++i) {
    const double x = std::floor(random.uniform(-20, 20)), y = std::floor(random.uniform(-20, 20));
    const double z = 1.0 / a, there = 1.0 / (a + b * x + c * y);
    inputs.push_back({.a = glm::vec4(z, -b * z * z, -c * z * z, 1.0 / z),
                      .b = glm::vec4(there, x, y, 0.01),
                      .c = glm::vec4(1.0f)});
  }
  for (const auto& output : call(depth, inputs)) EXPECT_GT(output.x.x, 0.99f);
}

TEST(DepthWeight, DoesNotDependOnTheScaleOfTheScene) {
  RandomInputs random(2);
  for (int i = 0; i < 20; ++i) {
    const ShaderInput one{.a = {5.0f, random.uniform(-0.3f, 0.3f), 0.1f, 0.2f},
                          .b = {5.0f + random.uniform(-0.5f, 0.5f), 2.0f, 1.0f, 0.01f},
                          .c = glm::vec4(1.0f)};
    std::vector<ShaderInput> inputs;
    for (const float scale : {1.0f, 0.01f, 100.0f}) {
      ShaderInput scaled = one;
      scaled.a *= glm::vec4(scale, scale, scale, 1.0f / scale);
      scaled.b *= glm::vec4(scale, 1.0f, 1.0f, scale);
      inputs.push_back(scaled);
    }
    const auto got = call(depth, inputs);
    EXPECT_NEAR(got[1].x.x, got[0].x.x, 1e-4f);
    EXPECT_NEAR(got[2].x.x, got[0].x.x, 1e-4f);
  }
}

TEST(EdgeWeight, IsTheExponentialUpToSixPercent) {
  std::vector<ShaderInput> inputs;
  for (int i = 0; i <= 2000; ++i) inputs.push_back({.a = {-0.04f * i, -std::log(2.0f) * i, 0, 0}});
  const auto got = call(edge, inputs);
  EXPECT_EQ(got[0].x.x, 1.0f) << "equal pixels";
  for (std::size_t i = 1; i < got.size(); ++i) {
    const double exact = std::exp(double(inputs[i].a.x)), half = std::exp(double(inputs[i].a.y));
    EXPECT_LT(got[i].x.x, got[i - 1].x.x);
    EXPECT_GE(got[i].x.x, exact * (1.0 - 2e-5));
    EXPECT_LE(got[i].x.x, exact * 1.0615);
    if (i >= 100) continue;
    EXPECT_NEAR(got[i].x.y, half, half * 2e-5) << "powers of two are exact";
  }
  const float nothing = -std::numeric_limits<float>::infinity();
  EXPECT_EQ(call(edge, {{.a = {-90.0f, nothing, 0, 0}}})[0].x, glm::vec4(0.0f));
}

TEST(NormalWeight, IsThePowerOfTheCosineToFirstOrder) {
  for (const float power : {8.0f, 128.0f, 1024.0f}) {
    std::vector<ShaderInput> inputs;
    for (int i = 0; i <= 1000; ++i) inputs.push_back({.a = {1.0f - 0.002f * i, power, 0, 0}});
    const auto got = call(normal, inputs);
    EXPECT_EQ(got[0].x.x, 1.0f);
    for (std::size_t i = 1; i < got.size(); ++i) {
      EXPECT_LE(got[i].x.x, got[i - 1].x.x);
      // The next order is exp(-x) x^2 / (2 power) of x = power (1 - cosine), at most at x = 2.
      const double cosine = std::max(double(inputs[i].a.x), 0.0);
      EXPECT_NEAR(got[i].x.x, std::pow(cosine, double(power)), 0.3 / power) << cosine;
    }
  }
}

/// With the weight 1 in the exponent where luminance counts nothing, the middle would weigh more.
TEST(LuminanceWeight, IsOneForEqualPixelsAndFallsWithTheDifference) {
  std::vector<ShaderInput> inputs;
  for (int i = 0; i <= 40; ++i) {
    inputs.push_back({.a = {0.5f, 0.2f, 0.5f + 0.05f * i, 0.2f}, .b = {0.1f, 0.1f, 4.0f, 1e-3f}});
  }
  inputs.push_back({.a = {0.5f, 0.5f, 0.5f, 0.6f}, .b = {0.0f, 0.0f, 4.0f, 1e-3f}});
  const auto got = call(luminance, inputs);
  EXPECT_EQ(got[0].x.x, 1.0f);
  for (int i = 1; i <= 40; ++i) {
    EXPECT_LT(got[i].x.x, got[i - 1].x.x);
    EXPECT_NEAR(got[i].x.x, std::exp(-0.05 * i / 0.401), 1e-5);
    EXPECT_EQ(got[i].x.y, 1.0f) << "each scalar by itself";
  }
  EXPECT_EQ(got[41].x.x, 1.0f) << "no noise, no difference";
  EXPECT_LT(got[41].x.y, 1e-6f) << "no noise, but a difference";
}

TEST(RoughnessWeight, IsOneForEqualsAndFalls) {
  const auto got =
      call(roughness,
           {{.a = {0.3f, 0.3f, 0, 0}}, {.a = {0.3f, 0.32f, 0, 0}}, {.a = {0.3f, 0.9f, 0, 0}}});
  EXPECT_EQ(got[0].x.x, 1.0f);
  EXPECT_LT(got[1].x.x, 1.0f);
  EXPECT_LT(got[2].x.x, 1e-3f);
}

TEST(HistoryTaps, OfAStaticPixelAreThatPixelExactly) {
  const auto got = call(taps, {{.a = {17.5f, 4.5f, 0, 0}, .b = glm::vec4(15.0f)}});
  EXPECT_EQ(got[0].x, glm::vec4(1, 0, 0, 0));
  EXPECT_EQ(glm::vec2(got[0].y), glm::vec2(17, 4));
}

TEST(HistoryTaps, AreBilinearAndRenormaliseOverValidTaps) {
  const glm::vec4 where(10.75f, 3.0f, 0, 0);  // a quarter right of 10.5, half below 2.5
  const auto got = call(taps, {{.a = where, .b = glm::vec4(15.0f)},
                               {.a = where, .b = glm::vec4(5.0f)},
                               {.a = where, .b = glm::vec4(0.0f)},
                               {.a = {10.501f, 3.5f, 0, 0}, .b = glm::vec4(2.0f)}});
  EXPECT_LE(glm::distance(got[0].x, glm::vec4(0.375f, 0.125f, 0.375f, 0.125f)), 1e-5f);
  EXPECT_EQ(glm::vec2(got[0].y), glm::vec2(10, 2));
  EXPECT_LE(glm::distance(got[1].x, glm::vec4(0.5f, 0, 0.5f, 0)), 1e-5f);
  EXPECT_EQ(got[2].x, glm::vec4(0.0f));
  EXPECT_EQ(got[3].x, glm::vec4(0.0f)) << "a thousandth of a tap is no history";
}

TEST(SameDepth, ToleranceFollowsTheSlopeAtAnyScale) {
  for (const float scale : {0.01f, 1.0f, 100.0f}) {
    const auto ask = [&](float expected, float found, float slope) {
      return ShaderInput{.a = glm::vec4(expected, found, slope, 0.0f) * scale,
                         .b = {0.02f * scale, 10.0f, 0, 0}};
    };
    const auto got = call(same_depth, {ask(10, 10.05f, 0), ask(10, 10.5f, 0), ask(10, 10.5f, 0.1f),
                                       ask(10, 11.5f, 0.1f), ask(10, 0.0f, 5.0f)});
    EXPECT_EQ(got[0].x.x, 1.0f) << scale;
    EXPECT_EQ(got[1].x.x, 0.0f) << "half a metre off a wall seen straight on";
    EXPECT_EQ(got[2].x.x, 1.0f) << "but well within a slanted one";
    EXPECT_EQ(got[3].x.x, 0.0f);
    EXPECT_EQ(got[4].x.x, 0.0f) << "background is no surface";
  }
}

TEST(SameNormal, RejectsBackFaces) {
  const glm::vec4 up(0, 0, 1, 0);
  const auto with = [&](const glm::vec3& found, float change, float tolerance) {
    return ShaderInput{.a = {up.x, up.y, up.z, change}, .b = glm::vec4(found, tolerance)};
  };
  const float small = glm::radians(4.0f), large = glm::radians(30.0f);
  const auto got =
      call(same_normal,
           {with({0, 0, 1}, 0, 16), with({std::sin(small), 0, std::cos(small)}, 0, 16),
            with({std::sin(large), 0, std::cos(large)}, 0, 16),
            with({std::sin(large), 0, std::cos(large)}, 0.05f, 16), with({0, 0, -1}, 10, 100)});
  EXPECT_EQ(got[0].x.x, 1.0f);
  EXPECT_EQ(got[1].x.x, 1.0f);
  EXPECT_EQ(got[2].x.x, 0.0f);
  EXPECT_EQ(got[3].x.x, 1.0f) << "curved surfaces turn";
  EXPECT_EQ(got[4].x.x, 0.0f);
}

TEST(Reinhard, RoundTripIsExactWithItsInverseAndNotWithThePapers) {
  RandomInputs random(3);
  std::vector<ShaderInput> inputs;
  for (int i = 0; i < 1000; ++i) {
    const float gain = std::pow(10.0f, random.uniform(-3, 2));
    inputs.push_back({.a = {gain * random.uniform(0, 1), gain * random.uniform(0, 1),
                            gain * random.uniform(0, 1), random.uniform(0.1f, 2.0f)}});
  }
  const auto got = call(reinhard, inputs), paper = call(paper_inverse, inputs);
  double off = 0.0;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const glm::vec3 color(inputs[i].a), back(got[i].y);
    EXPECT_LE(glm::distance(color, back), 1e-3f * glm::length(color) + 1e-6f) << i;
    const float bright = glm::dot(glm::vec3(got[i].x), glm::vec3(0.2126f, 0.7152f, 0.0722f));
    EXPECT_LT(bright * inputs[i].a.w, 1.0f);
    off = std::max<double>(off, glm::distance(color, glm::vec3(paper[i].x)) / glm::length(color));
  }
  EXPECT_GT(off, 0.3) << "the paper's way back shifts brightness";
}

TEST(RectificationBoxes, ClampEachChannelOrClipTowardTheCenter) {
  const auto got = call(boxes, {{.a = {-1, -1, -1, 0}, .b = {1, 1, 1, 0}, .c = {0.5f, -0.5f, 0, 0}},
                                {.a = {-1, -1, -1, 0}, .b = {1, 1, 1, 0}, .c = {4, 2, 0, 0}},
                                {.a = {2, 2, 2, 0}, .b = {2, 2, 2, 0}, .c = {4, 2, 0, 0}}});
  EXPECT_EQ(glm::vec3(got[0].x), glm::vec3(0.5f, -0.5f, 0));
  EXPECT_EQ(glm::vec3(got[0].y), glm::vec3(0.5f, -0.5f, 0));
  EXPECT_EQ(glm::vec3(got[1].x), glm::vec3(1, 1, 0));
  EXPECT_LE(glm::distance(glm::vec3(got[1].y), glm::vec3(1, 0.5f, 0)), 1e-6f) << "its hue stays";
  EXPECT_LE(glm::distance(glm::vec3(got[2].y), glm::vec3(2.0f)), 1e-5f) << "an empty box";
}

TEST(RectificationBoxes, VarianceBoxIsMeanPlusMinusScaledDeviation) {
  const auto got =
      call(variance_box,
           {{.a = {0, 1, 5, 0}, .b = {3, 1, 5, 0}, .c = {6, 1, 5, 0}, .d = glm::vec4(2.0f)}});
  const float reach = 2.0f * std::sqrt(6.0f);
  EXPECT_NEAR(got[0].x.x, 3.0f - reach, 1e-5);
  EXPECT_NEAR(got[0].y.x, 3.0f + reach, 1e-5);
  // The variance of equal values is what rounding leaves of two squares, and its root is wide.
  EXPECT_NEAR(got[0].x.y, 1.0f, 1e-3);
  EXPECT_NEAR(got[0].y.z, 5.0f, 5e-3);
}

TEST(Ycocg, RoundTripIsExact) {
  RandomInputs random(4);
  std::vector<ShaderInput> inputs{{.a = glm::vec4(0.7f)}};
  for (int i = 0; i < 200; ++i) {
    inputs.push_back({.a = {random.uniform(0, 9), random.uniform(0, 9), random.uniform(0, 9), 0}});
  }
  const auto got = call(ycocg, inputs);
  EXPECT_LE(glm::distance(glm::vec3(got[0].y), glm::vec3(0.7f, 0, 0)), 1e-6f) << "grey has no hue";
  for (std::size_t i = 0; i < got.size(); ++i) {
    EXPECT_LE(glm::distance(glm::vec3(got[i].x), glm::vec3(inputs[i].a)), 1e-5f);
  }
}

TEST(Moments, SampleVarianceIsUnbiased) {
  // 0 and 1 once each: mean 1/2, mean square 1/2, variance 1/2 with one degree of freedom.
  const auto got = call(variance, {{.a = {0.5f, 3.0f, 0.5f, 9.0f}, .b = {2, 10, 0, 0}},
                                   {.a = {1.0f, 1.0f, 0.9f, 1.0f}, .b = {1, 1, 0, 0}}});
  EXPECT_NEAR(got[0].x.x, 0.5f, 1e-6);
  EXPECT_EQ(got[0].x.y, 0.0f);
  EXPECT_EQ(got[1].x.x, 0.0f) << "never negative";
}

TEST(ShortenedHistory, IsUnchangedForUnmovedValuesAndOneFrameForFarOnes) {
  const auto got =
      call(shortened, {{.a = {32, 32, 0, 0}, .b = {0, 0.1f, 0, 0}, .c = glm::vec4(0.1f)},
                       {.a = {32, 1, 0, 0}, .b = {100, 100, 0, 0}, .c = glm::vec4(0.01f)}});
  EXPECT_EQ(got[0].x.x, 32.0f);
  EXPECT_NEAR(got[0].x.y, 16.0f, 1e-3);
  EXPECT_EQ(got[1].x.x, 1.0f);
  EXPECT_EQ(got[1].x.y, 1.0f);
}

TEST(VirtualMotion, DominantFactorIsOneForMirrorsAndZeroForRoughSurfaces) {
  std::vector<ShaderInput> inputs;
  for (int i = 0; i <= 20; ++i) inputs.push_back({.a = {0.05f * i, 0, 0, 0}});
  const auto got = call(others, inputs);
  EXPECT_EQ(got[0].x.x, 1.0f);
  EXPECT_NEAR(got[20].x.x, 0.0f, 1e-3);
  for (int i = 1; i <= 20; ++i) EXPECT_LE(got[i].x.x, got[i - 1].x.x + 0.02f);
}

TEST(VirtualMotion, ThresholdGrowsWithTheLobe) {
  const auto threshold = [](float pixels) {
    return call(fitted, {{.a = {pixels, 0, 0, 1}}})[0].x.x;
  };
  EXPECT_EQ(threshold(0.0f), 1.0f / 64.0f);
  EXPECT_EQ(threshold(15.0f), 0.25f);
  EXPECT_EQ(threshold(200.0f), 0.5f) << "pixels: half of what noisy hit distances cause";
}

TEST(VirtualMotion, HistoryGrowsWithTheLobe) {
  const auto frames = [](float pixels) { return call(fitted, {{.a = {pixels, 0, 0, 1}}})[0].x.y; };
  EXPECT_EQ(frames(0.0f), 0.0f);
  EXPECT_EQ(frames(0.25f), 0.0f) << "narrower lobes need no history";
  EXPECT_EQ(frames(1.25f), 8.0f);
  EXPECT_EQ(frames(4.25f), 32.0f);
}

TEST(VirtualMotion, SurfaceHistoryFallsWithTheSeparation) {
  const auto weight = [](float roughness, float pixels) {
    return call(fitted, {{.a = {0, roughness, pixels, 1}}})[0].x.z;
  };
  EXPECT_EQ(weight(0.5f, 0.0f), 1.0f);
  EXPECT_NEAR(weight(0.0f, 0.25f), std::exp(-1.0f), 1e-5) << "a quarter of a pixel on a mirror";
  EXPECT_NEAR(weight(0.5f, 16.25f), std::exp(-1.0f), 1e-5);
}

TEST(VirtualMotion, ReflectorIsComparedByNormalAndRoughness) {
  // a: cosine between the normals, roughness now, roughness before, change of normals in radians.
  const auto same = [](float cosine, float roughness, float previous, float change = 0.0f) {
    return call(reflector, {{.a = {cosine, roughness, previous, change}}})[0].x.x != 0.0f;
  };
  EXPECT_TRUE(same(0.9996f, 0.0f, 0.0f));
  EXPECT_FALSE(same(0.9994f, 0.0f, 0.0f));
  EXPECT_TRUE(same(0.951f, 1.0f, 1.0f));
  EXPECT_FALSE(same(0.949f, 1.0f, 1.0f));
  EXPECT_TRUE(same(0.985f, 0.0f, 0.0f, 0.1f)) << "on a curved reflector neighbours differ by 0.1";
  EXPECT_FALSE(same(0.975f, 0.0f, 0.0f, 0.1f));
  EXPECT_TRUE(same(1.0f, 0.0f, 0.049f));
  EXPECT_FALSE(same(1.0f, 0.0f, 0.051f));
  EXPECT_TRUE(same(1.0f, 0.4f, 0.54f));
  EXPECT_FALSE(same(1.0f, 0.4f, 0.56f));
}

TEST(Moments, HistoryLengthUnderMotion) {
  const auto frames = [](float motion) { return call(fitted, {{.a = {0, 0, 0, motion}}})[0].x.w; };
  EXPECT_EQ(frames(1.0f), 1.0f) << "a signal that moves by its own width has no history";
  EXPECT_NEAR(frames(0.125f), 1.0f + 0.63f * 3.0f, 1e-4);
  EXPECT_NEAR(frames(0.001f), 1.0f + 0.63f * 99.0f, 1e-2);
}

TEST(OutdatedFraction, IsBoundedAndZeroWithinThePercentiles) {
  // b: brightness, low, high, scale.
  const auto outdated = [](float old, float scale) {
    return call(fitted, {{.a = {0, 0, 0, 1}, .b = {old, 1, 2, scale}}})[0].y.x;
  };
  EXPECT_EQ(outdated(1.5f, 1.0f), 0.0f);
  EXPECT_NEAR(outdated(3.0f, 2.0f), 0.475f, 1e-5) << "half of the way";
  EXPECT_NEAR(outdated(100.0f, 2.0f), 0.95f, 1e-6);
}

TEST(CubicWeights, ReproducePixelsLinesAndParabolas) {
  for (const float f : {0.0f, 0.25f, 0.5f, 0.9f}) {
    const glm::vec4 w = call(sharp, {{.a = {f, 0, 0, 0}}})[0].x;
    EXPECT_NEAR(w.x + w.y + w.z + w.w, 1.0f, 1e-6);
    EXPECT_NEAR(-w.x + w.z + 2.0f * w.w, f, 1e-6) << "a straight line";
    EXPECT_NEAR(w.x + w.z + 4.0f * w.w, f * f, 1e-6) << "a parabola";
  }
  EXPECT_EQ(call(sharp, {{.a = glm::vec4(0.0f)}})[0].x, glm::vec4(0, 1, 0, 0));
}

TEST(CubicWeights, AddUpToOneWithoutTheCorners) {
  for (const float f : {0.0f, 0.25f, 0.5f, 0.9f}) {
    for (const float g : {0.0f, 0.4f, 0.5f}) {
      const auto got = call(sharp, {{.a = {f, g, 0, 0}}, {.a = {g, 0, 0, 0}}});
      const glm::vec4 x = got[0].x, y = got[1].x;
      const float corners = (x.x + x.w) * (y.x + y.w), scale = got[0].y.y;
      EXPECT_LE(std::abs(corners), 1.0f / 64.0f + 1e-6f);
      EXPECT_NEAR((1.0f - corners) * scale, 1.0f, 1e-6);
    }
  }
}

TEST(VirtualDistance, FollowsTheMirrorEquation) {
  // a: distance, curvature.
  const auto far = [](float distance, float curvature) {
    return call(sharp, {{.a = {distance, curvature, 0, 0}}})[0].y.x;
  };
  EXPECT_EQ(far(3.0f, 0.0f), 3.0f) << "flat";
  EXPECT_NEAR(far(1e6f, 0.5f), 1.0f, 1e-4) << "in the focus, half a radius behind a ball";
  EXPECT_NEAR(1.0f / far(3.0f, 0.25f), 1.0f / 3.0f + 0.5f, 1e-5);
  EXPECT_NEAR(1.0f / far(1.0f, -0.25f), 1.0f - 0.5f, 1e-5) << "a hollow mirror enlarges";
  EXPECT_EQ(far(2.0f, -3.0f), 8.0f) << "but never without bounds";
}

TEST(Sanitize, ReplacesNanAndInfinityByZero) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  const auto got =
      call(others, {{.b = {nan, 1, 2, 0}}, {.b = {inf, 1, 2, 0}}, {.b = {3, 1, 2, 0}}});
  EXPECT_EQ(got[0].x.z, 0.0f);
  EXPECT_EQ(got[1].x.z, 0.0f);
  EXPECT_EQ(got[2].x.z, 3.0f);
  EXPECT_EQ(glm::vec3(got[0].y), glm::vec3(0.0f));
  EXPECT_EQ(glm::vec3(got[2].y), glm::vec3(3, 1, 2));
}

}  // namespace
}  // namespace heliograph::test
