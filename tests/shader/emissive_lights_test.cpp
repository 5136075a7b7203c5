#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/shader/chi_square.hpp"
#include "tests/shader/embedded.hpp"
#include "tests/shader/random_inputs.hpp"
#include "tests/support/compute_harness.hpp"

namespace heliograph::test {
namespace {

enum Function : std::uint32_t { draw, hit };

constexpr std::array<glm::vec3, 4> square{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}};

shared::Material glowing(const glm::vec3& emissive, std::uint32_t flags = 0) {
  shared::Material material = surface(glm::vec3(0.5f));
  material.emissive = emissive;
  material.flags = flags;
  return material;
}

std::vector<ShaderOutput> call(const FrameRig& rig, Function function, int count,
                               const glm::vec3& receiver = {0, 0, 9}) {
  RandomInputs random(5);
  std::vector<ShaderInput> inputs;
  for (int i = 0; i < count; ++i) {
    inputs.push_back({.a = {random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1),
                            random.uniform(0, 1)},
                      .b = glm::vec4(receiver, 0)});
  }
  return ShaderFunctions(shaders::emissive_lights, &rig).call(function, inputs);
}

glm::mat4 at(float x, float scale = 1.0f) {
  return glm::scale(glm::translate(glm::mat4(1.0f), {x, 0, 0}), glm::vec3(scale));
}

/// Squares at x = 0 (of 4 square metres), x = 10 (16, both sides) and x = 20 (4, three times as
/// bright), and one that is dark.
std::shared_ptr<const scene::Scene> three_squares() {
  SceneBuilder builder;
  const auto plain = builder.add_quad(square, glowing(glm::vec3(1)));
  const auto both = builder.add_quad(square, glowing(glm::vec3(1), shared::material_double_sided));
  const auto bright = builder.add_quad(square, glowing(glm::vec3(3)));
  const auto dark = builder.add_quad(square, glowing(glm::vec3(0)));
  builder.place(dark, at(-10)).place(plain).place(both, at(10, 2)).place(bright, at(20));
  return builder.build();
}

TEST(EmissiveSampling, DrawsSquaresByPowerAndPointsByArea) {
  FrameRig rig(three_squares(), look({0, 0, 9}, {0, 0, 0}));
  constexpr int count = 60000;
  std::array<double, 4> drawn{};
  std::vector<int> cells(64, 0);  // of the square that is drawn most
  double area = 0.0;
  for (const ShaderOutput& s : call(rig, draw, count)) {
    const auto instance = static_cast<std::size_t>(s.y.w);
    ASSERT_GE(instance, 1u);
    ASSERT_LE(instance, 3u);
    drawn[instance] += 1.0 / count;
    const float half = instance == 2 ? 2.0f : 1.0f;
    const glm::vec2 place =
        (glm::vec2(s.x) - glm::vec2(10.0f * static_cast<float>(instance - 1), 0)) / half;
    ASSERT_LE(std::max(std::abs(place.x), std::abs(place.y)), 1.0001f);
    area += 1.0 / s.x.w / count;
    if (instance != 2) continue;
    const glm::ivec2 cell = glm::clamp(glm::ivec2((place * 0.5f + 0.5f) * 8.0f), 0, 7);
    ++cells[static_cast<std::size_t>(cell.y * 8 + cell.x)];
  }
  // Powers 4, 2 x 16 and 3 x 4.
  EXPECT_NEAR(drawn[1], 4.0 / 48, 0.005);
  EXPECT_NEAR(drawn[2], 32.0 / 48, 0.01);
  EXPECT_NEAR(drawn[3], 12.0 / 48, 0.008);
  EXPECT_LE(chi_square_deviation(cells), 4.0);
  EXPECT_NEAR(area, 24.0, 0.3) << "the integral of 1 over all that shines";
}

TEST(EmissiveSampling, HitsKnowTheDensityOfTheirSample) {
  FrameRig rig(three_squares(), look({0, 0, 9}, {0, 0, 0}));
  int from_behind = 0;
  for (const glm::vec3 receiver : {glm::vec3(3, 1, 2), glm::vec3(8, -2, -3)}) {
    for (const ShaderOutput& s : call(rig, hit, 2000, receiver)) {
      ASSERT_GT(s.x.x, 0.0f);
      EXPECT_NEAR(s.x.y / s.x.x, 1.0f, 1e-3f);
      EXPECT_EQ(s.x.z, s.x.w) << "emission as sampled and as met";
      EXPECT_LE(glm::length(glm::vec3(s.y)), 1e-4f);
      EXPECT_LE(s.y.w, 1e-5f);
      from_behind += s.x.z == 0.0f;
    }
  }
  EXPECT_GT(from_behind, 100) << "backs of single-sided materials send nothing";
}

