#include "render/passes/gbuffer/gbuffer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "render/passes/gbuffer/trace_gbuffer.hpp"
#include "tests/support/frame_rig.hpp"

namespace heliograph::test {
namespace {

constexpr VkExtent2D extent{64, 48};
constexpr std::array<glm::vec3, 4> facing_quad{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}};

glm::vec3 decode(const glm::vec2& p) {
  glm::vec3 d(p.x, p.y, 1.0f - std::abs(p.x) - std::abs(p.y));
  const float below = std::max(-d.z, 0.0f);
  d.x += d.x >= 0.0f ? -below : below;
  d.y += d.y >= 0.0f ? -below : below;
  return glm::normalize(d);
}

enum class Source { triangles, rays };

/// The G-buffer pass of a scene.
struct Raster {
  Raster(Source source, SceneBuilder& builder, const scene::Camera& camera,
         VkExtent2D shown = extent)
      : rig(builder.build(), camera, {.extent = extent, .shown = shown}),
        gbuffer(source == Source::rays ? render::trace_gbuffer(rig.plan(), rig.inputs())
                                       : render::rasterize_gbuffer(rig.plan(), rig.inputs())) {}

  void run() {
    rig.run();
    normals = rig.read(gbuffer.normals);
    motion = rig.read(gbuffer.motion);
  }
  bool covered(std::uint32_t x, std::uint32_t y) const { return texel(motion, x, y).w > 0.0f; }
  glm::vec3 shading(std::uint32_t x, std::uint32_t y) const {
    return decode(glm::vec2(texel(normals, x, y)));
  }
  glm::vec3 geometric(std::uint32_t x, std::uint32_t y) const {
    const glm::vec4 encoded = texel(normals, x, y);
    return decode({encoded.z, encoded.w});
  }
  /// World position of a pixel's center, from its stored depth.
  glm::vec3 world(std::uint32_t x, std::uint32_t y) const {
    const auto& constants = rig.constants();
    const glm::vec2 ndc =
        (glm::vec2(x, y) + 0.5f) / glm::vec2(extent.width, extent.height) * 2.0f - 1.0f;
    const float view_z = texel(motion, x, y).w;
    const glm::vec2 slope = ndc * glm::vec2(constants.unproject) +
                            glm::vec2(constants.unproject.z, constants.unproject.w);
    return glm::vec3(constants.inverse_view * glm::vec4(slope * view_z, -view_z, 1.0f));
  }
  int covered_pixels() const {
    int count = 0;
    for (std::uint32_t y = 0; y < extent.height; ++y) {
      for (std::uint32_t x = 0; x < extent.width; ++x) count += covered(x, y);
    }
    return count;
  }

