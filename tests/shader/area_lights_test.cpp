#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "render/resources/tables/fit_ltc/lobe.hpp"
#include "tests/shader/embedded.hpp"
#include "tests/shader/random_inputs.hpp"
#include "tests/support/compute_harness.hpp"

namespace heliograph::test {
namespace {

constexpr double pi = std::numbers::pi;
enum Function : std::uint32_t { shares, sampling };

struct AreaLight {
  glm::vec3 position;
  glm::vec3 direction;
  glm::vec3 tangent;
  float half_width;
  float half_height = 0.0f;  // 0: a disk

  bool disk() const { return half_height == 0.0f; }
  glm::vec3 bitangent() const { return glm::cross(direction, tangent); }
  double area() const {
    return disk() ? pi * half_width * half_width : 4.0 * half_width * half_height;
  }
  ShaderInput input(const glm::vec4& rest) const {
    const auto type = disk() ? shared::light_disk : shared::light_rectangle;
    return {glm::vec4(position, type), glm::vec4(direction, half_width),
            glm::vec4(tangent, half_height), rest};
  }
  glm::dvec3 point(double u, double v) const {
    if (disk()) {
      const double radius = half_width * std::sqrt(u);
      return glm::dvec3(position) + radius * std::cos(2.0 * pi * v) * glm::dvec3(tangent) +
             radius * std::sin(2.0 * pi * v) * glm::dvec3(bitangent());
    }
    return glm::dvec3(position) + half_width * (2.0 * u - 1.0) * glm::dvec3(tangent) +
           half_height * (2.0 * v - 1.0) * glm::dvec3(bitangent());
  }
};

/// Shines straight down from `height`.
AreaLight ceiling(float height, float half_width, float half_height) {
  return {{0, 0, height}, {0, 0, -1}, {1, 0, 0}, half_width, half_height};
}

AreaLight random_light(RandomInputs& random, bool disk) {
  AreaLight light;
  light.position = 3.0f * random.unit_vector();
  light.position.z = std::abs(light.position.z) + 0.3f;
  const glm::vec3 aside = random.unit_vector();
  light.direction = glm::normalize(-light.position + aside);
  light.tangent = glm::normalize(glm::cross(light.direction, random.unit_vector()));
  light.half_width = random.uniform(0.2f, 1.5f);
  light.half_height = disk ? 0.0f : random.uniform(0.2f, 1.5f);
  return light;
}

/// The device's FrameRig has the table.
std::vector<ShaderOutput> call(Function function, const std::vector<ShaderInput>& inputs) {
  SceneBuilder builder;
  const FrameRig rig(builder.build(), look({0, 0, 3}, {0, 0, 0}));
  return ShaderFunctions(shaders::area_lights, &rig).call(function, inputs);
}

glm::vec4 eye_at(float degrees, float roughness, float azimuth = 0.0f) {
  const float angle = glm::radians(degrees);
  return {std::sin(angle) * std::cos(azimuth), std::sin(angle) * std::sin(azimuth), std::cos(angle),
          roughness};
}

TEST(AreaLights, LightOverTheWholeHemisphereFillsBothLobes) {
  std::vector<ShaderInput> inputs;
  for (const float roughness : {0.03f, 0.1f, 0.3f, 0.6f, 1.0f}) {
    for (const float degrees : {0.0f, 20.0f, 45.0f, 70.0f, 85.0f}) {
      inputs.push_back(ceiling(1.0f, 1e5f, 1e5f).input(eye_at(degrees, roughness, 1.0f)));
      inputs.push_back(ceiling(1.0f, 1e5f, 0.0f).input(eye_at(degrees, roughness, 2.0f)));
    }
  }
  const auto got = call(shares, inputs);
  for (std::size_t i = 0; i < got.size(); ++i) {
    EXPECT_NEAR(got[i].x.x, 1.0f, 1e-3f) << i;
    EXPECT_NEAR(got[i].x.y, 1.0f, 5e-3f) << i;
  }
}

TEST(AreaLights, EmitToTheFrontOnly) {
  AreaLight light = ceiling(1.0f, 1.0f, 1.0f);
  light.direction = {0, 0, 1};
  const auto got = call(shares, {light.input(eye_at(30, 0.5f))});
  EXPECT_EQ(glm::vec2(got[0].x), glm::vec2(0.0f));
}

// Howell's catalogue of configuration factors, B-3 and B-12.
TEST(AreaLights, DiffuseLightIsTheFormFactor) {
  const float height = 1.5f, a = 0.7f, b = 2.0f, radius = 0.8f;
  const auto got = call(shares, {ceiling(height, a, b).input(eye_at(30, 0.5f)),
                                 ceiling(height, radius, 0.0f).input(eye_at(30, 0.5f))});
  const double x = a / height, y = b / height;
  const double corner = (x / std::hypot(1, x) * std::atan(y / std::hypot(1, x)) +
                         y / std::hypot(1, y) * std::atan(x / std::hypot(1, y))) /
                        (2.0 * pi);
  EXPECT_NEAR(got[0].x.x, 4.0 * corner, 1e-5);
  // Sixteen corners stand for the disk.
  EXPECT_NEAR(got[1].x.x, radius * radius / (radius * radius + height * height), 2e-4);
}

/// Fractions by integrating over the light's area.
glm::dvec2 integrated(const AreaLight& light, const glm::vec4& eye) {
  const ltc::SpecularLobe lobe(glm::dvec3(eye), std::pow(double(eye.w), 2.0));
  double albedo = 0.0;
  constexpr int strata = 400;
  glm::dvec2 sum(0.0);
  for (int i = 0; i < strata * strata; ++i) {
    const double u = (i % strata + 0.5) / strata, v = (i / strata + 0.5) / strata;
    const glm::dvec3 mirrored = lobe.sample(u, v);
    if (mirrored.z > 0.0) albedo += lobe(mirrored) / lobe.density(mirrored) / (strata * strata);
    const glm::dvec3 point = light.point(u, v);
    const double squared = glm::dot(point, point);
    const glm::dvec3 direction = point / std::sqrt(squared);
    const double facing = -glm::dot(direction, glm::dvec3(light.direction));
    if (facing <= 0.0 || direction.z <= 0.0) continue;
    const double weight = facing * light.area() / squared / (strata * strata);
    sum += weight * glm::dvec2(direction.z / pi, lobe(direction));
  }
  return {sum.x, sum.y / albedo};
}

TEST(AreaLights, BothLobesMatchNumericalIntegrationForAnyPlacement) {
  RandomInputs random(5);
  std::vector<AreaLight> lights;
  std::vector<ShaderInput> inputs;
  std::vector<glm::vec4> eyes;
  for (int i = 0; i < 60; ++i) {
    lights.push_back(random_light(random, i % 3 == 0));
    if (i % 4 == 1) lights.back().position.z = 0.1f;  // cut by the horizon
    const float roughness = std::array{0.1f, 0.2f, 0.4f, 0.7f, 1.0f}[i % 5];
    eyes.push_back(eye_at(random.uniform(0, 80), roughness, random.uniform(0, 6)));
    inputs.push_back(lights.back().input(eyes.back()));
  }
  const auto got = call(shares, inputs);
  double total = 0.0, apart = 0.0, signed_apart = 0.0;
  for (std::size_t i = 0; i < got.size(); ++i) {
    const glm::dvec2 expected = integrated(lights[i], eyes[i]);
    EXPECT_NEAR(got[i].x.x, expected.x, 1e-3 + 0.01 * expected.x) << i;
    EXPECT_NEAR(got[i].x.y, expected.y, 0.03) << i << " roughness " << eyes[i].w;
    total += expected.y;
    apart += std::abs(got[i].x.y - expected.y);
    signed_apart += got[i].x.y - expected.y;
  }
  RecordProperty("specular_error", std::to_string(apart / total));
  std::printf("specular: mean error %.4f, bias %.4f of the light\n", apart / total,
              signed_apart / total);
  EXPECT_LT(apart / total, 0.06);
}

TEST(AreaLights, SamplesAverageToTheFormFactorAndLieOnTheLight) {
  RandomInputs random(7);
  for (int light_index = 0; light_index < 8; ++light_index) {
    AreaLight light = random_light(random, light_index == 0);
    if (light_index >= 5) light.position *= 0.3f;  // seen under a large angle
    if (light_index == 4) light.position *= 20.0f;
    std::vector<ShaderInput> inputs;
    constexpr int strata = 64;
    for (int i = 0; i < strata * strata; ++i) {
      inputs.push_back(light.input({(i % strata + random.uniform(0, 1)) / strata,
                                    (i / strata + random.uniform(0, 1)) / strata, 0, 0}));
    }
    const auto got = call(sampling, inputs);
    double sum = 0.0;
    for (const ShaderOutput& s : got) {
      if (s.y.x <= 0.0f) continue;
      const glm::vec3 direction(s.x);
      const glm::vec3 offset = direction * s.x.w - light.position;
      ASSERT_NEAR(glm::length(direction), 1.0f, 1e-4f);
      ASSERT_LE(std::abs(glm::dot(offset, light.direction)), 2e-3f * s.x.w) << light_index;
      ASSERT_LE(std::abs(glm::dot(offset, light.tangent)), light.half_width + 2e-3f * s.x.w);
      sum += s.y.x * std::max(direction.z, 0.0f) / pi / got.size();
    }
    const double expected = integrated(light, eye_at(0, 1.0f)).x;
    EXPECT_NEAR(sum, expected, 2e-3 + 0.01 * expected) << light_index;
  }
}

TEST(AreaLights, RectanglesAreSampledEvenlyOverTheSolidAngle) {
  const AreaLight light{{0.4f, -0.2f, 0.5f}, {0, 0, -1}, {1, 0, 0}, 1.2f, 0.8f};
  RandomInputs random(11);
  std::vector<ShaderInput> inputs;
  for (int i = 0; i < 40000; ++i) {
    inputs.push_back(light.input({random.uniform(0, 1), random.uniform(0, 1), 0, 0}));
  }
  const auto got = call(sampling, inputs);
  // The solid angle of the part left of and below a point, by the four arc tangents of a rectangle
  // seen from above its corner (its derivative is the density that the samples must have).
  const auto corner = [](double x, double y) {
    const double h = 0.5;
    return std::atan(x * y / (h * std::sqrt(h * h + x * x + y * y)));
  };
  const auto part = [&](double x0, double x1, double y0, double y1) {
    return corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0);
  };
  const double whole = part(-0.8, 1.6, -1.0, 0.6);
  EXPECT_NEAR(got[0].y.x, whole, 1e-3 * whole);
  constexpr int cells = 8;
  std::vector<double> counts(cells * cells, 0.0);
  for (const ShaderOutput& s : got) {
    const glm::vec3 at = glm::vec3(s.x) * s.x.w;
    const int x = std::clamp(static_cast<int>((at.x + 0.8f) / 2.4f * cells), 0, cells - 1);
    const int y = std::clamp(static_cast<int>((at.y + 1.0f) / 1.6f * cells), 0, cells - 1);
    ++counts[y * cells + x];
  }
  double statistic = 0.0;
  for (int i = 0; i < cells * cells; ++i) {
    const double x0 = -0.8 + 2.4 * (i % cells) / cells, y0 = -1.0 + 1.6 * (i / cells) / cells;
    const double expected =
        part(x0, x0 + 2.4 / cells, y0, y0 + 1.6 / cells) / whole * double(got.size());
    statistic += (counts[i] - expected) * (counts[i] - expected) / expected;
  }
  EXPECT_LT(statistic, 63.0 + 4.0 * std::sqrt(2.0 * 63.0));
}

}  // namespace
}  // namespace heliograph::test
