#include "scenes/generator/scenes/material_balls.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string>

#include "scenes/generator/gltf/glb.hpp"

namespace heliograph::scenes {
namespace {

constexpr std::size_t row_count = 24;
constexpr float row_image_aspect = float(balls_per_row);
constexpr int ball_texture_size = 16;

const Document& ball_chart() {
  static const Document document = make_material_balls();
  return document;
}

// The JSON chunk follows the file's header of 12 bytes and its own of 8.
const nlohmann::json& ball_chart_json() {
  static const nlohmann::json json = [] {
    const std::vector<std::uint8_t> file = encode_glb(ball_chart(), ball_texture_size);
    std::size_t length = 0;
    for (std::size_t k = 0; k < 4; ++k) length |= std::size_t(file[12 + k]) << (8 * k);
    return nlohmann::json::parse(file.begin() + 20, file.begin() + 20 + std::ptrdiff_t(length));
  }();
  return json;
}

const nlohmann::json& ball_material(const std::string& name) {
  const nlohmann::json& materials = ball_chart_json().at("materials");
  const auto found = std::ranges::find_if(
      materials, [&](const nlohmann::json& material) { return material.at("name") == name; });
  if (found == materials.end()) throw std::out_of_range(name);
  return *found;
}

float ball_factor(const std::string& material, const std::string& extension,
                  const std::string& factor) {
  return ball_material(material).at("extensions").at("KHR_materials_" + extension).at(factor);
}

const Node& chart_node(const std::string& name) {
  const auto found = std::ranges::find(ball_chart().nodes, name, &Node::name);
  if (found == ball_chart().nodes.end()) throw std::out_of_range(name);
  return *found;
}

/// Of a point in a camera's image: -1 to 1 from left to right and from bottom to top.
glm::vec2 image_position(const std::string& camera, float aspect, glm::vec3 point) {
  const Node& node = chart_node(camera);
  const glm::vec3 seen = glm::conjugate(node.rotation) * (point - node.translation);
  const float slope = std::tan(0.5f * ball_chart().cameras[std::size_t(node.camera)].vertical_fov);
  return glm::vec2(seen.x / aspect, seen.y) / (-seen.z * slope);
}

TEST(MaterialBalls, RowsHaveFiveBallsOfTheirNames) {
  const std::vector<BallRow> rows = ball_rows();
  ASSERT_EQ(rows.size(), row_count);
  std::set<std::string> names;
  for (const BallRow& row : rows) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    ASSERT_EQ(row.materials.size(), balls_per_row) << row.name;
    for (const Material& material : row.materials) {
      EXPECT_TRUE(material.name.starts_with(row.name + "=")) << material.name;
      EXPECT_TRUE(names.insert(material.name).second) << material.name;
      EXPECT_GE(chart_node(material.name).mesh, 0);
    }
  }
  EXPECT_EQ(ball_chart().instance_count(), row_count * balls_per_row + 2);  // the ground
}

TEST(MaterialBalls, BallsOfARowDifferInMoreThanTheirNames) {
  for (const BallRow& row : ball_rows()) {
    std::set<std::string> contents;
    for (const Material& material : row.materials) {
      nlohmann::json json = ball_material(material.name);
      json.erase("name");
      contents.insert(json.dump());
    }
    EXPECT_EQ(contents.size(), balls_per_row) << row.name;
  }
}

TEST(MaterialBalls, UseEveryExtensionOfMaterials) {
  const auto used = ball_chart_json().at("extensionsUsed").get<std::set<std::string>>();
  std::set<std::string> expected = {"KHR_lights_punctual"};
  for (const char* name :
       {"anisotropy", "clearcoat", "diffuse_transmission", "dispersion", "emissive_strength", "ior",
        "iridescence", "sheen", "specular", "transmission", "volume"}) {
    expected.insert(std::string("KHR_materials_") + name);
  }
  EXPECT_EQ(used, expected);
}

TEST(MaterialBalls, FactorsAreThoseOfTheNames) {
  EXPECT_EQ(ball_material("metal_roughness=0.75")["pbrMetallicRoughness"]["roughnessFactor"], 0.75);
  EXPECT_EQ(ball_factor("ior=1.33", "ior", "ior"), 1.33f);
  EXPECT_EQ(ball_factor("specular=0.25", "specular", "specularFactor"), 0.25f);
  EXPECT_EQ(ball_factor("clearcoat=0.5", "clearcoat", "clearcoatFactor"), 0.5f);
  EXPECT_EQ(ball_factor("clearcoat_roughness=0.1", "clearcoat", "clearcoatRoughnessFactor"), 0.1f);
  EXPECT_EQ(ball_factor("sheen_roughness=0.75", "sheen", "sheenRoughnessFactor"), 0.75f);
  EXPECT_EQ(ball_factor("iridescence_thickness=550", "iridescence", "iridescenceThicknessMaximum"),
            550.0f);
  EXPECT_EQ(ball_factor("anisotropy=1", "anisotropy", "anisotropyStrength"), 1.0f);
  EXPECT_NEAR(ball_factor("anisotropy_rotation=90", "anisotropy", "anisotropyRotation"), 1.5708f,
              1e-4f);
  EXPECT_EQ(ball_factor("emission=4", "emissive_strength", "emissiveStrength"), 4.0f);
  EXPECT_EQ(ball_factor("transmission=0.25", "transmission", "transmissionFactor"), 0.25f);
  EXPECT_EQ(ball_factor("volume_attenuation=0.5", "volume", "attenuationDistance"), 0.5f);
  EXPECT_EQ(ball_factor("dispersion=2", "dispersion", "dispersion"), 2.0f);
  EXPECT_EQ(
      ball_factor("diffuse_transmission=0.5", "diffuse_transmission", "diffuseTransmissionFactor"),
      0.5f);
  EXPECT_EQ(
      ball_material(
          "diffuse_transmission_color=black")["extensions"]["KHR_materials_diffuse_transmission"]
                                             ["diffuseTransmissionColorFactor"],
      nlohmann::json({0.0f, 0.0f, 0.0f}));
}

TEST(MaterialBalls, AlphaIsBlendedOrCutOff) {
  const nlohmann::json& blended = ball_material("alpha_blend=0.25");
  EXPECT_EQ(blended.at("alphaMode"), "BLEND");
  EXPECT_EQ(blended.at("pbrMetallicRoughness").at("baseColorFactor").at(3), 0.25f);
  const nlohmann::json& masked = ball_material("alpha_mask=0.3");
  EXPECT_EQ(masked.at("alphaMode"), "MASK");
  EXPECT_EQ(masked.at("alphaCutoff"), 0.3f);
  EXPECT_FALSE(ball_material("ior=1.5").contains("alphaMode"));
}

TEST(MaterialBalls, BrushedBallsHaveTangents) {
  const auto has_tangents = [](const std::string& ball) {
    const nlohmann::json& mesh =
        ball_chart_json().at("meshes").at(std::size_t(chart_node(ball).mesh));
    return mesh.at("primitives").at(0).at("attributes").contains("TANGENT");
  };
  EXPECT_TRUE(has_tangents("anisotropy=0.5"));
  EXPECT_TRUE(has_tangents("anisotropy_rotation=30"));
  EXPECT_FALSE(has_tangents("sheen=0.5"));
}

TEST(MaterialBalls, BallsAreInTheMiddleOfTheirSquares) {
  for (const BallRow& row : ball_rows()) {
    for (std::size_t i = 0; i < balls_per_row; ++i) {
      const glm::vec2 at =
          image_position(row.name, row_image_aspect, chart_node(row.materials[i].name).translation);
      EXPECT_NEAR(at.x, (2.0f * float(i) + 1.0f) / float(balls_per_row) - 1.0f, 1e-4f);
      EXPECT_NEAR(at.y, 0.0f, 1e-4f);
    }
  }
}

TEST(MaterialBalls, ARowIsAloneInItsImage) {
  for (const BallRow& row : ball_rows()) {
    const glm::quat turn = chart_node(row.name).rotation;
    const glm::vec3 right = turn * glm::vec3(0.5f, 0.0f, 0.0f);
    const glm::vec3 up = turn * glm::vec3(0.0f, 0.5f, 0.0f);
    for (const Node& node : ball_chart().nodes) {
      if (node.mesh < 0 || node.name.starts_with("ground")) continue;
      if (node.name.starts_with(row.name + "=")) continue;
      // From the edge that is nearer to the middle of the image.
      const glm::vec2 middle = image_position(row.name, row_image_aspect, node.translation);
      const glm::vec3 inwards = glm::sign(middle.x) * right;
      const glm::vec3 towards = glm::sign(middle.y) * up;
      const float x = image_position(row.name, row_image_aspect, node.translation - inwards).x;
      const float y = image_position(row.name, row_image_aspect, node.translation - towards).y;
      EXPECT_GT(std::max(std::abs(x), std::abs(y)), 1.0f) << node.name << " in " << row.name;
    }
  }
}

TEST(MaterialBalls, TheFirstCameraSeesAll) {
  ASSERT_EQ(ball_chart().cameras.size(), row_count + 1);
  EXPECT_EQ(ball_chart().cameras.front().name, "main");
  for (const Node& node : ball_chart().nodes) {
    if (node.mesh < 0 || node.name.starts_with("ground")) continue;
    for (const glm::vec3 offset : {glm::vec3(0.5f, 0, 0), glm::vec3(-0.5f, 0, 0),
                                   glm::vec3(0, 0.5f, 0), glm::vec3(0, -0.5f, 0)}) {
      const glm::vec2 at = image_position("main", 16.0f / 9.0f, node.translation + offset);
      EXPECT_LT(std::max(std::abs(at.x), std::abs(at.y)), 1.0f) << node.name;
    }
  }
}

TEST(MaterialBalls, AreDeterministic) {
  EXPECT_EQ(encode_glb(ball_chart(), ball_texture_size),
            encode_glb(make_material_balls(), ball_texture_size));
  EXPECT_EQ(encode_hdr(make_material_balls_environment()),
            encode_hdr(make_material_balls_environment()));
}

}  // namespace
}  // namespace heliograph::scenes
