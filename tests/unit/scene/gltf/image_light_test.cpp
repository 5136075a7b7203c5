// EXT_lights_image_based: the light that a file has around a scene becomes an environment.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/gtc/constants.hpp>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "scene/environment.hpp"
#include "tests/unit/scene/support/exported_scene.hpp"
#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene::test {
namespace {

using nlohmann::json;

const std::string image_light_name = "EXT_lights_image_based";
const std::string image_light_place = "extensions.EXT_lights_image_based.lights[0]";

const std::array<glm::vec3, 6> cube_axes = {
    {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};

/// Red, green, blue, and their complements: one for each face.
const std::array<glm::vec3, 6> face_colors = {
    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 1, 1}, {1, 0, 1}, {1, 1, 0}}};

json& light_of(GltfBuilder& builder) {
  return builder.json["extensions"][image_light_name]["lights"][0];
}

/// A triangle with a light of six files.
GltfBuilder lit_triangle(const std::array<Bytes, 6>& files, std::uint32_t size) {
  GltfBuilder builder = triangle();
  json faces = json::array();
  for (const Bytes& file : files) faces.push_back(builder.add_image(file));
  builder.json["extensionsUsed"] = {image_light_name};
  light_of(builder) = {{"name", "around"},
                       {"irradianceCoefficients", json(9, json(3, 0.5))},
                       {"specularImages", json::array({faces})},
                       {"specularImageSize", size}};
  builder.json["scenes"][0]["extensions"][image_light_name]["light"] = 0;
  return builder;
}

Bytes texels_of(std::uint32_t size, const std::array<int, 4>& rgbd) {
  Bytes texels;
  for (std::uint32_t i = 0; i < size * size; ++i)
    texels.insert(texels.end(), rgbd.begin(), rgbd.end());
  return texels;
}

Bytes plain_face(std::uint32_t size, const glm::vec3& color) {
  const glm::ivec3 bytes(color * 255.0f);
  return png(size, size, 4, texels_of(size, {bytes.x, bytes.y, bytes.z, 255}));
}

/// Every face of one color.
GltfBuilder six_colors(std::uint32_t size = 4) {
  std::array<Bytes, 6> files;
  for (std::size_t i = 0; i < 6; ++i) files[i] = plain_face(size, face_colors[i]);
  return lit_triangle(files, size);
}

GltfBuilder same_faces(const Bytes& file, std::uint32_t size) {
  return lit_triangle({file, file, file, file, file, file}, size);
}

glm::vec3 radiance_from(const Scene& scene, const glm::vec3& toward) {
  const Environment& environment = *scene.environment;
  const glm::vec3 direction = glm::normalize(toward);
  const float u = 0.5f + std::atan2(direction.z, direction.x) / glm::two_pi<float>();
  const float v = std::acos(direction.y) / glm::pi<float>();
  const auto texel = [](float at, std::uint32_t count) {
    return std::min(std::uint32_t(at * float(count)), count - 1);
  };
  return environment.radiance[std::size_t(texel(v, environment.height)) * environment.width +
                              texel(u, environment.width)];
}

void expect_radiance(const glm::vec3& value, const glm::vec3& expected, float tolerance,
                     const std::string& what) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(value[c], expected[c], tolerance) << what << ", " << c;
}

bool warns_of(const Scene& scene, std::string_view part) {
  return std::ranges::any_of(scene.warnings, [&](const std::string& text) {
    return text.find(part) != std::string::npos;
  });
}

TEST(ImageLight, FacesShineFromTheirDirections) {
  const Scene scene = six_colors().import();
  ASSERT_TRUE(scene.environment);
  EXPECT_EQ(scene.environment->width, 64u);
  EXPECT_EQ(scene.environment->height, 32u);
  EXPECT_FALSE(scene.environment->is_studio);
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_TRUE(scene.images.empty() && scene.textures.empty()) << "they are no textures";
  for (std::size_t i = 0; i < 6; ++i) {
    expect_radiance(radiance_from(scene, cube_axes[i]), face_colors[i], 1e-3f, std::to_string(i));
  }
}

/// The direction of a texel, from the table of OpenGL (4.6, 8.19), with the rows in reverse.
glm::vec3 texel_direction(std::size_t face, float column, float row) {
  const float s = 2.0f * column - 1.0f;
  const float t = 2.0f * (1.0f - row) - 1.0f;
  const std::array<glm::vec3, 6> directions = {
      {{1, -t, -s}, {-1, -t, s}, {s, 1, t}, {s, -1, -t}, {s, -t, 1}, {-s, -t, -1}}};
  return glm::normalize(directions[face]);
}

std::uint8_t to_srgb(float linear) {
  const float encoded =
      linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
  return static_cast<std::uint8_t>(std::lround(255.0f * encoded));
}