  FrameRig rig;
  render::GBuffer gbuffer;
  render::FloatImage normals, motion;
};

class GBuffer : public testing::TestWithParam<Source> {};

INSTANTIATE_TEST_SUITE_P(FoundBy, GBuffer, testing::Values(Source::triangles, Source::rays),
                         [](const auto& instance) {
                           return instance.param == Source::rays ? "Rays" : "Triangles";
                         });

TEST_P(GBuffer, StoresMaterialOfFacingQuad) {
  SceneBuilder builder;
  shared::Material material = surface({0.25f, 0.5f, 1.0f}, 0.4f, 0.8f);
  material.emissive = {2.0f, 0.5f, 0.0f};
  const auto quad = builder.add_quad(facing_quad, material);
  builder.place(quad, glm::translate(glm::mat4(1.0f), {50, 0, 0})).place(quad);
  Raster raster(GetParam(), builder, look({0, 0, 5}, {0, 0, 0}));
  raster.run();
  EXPECT_NEAR(texel(raster.motion, 32, 24).w, 5.0f, 1e-5f);
  EXPECT_LE(glm::distance(raster.shading(32, 24), {0, 0, 1}), 1e-6f);
  EXPECT_LE(glm::distance(raster.geometric(32, 24), {0, 0, 1}), 1e-6f);
  const auto color = texel(raster.rig.read(raster.gbuffer.base_color), 32, 24);
  EXPECT_LE(glm::distance(glm::vec3(color), glm::vec3(0.5f, std::sqrt(0.5f), 1.0f)), 0.004f);
  EXPECT_EQ(color.w, 1.0f) << "occlusion";
  const auto packed = texel(raster.rig.read(raster.gbuffer.surface), 32, 24);
  EXPECT_NEAR(packed.x, 0.4f, 0.002f);
  EXPECT_NEAR(packed.y, 0.8f, 0.002f);
  EXPECT_EQ(packed.z, 0.0f) << "unlit";
  const auto emissive = texel(raster.rig.read(raster.gbuffer.emissive), 32, 24);
  EXPECT_EQ(glm::vec3(emissive), glm::vec3(2.0f, 0.5f, 0.0f));
  EXPECT_EQ(texel(raster.rig.read(raster.gbuffer.instance), 32, 24).x, 2.0f) << "instance + 1";
  EXPECT_FALSE(raster.covered(0, 0));
  EXPECT_EQ(texel(raster.rig.read(raster.gbuffer.instance), 0, 0).x, 0.0f);
}

TEST_P(GBuffer, DepthAndDepthSlopeOfTiltedPlane) {
  SceneBuilder builder;
  const glm::mat4 tilt = glm::rotate(glm::mat4(1.0f), 0.8f, glm::normalize(glm::vec3(1, 0.4f, 0)));
  builder.place(builder.add_quad(facing_quad, surface(glm::vec3(1.0f))),
                glm::scale(tilt, glm::vec3(20)));
  const scene::Camera camera = look({0.5f, 1, 6}, {0, 0, 0});
  Raster raster(GetParam(), builder, camera);
  raster.run();
  const auto slope = raster.rig.read(raster.gbuffer.depth_slope);
  const glm::dvec3 normal = glm::normalize(glm::dvec3(tilt * glm::vec4(0, 0, 1, 0)));
  const auto& constants = raster.rig.constants();
  const auto expected = [&](double x, double y) {
    const glm::dvec2 ndc =
        glm::dvec2(x + 0.5, y + 0.5) / glm::dvec2(extent.width, extent.height) * 2.0 - 1.0;
    const glm::dvec3 ray(
        glm::dmat4(constants.inverse_view) *
        glm::dvec4(ndc.x * constants.unproject.x, ndc.y * constants.unproject.y, -1, 0));
    return -glm::dot(normal, glm::dvec3(camera.eye)) / glm::dot(normal, ray);
  };
  for (std::uint32_t y = 1; y + 1 < extent.height; ++y) {
    for (std::uint32_t x = 1; x + 1 < extent.width; ++x) {
      if (!raster.covered(x, y)) continue;
      const double view_z = expected(x, y);
      ASSERT_NEAR(texel(raster.motion, x, y).w, view_z, 2e-5 * view_z) << x << " " << y;
      const double across = 0.5 * (expected(x + 1.0, y) - expected(x - 1.0, y));
      const double down = 0.5 * (expected(x, y + 1.0) - expected(x, y - 1.0));
      // Derivatives within a 2x2 quad are one-sided.
      EXPECT_NEAR(texel(slope, x, y).x, across, 0.1 * std::abs(across) + 1e-3) << x << " " << y;
      EXPECT_NEAR(texel(slope, x, y).y, down, 0.1 * std::abs(down) + 1e-3) << x << " " << y;
      EXPECT_LE(glm::distance(glm::dvec3(raster.geometric(x, y)), normal), 2e-3);
    }
  }
  EXPECT_GT(raster.covered_pixels(), 2000);
}

TEST_P(GBuffer, MotionVectorsAreZeroForStaticCamera) {
  SceneBuilder builder;
  builder.place(builder.add_sphere(1.0f, surface(glm::vec3(1.0f))));
  const scene::Camera camera = look({1, 2, 4}, {0, 0, 0});
  Raster raster(GetParam(), builder, camera);
  for (std::uint32_t sample = 0; sample < 3; ++sample) {
    raster.rig.set_view(camera, sample);  // motion vectors must not contain the jitter
    raster.run();
    for (std::size_t i = 0; i < raster.motion.rgba.size(); i += 4) {
      // Compilers may contract equal sums differently: less than 0.001 pixels at any resolution.
      ASSERT_NEAR(raster.motion.rgba[i], 0.0f, 1e-7f);
      ASSERT_NEAR(raster.motion.rgba[i + 1], 0.0f, 1e-7f);
      ASSERT_NEAR(raster.motion.rgba[i + 2], 0.0f, 1e-7f);
    }
  }
}

class GBufferMotion : public testing::TestWithParam<std::tuple<Source, scene::Camera>> {};

TEST_P(GBufferMotion, EqualsDifferenceOfTwoProjections) {
  SceneBuilder builder;
  builder.place(builder.add_sphere(1.0f, surface(glm::vec3(1.0f))));
  builder.place(builder.add_quad({{{-9, -1, 9}, {9, -1, 9}, {9, -1, -9}, {-9, -1, -9}}},
                                 surface(glm::vec3(1.0f))));
  const scene::Camera before = look({1, 2, 5}, {0, 0, 0});
  const auto& [source, after] = GetParam();
  Raster raster(source, builder, before);
  raster.run();
  raster.rig.set_view(after);
  raster.run();
  const auto& constants = raster.rig.constants();
  const glm::mat4 old_projection =
      scene::projection_matrix(before, 4.0f / 3.0f) * scene::view_matrix(before);
  double largest = 0.0;
  for (std::uint32_t y = 0; y < extent.height; ++y) {
    for (std::uint32_t x = 0; x < extent.width; ++x) {
      if (!raster.covered(x, y)) continue;
      const glm::vec4 world(raster.world(x, y), 1.0f);
      const auto uv = [&](const glm::mat4& matrix) {
        const glm::vec4 clip = matrix * world;
        return glm::vec2(clip) / clip.w * 0.5f + 0.5f;
      };
      const glm::vec4 motion = texel(raster.motion, x, y);
      const glm::vec2 expected = uv(old_projection) - uv(constants.unjittered);
      ASSERT_LE(glm::distance(glm::vec2(motion), expected), 2e-4f) << x << " " << y;
      const float depth_change =
          -(scene::view_matrix(before) * world).z + (constants.view * world).z;
      ASSERT_NEAR(motion.z, depth_change, 2e-3f) << x << " " << y;
      largest = std::max<double>(largest, glm::length(glm::vec2(motion)));
    }
  }
  EXPECT_GT(largest, 0.005);
}

INSTANTIATE_TEST_SUITE_P(PanYawPitchDolly, GBufferMotion,
                         testing::Combine(testing::Values(Source::triangles, Source::rays),
                                          testing::Values(look({1.3f, 2, 5}, {0.3f, 0, 0}),
                                                          look({1, 2, 5}, {0.4f, 0, 0}),
                                                          look({1, 2, 5}, {0, 0.4f, 0}),
                                                          look({0.9f, 1.8f, 4.5f}, {0, 0, 0}))));

void expect_sphere_normals(Source source, const glm::mat4& world) {
  SceneBuilder builder;
  builder.place(builder.add_sphere(1.0f, surface(glm::vec3(1.0f))), world);
  const scene::Camera camera = look({0.3f, 0.5f, 4}, {0, 0, 0});
  Raster raster(source, builder, camera);
  raster.run();
  const glm::mat3 to_world = glm::transpose(glm::inverse(glm::mat3(world)));
  const glm::mat4 to_mesh = glm::inverse(world);
  for (std::uint32_t y = 0; y < extent.height; ++y) {
    for (std::uint32_t x = 0; x < extent.width; ++x) {
      if (!raster.covered(x, y)) continue;
      const glm::vec3 position = raster.world(x, y);
      const glm::vec3 expected =
          glm::normalize(to_world * glm::vec3(to_mesh * glm::vec4(position, 1)));
      EXPECT_GT(glm::dot(raster.shading(x, y), expected), 0.999f) << x << " " << y;
      EXPECT_GT(glm::dot(raster.geometric(x, y), camera.eye - position), 0.0f) << x << " " << y;
    }
  }
  EXPECT_GT(raster.covered_pixels(), 200);
}

TEST_P(GBuffer, NormalsOfNonUniformlyScaledSphere) {
  expect_sphere_normals(
      GetParam(), glm::rotate(glm::scale(glm::mat4(1.0f), {1.2f, 0.5f, 0.8f}), 0.6f, {0, 0, 1}));
}

TEST_P(GBuffer, NormalsOfMirroredSpherePointOutward) {
  expect_sphere_normals(GetParam(), glm::scale(glm::mat4(1.0f), {-1.2f, 0.5f, 0.8f}));
}

TEST_P(GBuffer, BackFacesAreCulledOrFlippedIfDoubleSided) {
  SceneBuilder culled;
  culled.place(culled.add_quad(facing_quad, surface(glm::vec3(1.0f))));
  Raster behind(GetParam(), culled, look({0, 0, -5}, {0, 0, 0}));
  behind.run();
  EXPECT_EQ(behind.covered_pixels(), 0);

  SceneBuilder both;
  shared::Material material = surface(glm::vec3(1.0f));
  material.flags |= shared::material_double_sided;
  both.place(both.add_quad(facing_quad, material));
  Raster raster(GetParam(), both, look({0, 0, -5}, {0, 0, 0}));
  raster.run();
  ASSERT_TRUE(raster.covered(32, 24));
  EXPECT_LE(glm::distance(raster.shading(32, 24), {0, 0, -1}), 1e-6f);
  EXPECT_LE(glm::distance(raster.geometric(32, 24), {0, 0, -1}), 1e-6f);
}

/// The shading normal at the center of a quad whose normal map is `tilt` everywhere.
glm::vec3 mapped(Source source, const glm::vec3& tilt, const glm::mat4& world,
                 const glm::vec3& eye) {
  SceneBuilder builder;
  shared::Material material = surface(glm::vec3(1.0f));
  const glm::vec3 encoded = glm::normalize(tilt) * 127.5f + 127.5f;
  material.normal_texture.texture = builder.add_texture(
      1, 1, false,
      {static_cast<std::uint8_t>(encoded.x + 0.5f), static_cast<std::uint8_t>(encoded.y + 0.5f),
       static_cast<std::uint8_t>(encoded.z + 0.5f), 255});
  material.flags |= shared::material_double_sided;
  builder.place(builder.add_quad(facing_quad, material), world);
  Raster raster(source, builder, look(eye, {0, 0, 0}));
  raster.run();
  return raster.shading(32, 24);
}

TEST_P(GBuffer, NormalMapTiltsAlongTangentAndBitangent) {
  const glm::vec3 tilt(0.5f, 0.3f, 0.8f);
  // The quad's tangent is +x; its bitangent, cross(normal, tangent), +y.
  EXPECT_LE(
      glm::distance(mapped(GetParam(), tilt, glm::mat4(1.0f), {0, 0, 5}), glm::normalize(tilt)),
      0.01f);
}

TEST_P(GBuffer, NormalMapOfMirroredInstanceIsMirrored) {
  const glm::vec3 tilt(0.5f, 0.3f, 0.8f);
  const glm::mat4 mirror = glm::scale(glm::mat4(1.0f), {-1, 1, 1});
  EXPECT_LE(glm::distance(mapped(GetParam(), tilt, mirror, {0, 0, 5}),
                          glm::normalize(tilt * glm::vec3(-1, 1, 1))),
            0.01f);
}

// glTF 2.0, 3.9.6: the back face's normals are reversed, mapped ones too.
TEST_P(GBuffer, NormalMapOfBackFaceIsReversed) {
  const glm::vec3 tilt(0.5f, 0.3f, 0.8f);
  EXPECT_LE(
      glm::distance(mapped(GetParam(), tilt, glm::mat4(1.0f), {0, 0, -5}), -glm::normalize(tilt)),
      0.01f);
}

TEST_P(GBuffer, AlphaMaskCutsHoles) {
  SceneBuilder builder;
  shared::Material material = surface(glm::vec3(1.0f));
  material.flags |= shared::material_alpha_mask;
  material.alpha_cutoff = 0.5f;
  material.base_color_texture.texture = builder.add_texture(
      2, 2, true, {255, 255, 255, 255, 255, 255, 255, 100, 255, 255, 255, 0, 255, 255, 255, 130});
  builder.place(builder.add_quad(facing_quad, material));
  Raster raster(GetParam(), builder, look({0, 0, 5}, {0, 0, 0}));
  raster.run();
  // uv (0, 0) lies at the quad's lower left corner.
  EXPECT_TRUE(raster.covered(26, 30)) << "alpha 1";
  EXPECT_FALSE(raster.covered(38, 30)) << "alpha below the cutoff";
  EXPECT_FALSE(raster.covered(26, 18)) << "alpha 0";
  EXPECT_TRUE(raster.covered(38, 18)) << "alpha above the cutoff";
}

TEST_P(GBuffer, TexturesAreDecodedFromSrgbAndUpright) {
  SceneBuilder builder;
  shared::Material material = surface(glm::vec3(1.0f));
  material.base_color_texture.texture = builder.add_texture(
      2, 2, true, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 188, 188, 188, 255});
  builder.place(builder.add_quad(facing_quad, material));
  Raster raster(GetParam(), builder, look({0, 0, 5}, {0, 0, 0}));
  raster.run();
  const auto color = raster.rig.read(raster.gbuffer.base_color);
  const auto linear = [&](std::uint32_t x, std::uint32_t y) {
    const glm::vec3 root(texel(color, x, y));
    return root * root;
  };
  EXPECT_LE(glm::distance(linear(26, 30), {1, 0, 0}), 0.01f);
  EXPECT_LE(glm::distance(linear(38, 30), {0, 1, 0}), 0.01f);
  EXPECT_LE(glm::distance(linear(26, 18), {0, 0, 1}), 0.01f);
  EXPECT_LE(glm::distance(linear(38, 18), glm::vec3(0.503f)), 0.01f);
}

