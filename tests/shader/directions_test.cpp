#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/shader/chi_square.hpp"
#include "tests/shader/embedded.hpp"
#include "tests/shader/random_inputs.hpp"
#include "tests/support/compute_harness.hpp"

namespace heliograph::test {
namespace {

enum Function : std::uint32_t { octahedral, basis, offset, cosine, disk, equirectangular, cube };
constexpr double pi = std::numbers::pi;

std::vector<ShaderOutput> call(Function function, const std::vector<ShaderInput>& inputs) {
  return ShaderFunctions(shaders::directions).call(function, inputs);
}

/// Unit vectors everywhere, the axes and their neighbours among them.
std::vector<glm::vec3> directions(std::size_t count, std::uint32_t seed) {
  std::vector<glm::vec3> result;
  for (const float sign : {1.0f, -1.0f}) {
    for (int axis = 0; axis < 3; ++axis) {
      glm::vec3 direction(0.0f);
      direction[axis] = sign;
      result.push_back(direction);
      direction[(axis + 1) % 3] = -1e-4f;
      result.push_back(glm::normalize(direction));
    }
  }
  RandomInputs random(seed);
  while (result.size() < count) result.push_back(random.unit_vector());
  return result;
}

std::vector<ShaderInput> as_inputs(const std::vector<glm::vec3>& vectors) {
  std::vector<ShaderInput> inputs;
  for (const glm::vec3& vector : vectors) inputs.push_back({.a = glm::vec4(vector, 0.0f)});
  return inputs;
}

/// Cigolle et al. 2014, listing for "oct", in double.
glm::dvec2 octahedral_twin(const glm::dvec3& d) {
  const double size = std::abs(d.x) + std::abs(d.y) + std::abs(d.z);
  const glm::dvec2 p(d.x / size, d.y / size);
  if (d.z >= 0.0) return p;
  return {(1.0 - std::abs(p.y)) * (p.x >= 0.0 ? 1.0 : -1.0),
          (1.0 - std::abs(p.x)) * (p.y >= 0.0 ? 1.0 : -1.0)};
}

TEST(Octahedral, MatchesTheCpuReferenceAndRoundTrips) {
  const auto given = directions(5000, 1);
  const auto got = call(octahedral, as_inputs(given));
  for (std::size_t i = 0; i < given.size(); ++i) {
    const glm::dvec2 expected = octahedral_twin(given[i]);
    const glm::vec2 encoded(got[i].x);
    EXPECT_LE(glm::length(glm::dvec2(encoded) - expected), 1e-6) << i;
    EXPECT_LE(std::max(std::abs(encoded.x), std::abs(encoded.y)), 1.0f);
    EXPECT_LE(glm::length(glm::vec3(got[i].y) - given[i]), 1e-6f) << i;
  }
}

TEST(OrthonormalBasis, IsRightHandedEverywhere) {
  auto given = directions(5000, 2);
  given.push_back({0.6f, 0.8f, -0.0f});
  const auto got = call(basis, as_inputs(given));
  for (std::size_t i = 0; i < given.size(); ++i) {
    const glm::vec3 n = given[i], tangent(got[i].x), bitangent(got[i].y);
    EXPECT_NEAR(glm::length(tangent), 1.0f, 2e-6f) << i;
    EXPECT_NEAR(glm::length(bitangent), 1.0f, 2e-6f) << i;
    EXPECT_NEAR(glm::dot(tangent, bitangent), 0.0f, 2e-6f) << i;
    EXPECT_NEAR(glm::dot(tangent, n), 0.0f, 2e-6f) << i;
    EXPECT_LE(glm::length(glm::cross(tangent, bitangent) - n), 4e-6f) << i;
  }
}

/// Möller and Trumbore 1997 in single precision, as a tracer might.
bool meets(const glm::vec3& origin, const glm::vec3& direction, const std::array<glm::vec3, 3>& t) {
  const glm::vec3 edge1 = t[1] - t[0], edge2 = t[2] - t[0];
  const glm::vec3 p = glm::cross(direction, edge2);
  const float determinant = glm::dot(edge1, p);
  if (determinant == 0.0f) return false;
  const glm::vec3 s = origin - t[0], q = glm::cross(s, edge1);
  const float u = glm::dot(s, p) / determinant, v = glm::dot(direction, q) / determinant;
  return u >= 0.0f && v >= 0.0f && u + v <= 1.0f && glm::dot(edge2, q) / determinant > 0.0f;
}

class OffsetOrigin : public testing::TestWithParam<float> {};

TEST_P(OffsetOrigin, AvoidsSelfIntersectionAndStaysNear) {
  const float scale = GetParam();
  RandomInputs random(3);
  struct Case {
    std::array<glm::vec3, 3> triangle;
    glm::vec3 point, normal;
  };
  std::vector<Case> cases;
  std::vector<ShaderInput> inputs;
  while (cases.size() < 4000) {
    Case c;
    const glm::vec3 center = random.unit_vector() * random.uniform(0.0f, scale);
    for (auto& corner : c.triangle) corner = center + random.unit_vector() * 0.3f * scale;
    const glm::vec3 across =
        glm::cross(c.triangle[1] - c.triangle[0], c.triangle[2] - c.triangle[0]);
    if (glm::length(across) < 1e-2f * scale * scale) continue;
    c.normal = glm::normalize(across);
    float u = random.uniform(0.0f, 1.0f), v = random.uniform(0.0f, 1.0f);
    if (u + v > 1.0f) u = 1.0f - u, v = 1.0f - v;
    c.point = (1.0f - u - v) * c.triangle[0] + u * c.triangle[1] + v * c.triangle[2];
    cases.push_back(c);
    inputs.push_back({.a = glm::vec4(c.point, 0.0f),
                      .b = glm::vec4(c.normal, random.uniform(0.0f, 3.0f) * scale)});
  }
  const auto got = call(offset, inputs);
  int met = 0, below = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const glm::vec3 origin(got[i].x);
    const double height = glm::dot(glm::dvec3(cases[i].normal),
                                   glm::dvec3(origin) - glm::dvec3(cases[i].triangle[0]));
    below += height <= 0.0;
    EXPECT_LT(glm::distance(origin, cases[i].point), 1e-4f * scale);
    glm::vec3 direction = random.unit_vector();
    if (glm::dot(direction, cases[i].normal) < 0.0f) direction = -direction;
    met += meets(origin, direction, cases[i].triangle);
  }
  EXPECT_EQ(below, 0) << "origins below the surface they left";
  EXPECT_EQ(met, 0) << "rays met the triangle they started from";
}

INSTANTIATE_TEST_SUITE_P(Scales, OffsetOrigin,
                         testing::Values(1e-3f, 1e-2f, 0.1f, 1.0f, 10.0f, 100.0f, 1e3f, 1e4f));

// A public renderer scales both random numbers to trim the lobe and so leaves out a fifth of the
// circle: the azimuth is tested too.
TEST(SampleCosine, DirectionsFollowTheCosineDensity) {
  RandomInputs random(4);
  for (const glm::vec3& normal : directions(16, 5)) {
    std::vector<ShaderInput> inputs;
    for (int i = 0; i < 40000; ++i) {
      const glm::vec2 u(random.uniform(0.0f, 1.0f), random.uniform(0.0f, 1.0f));
      inputs.push_back({.a = glm::vec4(normal, 0.0f), .b = glm::vec4(u, 0.0f, 0.0f)});
    }
    const auto got = call(cosine, inputs);
    const glm::vec3 side = glm::normalize(
        glm::cross(normal, std::abs(normal.x) < 0.7f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0)));
    const glm::vec3 other = glm::cross(normal, side);
    std::vector<int> counts(8 * 12);
    for (const ShaderOutput& output : got) {
      const glm::vec3 d(output.x);
      ASSERT_NEAR(glm::length(d), 1.0f, 1e-5f);
      const float cos = glm::dot(d, normal);
      ASSERT_GE(cos, -1e-6f);
      // With density cos / pi, cos^2 and the azimuth are uniform.
      const int ring = std::clamp(static_cast<int>(cos * cos * 8.0f), 0, 7);
      const double azimuth = std::atan2(glm::dot(d, other), glm::dot(d, side)) / (2.0 * pi) + 0.5;
      ++counts[ring * 12 + std::clamp(static_cast<int>(azimuth * 12.0), 0, 11)];
    }
    EXPECT_LT(std::abs(chi_square_deviation(counts)), 4.0) << normal.x << " " << normal.y;
  }
}