/// Radiance that says where it comes from.
glm::vec3 told_by(const glm::vec3& direction) {
  return 0.5f + 0.5f * direction;
}

TEST(ImageLight, EveryTexelKeepsItsDirection) {
  constexpr std::uint32_t size = 32;
  std::array<Bytes, 6> files;
  for (std::size_t face = 0; face < 6; ++face) {
    Bytes texels;
    for (std::uint32_t i = 0; i < size * size; ++i) {
      const glm::vec3 told = told_by(
          texel_direction(face, (float(i % size) + 0.5f) / size, (float(i / size) + 0.5f) / size));
      for (int c = 0; c < 3; ++c) texels.push_back(to_srgb(told[c]));
      texels.push_back(255);
    }
    files[face] = png(size, size, 4, texels);
  }
  const Scene scene = lit_triangle(files, size).import();
  const Environment& environment = *scene.environment;
  ASSERT_EQ(environment.width, 4 * size);
  for (std::uint32_t i = 0; i < environment.radiance.size(); ++i) {
    const float azimuth = (float(i % environment.width) + 0.5f) / float(environment.width) - 0.5f;
    const float polar = (float(i / environment.width) + 0.5f) / float(environment.height);
    const float a = azimuth * glm::two_pi<float>();
    const float p = polar * glm::pi<float>();
    const glm::vec3 direction(std::sin(p) * std::cos(a), std::cos(p), std::sin(p) * std::sin(a));
    const glm::vec3 away = glm::abs(environment.radiance[i] - told_by(direction));
    ASSERT_LT(std::max({away.x, away.y, away.z}), 0.008f)
        << "texel " << i % environment.width << ", " << i / environment.width;
  }
}

TEST(ImageLight, ColorsAreDecodedAndDividedByTheLastComponent) {
  // 188 of 255 is 0.5029 of linear light.
  const Scene bright = same_faces(png(2, 2, 4, texels_of(2, {188, 255, 0, 51})), 2).import();
  expect_radiance(radiance_from(bright, {1, 0.2f, 0.3f}), {5.0f * 0.5029f, 5.0f, 0.0f}, 2e-3f,
                  "RGBD");
  const Scene no_divisor = same_faces(png(2, 2, 4, texels_of(2, {255, 0, 0, 0})), 2).import();
  expect_radiance(radiance_from(no_divisor, {0, 1, 0}), {255.0f, 0.0f, 0.0f}, 0.1f,
                  "the least one");
  const Scene opaque = same_faces(png(2, 2, 3, Bytes(12, 188)), 2).import();
  expect_radiance(radiance_from(opaque, {0, -1, 0}), glm::vec3(0.5029f), 1e-3f, "three channels");
  const Scene photo = same_faces(jpeg(8, 8, Bytes(192, 188)), 8).import();
  expect_radiance(radiance_from(photo, {0, 0, 1}), glm::vec3(0.5029f), 0.01f, "JPEG");
}

TEST(ImageLight, IsTurned) {
  GltfBuilder builder = six_colors();
  const double half = std::sqrt(0.5);
  light_of(builder)["rotation"] = {0, half, 0, half};  // +Z goes to +X, which goes to -Z
  Scene scene = builder.import();
  expect_radiance(radiance_from(scene, {1, 0, 0}), face_colors[4], 1e-3f, "+Z");
  expect_radiance(radiance_from(scene, {0, 0, -1}), face_colors[0], 1e-3f, "+X");
  expect_radiance(radiance_from(scene, {0, 1, 0}), face_colors[2], 1e-3f, "+Y");
  light_of(builder)["rotation"] = {2 * half, 0, 0, 2 * half};  // +Y goes to +Z
  scene = builder.import();
  expect_radiance(radiance_from(scene, {0, 0, 1}), face_colors[2], 1e-3f, "+Y");
  expect_radiance(radiance_from(scene, {0, 1, 0}), face_colors[5], 1e-3f, "-Z");
}

TEST(ImageLight, IntensityMultipliesIt) {
  GltfBuilder builder = six_colors();
  light_of(builder)["intensity"] = 2.5;
  expect_radiance(radiance_from(builder.import(), {0, 0, -1}), 2.5f * face_colors[5], 1e-3f, "2.5");
  light_of(builder)["intensity"] = 1e30;
  expect_radiance(radiance_from(builder.import(), {0, 0, -1}), 1e6f * face_colors[5], 1.0f,
                  "as bright as any environment");
  light_of(builder)["intensity"] = 0;
  expect_radiance(radiance_from(builder.import(), {0, 0, -1}), glm::vec3(0.0f), 0.0f, "0");
}

