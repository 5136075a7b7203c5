#include "render/resources/emissive/emissive_table.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

namespace heliograph::render {
namespace {

constexpr float pi = glm::pi<float>();

shared::Material glowing(const glm::vec3& emissive, std::uint32_t flags = 0) {
  shared::Material material{};
  material.emissive = emissive;
  material.flags = flags;
  material.emissive_texture = scene::no_texture_slot();
  return material;
}

/// Right triangles in a row, of legs 1 and `legs[i]` metres; uv as wide and high as [0, 1].
scene::Mesh make_mesh(const std::vector<float>& legs) {
  scene::Mesh mesh;
  for (const float leg : legs) {
    for (const glm::vec2 corner : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, leg)}) {
      shared::Vertex vertex{};
      vertex.position = {corner, 0.0f};
      vertex.uv0 = vertex.uv1 = {corner.x, corner.y / leg};
      mesh.indices.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      mesh.vertices.push_back(vertex);
    }
  }
  return mesh;
}

/// A scene of meshes, each with a material of its own.
class Scene {
 public:
  std::uint32_t add(const std::vector<float>& legs, const shared::Material& material) {
    scene_.meshes.push_back(make_mesh(legs));
    scene_.meshes.back().material = static_cast<std::uint32_t>(scene_.materials.size());
    scene_.materials.push_back(material);
    return static_cast<std::uint32_t>(scene_.meshes.size() - 1);
  }
  Scene& place(std::uint32_t mesh, const glm::mat4& world = glm::mat4(1.0f)) {
    scene_.instances.push_back({mesh, 0});
    worlds_.push_back(world);
    return *this;
  }
  EmissiveTable table(std::size_t most = most_emissive) const {
    EmissionMeans means(scene_);
    for (std::size_t i = 0; i < scene_.images.size(); ++i) {
      means.add(scene_, i, scene_.images[i].pixels);
    }
    return make_emissive_table({scene_, scene_.materials, means, worlds_}, most);
  }
  scene::Scene& source() { return scene_; }

 private:
  scene::Scene scene_;
  std::vector<glm::mat4> worlds_;
};

/// How often every entry is drawn: its own slot as far as it stays, and those that give to it.
std::vector<double> drawn_shares(const EmissiveTable& table) {
  std::vector<double> shares(table.triangles.size(), 0.0);
  const double slot = 1.0 / static_cast<double>(table.triangles.size());
  for (std::size_t i = 0; i < table.triangles.size(); ++i) {
    shares[i] += slot * table.triangles[i].threshold;
    shares[table.triangles[i].alias] += slot * (1.0 - table.triangles[i].threshold);
  }
  return shares;
}

void expect_shares(const EmissiveTable& table, const std::vector<double>& powers) {
  ASSERT_EQ(table.header.count, powers.size());
  ASSERT_EQ(table.triangles.size(), powers.size());
  double total = 0.0, sum = 0.0;
  for (const double power : powers) total += power;
  EXPECT_NEAR(table.header.power, total, 1e-4 * total);
  const std::vector<double> drawn = drawn_shares(table);
  for (std::size_t i = 0; i < powers.size(); ++i) {
    EXPECT_NEAR(table.triangles[i].probability, powers[i] / total, 1e-5) << i;
    EXPECT_NEAR(drawn[i], powers[i] / total, 1e-5) << i;
    sum += table.triangles[i].probability;
  }
  EXPECT_NEAR(sum, 1.0, 1e-5);
}

TEST(EmissiveTable, SharesAreProportionalToAreaEmissionAndSides) {
  Scene scene;
  const auto plain = scene.add({1, 3}, glowing({2, 2, 2}));
  const auto green = scene.add({1}, glowing({0, 1, 0}));
  const auto both = scene.add({1}, glowing({1, 1, 1}, shared::material_double_sided));
  const auto dark = scene.add({1}, glowing({0, 0, 0}));
  const auto unlit = scene.add({1}, glowing({1, 1, 1}, shared::material_unlit));
  scene.place(dark).place(plain).place(unlit).place(green).place(both);
  const EmissiveTable table = scene.table();
  expect_shares(table, {pi, 3 * pi, 0.7152 * 0.5 * pi, pi});
  EXPECT_EQ(table.first,
            (std::vector<std::uint32_t>{shared::no_emissive, 0, shared::no_emissive, 2, 3}));
  EXPECT_EQ(table.triangles[1].instance, 1u);
  EXPECT_EQ(table.triangles[1].triangle, 1u);
  EXPECT_EQ(table.triangles[3].instance, 4u);
}