TEST(SampleDisk, IsUniform) {
  RandomInputs random(6);
  std::vector<ShaderInput> inputs;
  for (int i = 0; i < 40000; ++i) {
    inputs.push_back({.a = {random.uniform(0, 1), random.uniform(0, 1), 0, 0}});
  }
  std::vector<int> counts(8 * 12);
  for (const ShaderOutput& output : call(disk, inputs)) {
    const glm::vec2 p(output.x);
    ASSERT_LE(glm::length(p), 1.0f + 1e-6f);
    const int ring = std::clamp(static_cast<int>(glm::dot(p, p) * 8.0f), 0, 7);
    const double azimuth = std::atan2(p.y, p.x) / (2.0 * pi) + 0.5;
    ++counts[ring * 12 + std::clamp(static_cast<int>(azimuth * 12.0), 0, 11)];
  }
  EXPECT_LT(std::abs(chi_square_deviation(counts)), 4.0);
}

TEST(Equirectangular, FollowsTheConvention) {
  const auto given = directions(5000, 7);
  const auto got = call(equirectangular, as_inputs(given));
  for (std::size_t i = 0; i < given.size(); ++i) {
    const glm::dvec3 d(given[i]);
    // At the poles every u will do.
    if (std::hypot(d.x, d.z) > 1e-6) {
      const double u = 0.5 + std::atan2(d.z, d.x) / (2.0 * pi);
      EXPECT_NEAR(std::remainder(got[i].x.x - u, 1.0), 0.0, 2e-6) << i;
    }
    // acos loses digits near the poles.
    EXPECT_NEAR(got[i].x.y, std::acos(d.y) / pi, 2e-4) << i;
  }
}