TEST(ImageLight, FacesOfOneTexelSuffice) {
  const Scene scene = six_colors(1).import();
  EXPECT_EQ(scene.environment->width, 64u);
  expect_radiance(radiance_from(scene, {0, 0, 1}), face_colors[4], 0.1f, "near its middle");
  expect_radiance(radiance_from(scene, {1, 0, 1}), 0.5f * (face_colors[0] + face_colors[4]), 0.15f,
                  "between two");
}

TEST(ImageLight, SmallerMipsAreNotRead) {
  GltfBuilder builder = six_colors();
  const auto small = builder.add("images", {{"uri", "missing.png"}});
  light_of(builder)["specularImages"].push_back(json(6, json(small)));
  EXPECT_TRUE(builder.import().environment);
  light_of(builder)["specularImages"].push_back(json(6, json(small)));
  EXPECT_TRUE(builder.import().environment);
  light_of(builder)["specularImages"].push_back(json(6, json(small)));
  EXPECT_NE(refusal_of(builder, {}).find(image_light_place + ".specularImages: 4 mip levels"),
            std::string::npos);
}

TEST(ImageLight, IsThatOfTheChosenScene) {
  GltfBuilder builder = six_colors();
  builder.json["scenes"].push_back({{"name", "dark"}, {"nodes", {0}}});
  EXPECT_TRUE(builder.import().environment);
  EXPECT_FALSE(builder.import({}, {.scene = "dark"}).environment);
  builder.json["scene"] = 1;
  EXPECT_FALSE(builder.import().environment);
  EXPECT_TRUE(builder.import({}, {.scene = "0"}).environment);
}

TEST(ImageLight, MayBeRequired) {
  GltfBuilder builder = six_colors();
  builder.json["extensionsRequired"] = {image_light_name};
  EXPECT_TRUE(builder.import().environment);
}

TEST(ImageLight, IsAroundTheSceneBeforeItsTexturesAreThere) {
  const TemporaryFolder folder;
  GltfBuilder builder = six_colors();
  builder.json["images"][0] = {
      {"uri", "data:image/png;base64," + base64(plain_face(4, face_colors[0]))}};
  std::unique_ptr<Scene> first;
  ImportOptions options;
  options.untextured = [&](std::unique_ptr<Scene> scene, std::uint64_t) {
    first = std::move(scene);
  };
  const Scene whole = import_gltf(folder.write("scene.glb", builder.glb()), {}, options);
  ASSERT_TRUE(first && first->environment);
  EXPECT_EQ(first->environment, whole.environment);
  EXPECT_TRUE(whole.warnings.empty());
}

TEST(ImageLight, AnImageMayBeATextureToo) {
  GltfBuilder builder = everything();
  const auto image = builder.add_image(plain_face(4, face_colors[0]));
  builder.json["textures"][0]["source"] = image;
  builder.json["extensions"][image_light_name]["lights"] = {
      {{"irradianceCoefficients", json(9, json(3, 0))},
       {"specularImages", json::array({json(6, json(image))})},
       {"specularImageSize", 4}}};
  builder.json["scenes"][0]["extensions"][image_light_name]["light"] = 0;
  const Scene scene = builder.import();
  EXPECT_EQ(scene.images.at(0).width, 4u);
  expect_radiance(radiance_from(scene, {0, 1, 0}), face_colors[0], 1e-3f, "every face");
}

TEST(ImageLight, FacesThatCannotBeReadAreBlack) {
  GltfBuilder missing = six_colors();
  missing.json["images"][2] = {{"uri", "missing.png"}};
  Bytes cut = plain_face(4, face_colors[2]);
  cut.erase(cut.end() - 20, cut.end());
  std::array<Bytes, 6> files;
  for (std::size_t i = 0; i < 6; ++i) files[i] = plain_face(4, face_colors[i]);
  files[2] = cut;
  const GltfBuilder damaged = lit_triangle(files, 4);
  files[2] = png(4, 2, 4, Bytes(32, 255));
  const GltfBuilder oblong = lit_triangle(files, 4);
  for (const GltfBuilder& builder : {missing, damaged, oblong}) {
    const Scene scene = builder.import();
    ASSERT_TRUE(scene.environment);
    expect_radiance(radiance_from(scene, {0, 1, 0}), glm::vec3(0.0f), 0.0f, "+Y");
    expect_radiance(radiance_from(scene, {1, 0, 0}), face_colors[0], 1e-3f, "+X");
    EXPECT_TRUE(warns_of(scene, "images[2]"));
    EXPECT_TRUE(warns_of(scene, image_light_place + ".specularImages[0]"));
    EXPECT_NE(refusal_of(builder, strict_limits).find("images[2]"), std::string::npos);
  }
}