TEST(EmissiveTable, InstancesCountByTheirSize) {
  Scene scene;
  const auto mesh = scene.add({2}, glowing({1, 1, 1}));
  const glm::mat4 one(1.0f);
  scene.place(mesh).place(mesh, glm::scale(one, glm::vec3(3.0f)));
  scene.place(mesh, glm::rotate(glm::scale(one, {1, 1, 5}), 0.7f, {1, 0, 0}));
  scene.place(mesh, glm::scale(one, glm::vec3(0.0f)));
  // The third is turned first, then stretched along the world's z.
  const double turned = std::hypot(std::cos(0.7), 5.0 * std::sin(0.7));
  expect_shares(scene.table(), {pi, 9 * pi, turned * pi});
  EXPECT_EQ(scene.table().first[3], shared::no_emissive) << "nothing is left of it";
}

TEST(EmissiveTable, TexturesCountByTheirMeanOverEachTriangle) {
  Scene scene;
  shared::Material textured = glowing({1, 1, 1});
  textured.emissive_texture.texture = 0;
  const auto mesh = scene.add({2, 2, 2}, textured);
  scene.place(mesh);
  // Left half black, right half half as bright as white, in sRGB; levels as the importer makes
  // them.
  constexpr std::uint8_t half = 188;
  std::vector<std::uint8_t> pixels;
  for (std::uint32_t side = 16; side > 0; side /= 2) {
    for (std::uint32_t i = 0; i < side * side; ++i) {
      const std::uint8_t value = side == 1 ? 137 : i % side < side / 2 ? 0 : half;
      pixels.insert(pixels.end(), {value, value, value, 255});
    }
  }
  scene.source().images.push_back({"window", 16, 16, 5, true, pixels});
  scene.source().textures.push_back({0, {}});
  auto& vertices = scene.source().meshes[mesh].vertices;
  const auto lay = [&](std::size_t triangle, float left, float width) {
    for (std::size_t i = 0; i < 3; ++i) {
      glm::vec2& uv = vertices[3 * triangle + i].uv0;
      uv = {left + width * uv.x, 0.1f + 0.8f * uv.y};
    }
  };
  lay(0, 0.05f, 0.4f);                // within the black half
  lay(1, 0.55f, 0.4f);                // within the bright one
  lay(2, 1.55f, 0.4f);                // the same, as the texture repeats
  const double bright = 0.5029 * pi;  // IEC 61966-2-1 of 188
  expect_shares(scene.table(), {0, bright, bright});
  // Across both, linearly: a quarter of a right triangle lies in the right half.
  scene.source().meshes[mesh] = make_mesh({2, 2, 2});
  const EmissiveTable across = scene.table();
  EXPECT_NEAR(across.header.power / (3 * pi), 0.25 * 0.5029, 0.03);
}

TEST(EmissiveTable, WeakestInstancesAreLeftOutWhereThereAreTooMany) {
  Scene scene;
  const auto weak = scene.add({2, 2, 2}, glowing(glm::vec3(1)));
  const auto strong = scene.add({2, 2}, glowing(glm::vec3(5)));
  const auto single = scene.add({2}, glowing(glm::vec3(0.1f)));
  scene.place(weak).place(strong).place(single);
  expect_shares(scene.table(4), {5 * pi, 5 * pi, 0.1 * pi});
  EXPECT_EQ(scene.table(4).first[0], shared::no_emissive);
  EXPECT_EQ(emissive_capacity(scene.source(), scene.source().materials, 4), 4u);
  EXPECT_EQ(emissive_capacity(scene.source(), scene.source().materials), 6u);
}

TEST(EmissiveTable, IsEmptyWhereNothingShines) {
  Scene scene;
  scene.place(scene.add({1}, glowing(glm::vec3(0))));
  const EmissiveTable table = scene.table();
  EXPECT_EQ(table.header.count, 0u);
  EXPECT_TRUE(table.triangles.empty());
  EXPECT_EQ(table.first, std::vector{shared::no_emissive});
}

TEST(EmissiveTable, SumsHundredThousandTrianglesToOne) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> leg(0.01f, 4.0f);
  std::vector<float> legs(100000);
  for (float& one : legs) one = leg(random);
  Scene scene;
  scene.place(scene.add(legs, glowing({1, 1, 1})));
  const auto start = std::chrono::steady_clock::now();
  const EmissiveTable table = scene.table();
  const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
  std::printf("100,000 emissive triangles: %.1f ms\n", time.count());
  std::vector<double> powers;
  for (const float one : legs) powers.push_back(0.5 * pi * one);
  expect_shares(table, powers);
}

}  // namespace
}  // namespace heliograph::render
