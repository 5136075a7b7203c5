// KHR_materials_volume: a thickness is in the space of the mesh.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene::test {
namespace {

glm::mat4 scaled(const glm::vec3& scale) {
  return glm::scale(glm::mat4(1.0f), scale);
}

TEST(LengthScale, IsThatOfTheVolume) {
  EXPECT_FLOAT_EQ(length_scale(glm::mat4(1.0f)), 1.0f);
  EXPECT_FLOAT_EQ(length_scale(scaled(glm::vec3(10.0f))), 10.0f);
  EXPECT_FLOAT_EQ(length_scale(scaled({1.0f, 4.0f, 2.0f})), 2.0f);
  EXPECT_FLOAT_EQ(length_scale(scaled({-3.0f, 3.0f, 3.0f})), 3.0f) << "mirrored";
  EXPECT_EQ(length_scale(scaled({1.0f, 0.0f, 1.0f})), 0.0f);
  EXPECT_FLOAT_EQ(length_scale(scaled(glm::vec3(1e20f))), 1e20f);
  const glm::mat4 turned = glm::rotate(glm::mat4(1.0f), 0.7f, glm::normalize(glm::vec3(1, 2, 3)));
  EXPECT_NEAR(length_scale(glm::translate(turned, {5, 6, 7}) * scaled(glm::vec3(0.5f))), 0.5f,
              1e-6f);
}

TEST(LengthScale, RaysPassAsMuchAsTheThicknessOfInstancesLeaves) {
  const auto passing = [](double scale) {
    GltfBuilder builder = everything();
    builder.json["materials"][0] = {{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                                    {"extensions",
                                     {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                                      {"KHR_materials_volume",
                                       {{"thicknessFactor", 0.5},
                                        {"attenuationDistance", 1},
                                        {"attenuationColor", {0.25, 0.25, 0.25}}}}}}};
    builder.json["nodes"][0]["scale"] = {scale, scale, scale};
    return builder.import().materials.at(0).passing;
  };
  EXPECT_NEAR(passing(1.0), 0.5f, 1e-5f);
  EXPECT_NEAR(passing(2.0), 0.25f, 1e-5f);
}

}  // namespace
}  // namespace heliograph::scene::test
