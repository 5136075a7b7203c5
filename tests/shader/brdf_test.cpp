#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/shader/embedded.hpp"
#include "tests/shader/random_inputs.hpp"
#include "tests/support/brdf_reference.hpp"
#include "tests/support/compute_harness.hpp"

namespace heliograph::test {
namespace {

enum Function : std::uint32_t { distribution, visibility, fresnel, shading };
constexpr double pi = std::numbers::pi;

std::vector<ShaderOutput> call(Function function, const std::vector<ShaderInput>& inputs) {
  return ShaderFunctions(shaders::brdf).call(function, inputs);
}

TEST(Ggx, ProjectedAreaOfTheMicrofacetsIsOne) {
  for (const float alpha : {0.01f, 0.05f, 0.2f, 0.5f, 1.0f}) {
    std::vector<ShaderInput> inputs;
    for (int i = 0; i <= 8000; ++i) {
      // Cosines as the shader sees them, dense where narrow lobes are: tan from 1e-5 to 1e4.
      const double tan = std::pow(10.0, -5.0 + 9.0 * i / 8000.0);
      inputs.push_back({.a = {static_cast<float>(1.0 / std::sqrt(1.0 + tan * tan)), alpha, 0, 0}});
    }
    const auto got = call(distribution, inputs);
    // integral of D cos over the hemisphere = integral of pi D d(cos^2)
    double sum = 0.0;
    for (std::size_t i = 1; i < inputs.size(); ++i) {
      const double a = inputs[i - 1].a.x, b = inputs[i].a.x;
      sum += pi * 0.5 * (double(got[i - 1].x.x) + double(got[i].x.x)) * (a * a - b * b);
    }
    EXPECT_NEAR(sum, 1.0, 0.01) << "alpha " << alpha;
  }
}

TEST(Smith, IsTheHeightCorrelatedForm) {
  RandomInputs random(1);
  std::vector<ShaderInput> inputs;
  for (int i = 0; i < 5000; ++i) {
    inputs.push_back({.a = {random.uniform(0.01f, 1.0f), random.uniform(0.01f, 1.0f),
                            random.uniform(0.002f, 1.0f), 0.0f}});
  }
  const auto got = call(visibility, inputs);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const double expected = smith_visibility_reference(inputs[i].a.x, inputs[i].a.y, inputs[i].a.z);
    EXPECT_NEAR(got[i].x.x / expected, 1.0, 1e-4) << i;
  }
}

TEST(Fresnel, RunsFromF0ToOne) {
  const glm::vec3 f0(0.04f, 0.5f, 1.0f);
  const auto got =
      call(fresnel,
           {{.a = glm::vec4(f0, 1.0f)}, {.a = glm::vec4(f0, 0.0f)}, {.a = glm::vec4(f0, 0.5f)}});
  EXPECT_LE(glm::distance(glm::vec3(got[0].x), f0), 1e-6f);
  EXPECT_LE(glm::distance(glm::vec3(got[1].x), glm::vec3(1.0f)), 1e-6f);
  EXPECT_NEAR(got[2].x.x, 0.04f + 0.96f / 32.0f, 1e-6f);
}

glm::vec3 upper(RandomInputs& random) {
  glm::vec3 v = random.unit_vector();
  v.z = std::max(std::abs(v.z), 0.02f);
  return glm::normalize(v);
}

glm::vec4 split_sum(double n_dot_v, double roughness) {
  return {glm::vec2(split_sum_reference(n_dot_v, roughness)), 0.0f, 0.0f};
}

TEST(ShadeLight, MatchesTheReferenceImplementation) {
  RandomInputs random(4);
  std::vector<ShaderInput> inputs;
  for (int i = 0; i < 60; ++i) {
    const float roughness = random.uniform(0.1f, 1.0f), grey = random.uniform(0.0f, 1.0f);
    const glm::vec3 v = upper(random), l = upper(random);
    inputs.push_back({.a = glm::vec4(glm::vec3(grey), random.uniform(0.0f, 1.0f)),
                      .b = glm::vec4(v, roughness),
                      .c = glm::vec4(l, 0.0f),
                      .d = split_sum(v.z, roughness)});
  }
  const auto got = call(shading, inputs);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const auto& [a, b, c, d] = inputs[i];
    const double expected = shade_light_reference(a.x, a.w, b.w, glm::vec3(b), glm::vec3(c));
    EXPECT_NEAR(got[i].x.x, expected, 1e-3 * expected + 1e-6) << i;
  }
}