TEST(EmissiveSampling, FollowsInstancesThatMoveAndGrow) {
  SceneBuilder builder;
  const auto quad = builder.add_quad(square, glowing(glm::vec3(1)));
  builder.place(quad).place(quad, at(10));
  const auto scene = std::make_shared<scene::Scene>(*builder.build());
  const auto channel = [](scene::Property property, std::vector<float> values) {
    scene::Channel made;
    made.node = 1;
    made.property = property;
    made.times = {0.0f, 1.0f};
    made.values = std::move(values);
    return made;
  };
  scene->nodes[1].transform = scene::Transform{.translation = {10, 0, 0}};
  scene->clips.push_back({"grow",
                          1.0f,
                          {channel(scene::Property::translation, {10, 0, 0, 40, 0, 0}),
                           channel(scene::Property::scale, {1, 1, 1, 7, 7, 7})}});
  FrameRig rig(scene, look({0, 0, 9}, {0, 0, 0}));
  const auto share_of_second = [&](float middle, float half) {
    double share = 0.0, area = 0.0;
    for (const ShaderOutput& s : call(rig, draw, 20000)) {
      area += 1.0 / s.x.w / 20000;
      if (s.y.w == 0.0f) continue;
      share += 1.0 / 20000;
      EXPECT_LE(std::abs(s.x.x - middle), half * 1.001f);
    }
    EXPECT_NEAR(area, 4.0 + 4.0 * half * half, 0.05 * (4.0 + 4.0 * half * half));
    return share;
  };
  EXPECT_NEAR(share_of_second(10, 1), 0.5, 0.015);
  const auto pose = [&](double seconds) {
    rig.moving().set_pose(&rig.scene().scene->clips[0], seconds);
    rig.moving().advance();
  };
  pose(0.5);
  EXPECT_NEAR(share_of_second(25, 4), 16.0 / 17.0, 0.01);
  // By less than a quarter: the shares stay, and densities still know the area.
  pose(0.51);
  EXPECT_NEAR(share_of_second(25.3f, 4.06f), 16.0 / 17.0, 0.01);
  pose(0.0);
  EXPECT_NEAR(share_of_second(10, 1), 0.5, 0.015);
}

TEST(EmissiveSampling, MaterialsMaySwitchOnAndOff) {
  const auto scene = three_squares();
  FrameRig rig(scene, look({0, 0, 9}, {0, 0, 0}));
  EXPECT_TRUE(rig.moving().features() & shared::scene_emissive);
  const auto power = [&] {
    const auto& table = rig.moving().emissive().table;
    const auto bytes = gpu::download_buffer(device(), table, sizeof(shared::EmissiveHeader));
    shared::EmissiveHeader header;
    std::memcpy(&header, bytes.data(), sizeof header);
    return header.count == 0 ? 0.0f : header.power / 3.14159265f;
  };
  EXPECT_NEAR(power(), 48.0f, 0.01f);
  std::vector<shared::Material> materials = scene->materials;
  materials[3].emissive = glm::vec3(2.0f);  // was dark
  EXPECT_TRUE(rig.moving().set_materials(materials));
  EXPECT_NEAR(power(), 56.0f, 0.01f);
  materials[3].roughness = 0.3f;
  EXPECT_FALSE(rig.moving().set_materials(materials));
  materials[3].emissive = glm::vec3(4.0f);
  EXPECT_FALSE(rig.moving().set_materials(materials)) << "the table has room";
  EXPECT_NEAR(power(), 64.0f, 0.01f);
  for (shared::Material& material : materials) material.emissive = glm::vec3(0.0f);
  EXPECT_FALSE(rig.moving().set_materials(materials));
  EXPECT_EQ(power(), 0.0f);
  EXPECT_TRUE(rig.moving().features() & shared::scene_emissive) << "plans stay valid";
}

TEST(EmissiveSampling, ScenesWithoutEmissionHaveNoFeature) {
  SceneBuilder builder;
  builder.place(builder.add_quad(square, glowing(glm::vec3(0))));
  const auto scene = builder.build();
  FrameRig rig(scene, look({0, 0, 9}, {0, 0, 0}));
  EXPECT_FALSE(rig.moving().features() & shared::scene_emissive);
  std::vector<shared::Material> materials = scene->materials;
  materials[0].emissive = glm::vec3(1.0f);
  EXPECT_TRUE(rig.moving().set_materials(materials));
  EXPECT_TRUE(rig.moving().features() & shared::scene_emissive);
}

}  // namespace
}  // namespace heliograph::test