TEST(ImageLight, WithoutAnyFaceIsLeftOut) {
  GltfBuilder builder = six_colors();
  for (json& image : builder.json["images"]) image = {{"uri", "missing.png"}};
  const Scene scene = builder.import();
  EXPECT_FALSE(scene.environment);
  EXPECT_TRUE(warns_of(scene, image_light_place + " has no face"));
}

TEST(ImageLight, FacesOfAnotherSizeAreUsedWithAWarning) {
  GltfBuilder builder = six_colors(8);
  light_of(builder)["specularImageSize"] = 16;
  const Scene scene = builder.import();
  const std::string problem = ".specularImages[0]: images[0] is 8 x 8 pixels";
  EXPECT_TRUE(warns_of(scene, image_light_place + problem));
  expect_radiance(radiance_from(scene, {0, -1, 0}), face_colors[3], 1e-3f, "-Y");
  EXPECT_NE(refusal_of(builder, strict_limits).find(problem), std::string::npos);
}

TEST(ImageLight, CountsInTheBudgets) {
  const GltfBuilder builder = six_colors();
  EXPECT_EQ(refusal_of(builder, {.texels = 6 * 16}), "");
  EXPECT_NE(refusal_of(builder, {.texels = 6 * 16 - 1}).find("limit of 95 texels"),
            std::string::npos);
  EXPECT_NE(refusal_of(builder, {.texture_size = 3}).find("images[0] is 4 x 4 pixels"),
            std::string::npos);
  const std::uint64_t bytes = 64 * 32 * sizeof(glm::vec3);
  EXPECT_NE(refusal_of(builder, {.scene_bytes = bytes}).find(image_light_place), std::string::npos);

  GltfBuilder textured = everything();  // with an image of 4 texels
  const auto image = textured.add_image(plain_face(4, face_colors[0]));
  textured.json["extensions"][image_light_name]["lights"] = {
      {{"irradianceCoefficients", json(9, json(3, 0))},
       {"specularImages", json::array({json(6, json(image))})},
       {"specularImageSize", 4}}};
  textured.json["scenes"][0]["extensions"][image_light_name]["light"] = 0;
  const std::uint64_t texels = 2 * 4 + 16;  // one of the textures is color, one is not
  EXPECT_EQ(refusal_of(textured, {.texels = texels}), "");
  EXPECT_NE(refusal_of(textured, {.texels = texels - 1}).find("texels"), std::string::npos);
}

TEST(ImageLight, MalformedOnesAreRefusedByName) {
  const auto expect_refused = [](const std::string& place, const std::string& reason,
                                 const std::function<void(json&)>& damage) {
    GltfBuilder builder = six_colors();
    damage(light_of(builder));
    const std::string refusal = refusal_of(builder, {});
    EXPECT_NE(refusal.find(image_light_place + place + ": " + reason), std::string::npos)
        << place << ": " << refusal;
  };
  expect_refused(".irradianceCoefficients", "must be an array of 9 arrays",
                 [](json& light) { light["irradianceCoefficients"].erase(8); });
  expect_refused(".irradianceCoefficients[4]", "must be an array of 3 numbers",
                 [](json& light) { light["irradianceCoefficients"][4].push_back(1); });
  expect_refused(".irradianceCoefficients[4]", "must be an array of 3 numbers",
                 [](json& light) { light["irradianceCoefficients"][4][1] = 1e300; });
  expect_refused(".irradianceCoefficients[0]", "must be an array of 3 numbers",
                 [](json& light) { light["irradianceCoefficients"][0] = "light"; });
  expect_refused(".specularImages", "must not be empty",
                 [](json& light) { light["specularImages"] = json::array(); });
  expect_refused(".specularImages[0]", "must be an array of 6 indices",
                 [](json& light) { light["specularImages"][0].erase(5); });
  expect_refused(".specularImages[0]", "6 is not an index into 6 images",
                 [](json& light) { light["specularImages"][0][5] = 6; });
  expect_refused(".specularImages[0]", "must contain whole numbers",
                 [](json& light) { light["specularImages"][0][5] = -1; });
  expect_refused(".specularImageSize", "must be at least 1",
                 [](json& light) { light["specularImageSize"] = 0; });
  expect_refused(".intensity", "must not be negative",
                 [](json& light) { light["intensity"] = -1; });
  expect_refused(".rotation", "is not a quaternion of unit length", [](json& light) {
    light["rotation"] = {0, 0, 0, 0};
  });
}

TEST(ImageLight, StaysInAnExportedFile) {
  Exported exported(six_colors());
  exported.write();
  EXPECT_TRUE(exported.warnings.empty());
  ASSERT_TRUE(exported.after.environment);
  EXPECT_EQ(exported.after.environment->radiance, exported.before.environment->radiance);
}

}  // namespace
}  // namespace heliograph::scene::test