// What multiple scattering gives back depends on the view alone, like the diffuse light that the
// specular lobe leaves. Without it (a split sum of one) light and view may be exchanged.
TEST(ShadeLight, IsReciprocalButForMultipleScattering) {
  RandomInputs random(2);
  const glm::vec4 nothing_lost(1, 0, 0, 0);
  std::vector<ShaderInput> there, back;
  for (int i = 0; i < 5000; ++i) {
    const glm::vec4 color(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1),
                          random.uniform(0, 1));
    const float roughness = random.uniform(0.0f, 1.0f);
    const glm::vec3 v = upper(random), l = upper(random);
    there.push_back({color, glm::vec4(v, roughness), glm::vec4(l, 0.0f), nothing_lost});
    back.push_back({color, glm::vec4(l, roughness), glm::vec4(v, 0.0f), nothing_lost});
  }
  const auto one = call(shading, there), other = call(shading, back);
  for (std::size_t i = 0; i < there.size(); ++i) {
    // Without the cosine of the light, exchanging light and view changes nothing.
    const glm::vec3 a = glm::vec3(one[i].x) / there[i].c.z;
    const glm::vec3 b = glm::vec3(other[i].x) / back[i].c.z;
    EXPECT_LE(glm::distance(a, b), 1e-3f * (glm::length(a) + 1e-3f)) << i;
  }
}

/// Light that a white surface sends to a viewer under a sky of radiance 1: an integral over half
/// the hemisphere, in steps that shrink toward the plane of the reflected view, where lobes are
/// thin.
double albedo(float metallic, float roughness, float view_cosine) {
  constexpr int rings = 192, sectors = 192;
  const glm::vec3 view(std::sqrt(1.0f - view_cosine * view_cosine), 0.0f, view_cosine);
  const glm::vec4 split = split_sum(view_cosine, roughness);
  std::vector<ShaderInput> inputs;
  std::vector<double> solid_angles;
  for (int r = 0; r < rings; ++r) {
    for (int s = 0; s < sectors; ++s) {
      const double cosine = (r + 0.5) / rings, x = (s + 0.5) / sectors;
      const double sine = std::sqrt(1.0 - cosine * cosine), angle = pi * (1.0 - x * x * x);
      inputs.push_back({.a = glm::vec4(1.0f, 1.0f, 1.0f, metallic),
                        .b = glm::vec4(view, roughness),
                        .c = glm::vec4(sine * std::cos(angle), sine * std::sin(angle), cosine, 0),
                        .d = split});
      solid_angles.push_back(2.0 * pi * 3.0 * x * x / (rings * sectors));
    }
  }
  const auto got = call(shading, inputs);
  double sum = 0.0;
  for (std::size_t i = 0; i < inputs.size(); ++i) sum += got[i].x.x * solid_angles[i];
  return sum;
}

TEST(ShadeLight, WhiteFurnaceConservesEnergy) {
  for (const float metallic : {0.0f, 0.5f, 1.0f}) {
    for (const float roughness : {0.3f, 0.5f, 0.75f, 1.0f}) {
      for (const float view_cosine : {1.0f, 0.7f, 0.3f, 0.1f}) {
        EXPECT_NEAR(albedo(metallic, roughness, view_cosine), 1.0, 0.01)
            << metallic << " " << roughness << " " << view_cosine;
      }
    }
  }
}

TEST(ShadeLight, IsZeroBelowTheHorizon) {
  const auto got = call(shading, {{.a = glm::vec4(1, 1, 1, 0),
                                   .b = glm::vec4(0, 0, 1, 0.5f),
                                   .c = glm::vec4(0.6f, 0, -0.8f, 0),
                                   .d = split_sum(1.0, 0.5)}});
  EXPECT_EQ(glm::vec3(got[0].x), glm::vec3(0.0f));
}

}  // namespace
}  // namespace heliograph::test