// A frame that is reconstructed at a larger size needs the detail of that size.
TEST_P(GBuffer, TexturesHaveTheDetailOfTheSizeShown) {
  constexpr float step = 40.0f;
  const auto level = [&](VkExtent2D shown) {
    SceneBuilder builder;
    shared::Material material = surface(glm::vec3(1.0f));
    material.base_color_texture.texture =
        builder.add_darkening_texture(128, static_cast<std::uint8_t>(step));
    builder.place(builder.add_quad(facing_quad, material));
    Raster raster(GetParam(), builder, look({0, 0, 5}, {0, 0, 0}), shown);
    raster.run();
    const float root = texel(raster.rig.read(raster.gbuffer.base_color), 32, 24).x;
    return (1.0f - root * root) * 255.0f / step;
  };
  EXPECT_NEAR(level(extent), std::log2(128.0f / 23.2f), 0.15f);
  EXPECT_NEAR(level(extent) - level({2 * extent.width, 2 * extent.height}), 1.0f, 0.1f);
}

TEST_P(GBuffer, NearerSurfacesOccludeFartherOnes) {
  SceneBuilder builder;
  const auto quad = builder.add_quad(facing_quad, surface(glm::vec3(1.0f)));
  builder.place(quad, glm::translate(glm::mat4(1.0f), {0, 0, 1}));
  builder.place(quad, glm::scale(glm::mat4(1.0f), glm::vec3(3)));
  Raster raster(GetParam(), builder, look({0, 0, 5}, {0, 0, 0}));
  raster.run();
  EXPECT_NEAR(texel(raster.motion, 32, 24).w, 4.0f, 1e-4f);
  EXPECT_NEAR(texel(raster.motion, 1, 1).w, 5.0f, 1e-4f);
}

}  // namespace
}  // namespace heliograph::test