struct FaceTexel {
  int face;
  glm::vec2 st;
};

/// Which face and where a direction is read from: Vulkan 1.3, "Cube Map Face Selection".
FaceTexel select_face(const glm::vec3& r) {
  const glm::vec3 size = glm::abs(r);
  const auto at = [](int face, float s, float t, float major) {
    return FaceTexel{face, 0.5f * glm::vec2(s, t) / major + 0.5f};
  };
  if (size.z >= size.x && size.z >= size.y) {
    return r.z >= 0.0f ? at(4, r.x, -r.y, size.z) : at(5, -r.x, -r.y, size.z);
  }
  if (size.y >= size.x) return r.y >= 0.0f ? at(2, r.x, r.z, size.y) : at(3, r.x, -r.z, size.y);
  return r.x >= 0.0f ? at(0, -r.z, -r.y, size.x) : at(1, r.z, -r.y, size.x);
}

TEST(CubeDirection, IsTheInverseOfTheSamplersFaceSelection) {
  constexpr int size = 16;
  std::vector<ShaderInput> inputs;
  for (int face = 0; face < 6; ++face) {
    for (int y = 0; y < size; ++y) {
      for (int x = 0; x < size; ++x) inputs.push_back({.a = glm::vec4(x, y, face, size)});
    }
  }
  const auto got = call(cube, inputs);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const glm::vec3 direction(got[i].x);
    EXPECT_NEAR(glm::length(direction), 1.0f, 1e-6f);
    const FaceTexel selected = select_face(direction);
    EXPECT_EQ(selected.face, static_cast<int>(inputs[i].a.z));
    const glm::vec2 expected = (glm::vec2(inputs[i].a) + 0.5f) / static_cast<float>(size);
    EXPECT_LE(glm::distance(selected.st, expected), 1e-6f);
  }
}

}  // namespace
}  // namespace heliograph::test
