// Sample files in HELIOGRAPH_TEST_ASSETS.
#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>

#include "scene/environment.hpp"
#include "scene/gltf/document/accessors.hpp"
#include "scene/gltf/geometry/meshes.hpp"
#include "scene/gltf/geometry/tangents.hpp"
#include "scene/gltf/materials/materials.hpp"
#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene::test {
namespace {

class Assets : public testing::Test {
 protected:
  void SetUp() override {
    const char* folder = std::getenv("HELIOGRAPH_TEST_ASSETS");
    if (!folder) GTEST_SKIP() << "HELIOGRAPH_TEST_ASSETS is not set";
    folder_ = folder;
  }

  std::filesystem::path folder_;
};

struct Expected {
  const char* file;
  std::uint64_t triangles;
};

TEST_F(Assets, TriangleCounts) {
  for (const Expected& expected : {Expected{"gltf/DamagedHelmet.glb", 15452},
                                   {"gltf/FlightHelmet/FlightHelmet.gltf", 94722},
                                   {"gltf/sponza_positions_only.glb", 187364},
                                   {"gltf/room_godot.glb", 63720},
                                   {"gltf/statue.glb", 16259},
                                   {"gltf/house.glb", 10497},
                                   {"gltf/CesiumMan.glb", 4672},
                                   {"gltf/Fox.glb", 576},
                                   {"gltf/BoxAnimated.glb", 254},
                                   {"gltf/AnimatedCube/AnimatedCube.gltf", 12},
                                   {"gltf/AnimatedMorphCube.glb", 12},
                                   {"gltf/SimpleSparseAccessor/SimpleSparseAccessor.gltf", 12},
                                   {"gltf/Cameras/Cameras.gltf", 2},
                                   {"gltf/Lights.glb", 12},
                                   {"gltf/CornellBox.glb", 36},
                                   {"gltf/NormalTangentTest.glb", 7774},
                                   {"gltf/SpecularTest.glb", 44828},
                                   {"gltf/Duck.glb", 4212},
                                   {"gltf/heart_draco.glb", 180},
                                   {"standins/cubes_distance.glb", 170},
                                   {"standins/icosphere.glb", 27422},
                                   {"standins/glossy_sponza_1.glb", 344088},
                                   {"standins/shadow_objects.glb", 18040},
                                   {"standins/pillars.glb", 61954},
                                   {"standins/breakfast_room.glb", 39656}}) {
    SCOPED_TRACE(expected.file);
    EXPECT_EQ(import_gltf(folder_ / expected.file).triangle_count(), expected.triangles);
  }
}

TEST_F(Assets, EverySceneLoads) {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_)) {
    const std::string extension = entry.path().extension();
    if (extension != ".glb" && extension != ".gltf") continue;
    SCOPED_TRACE(entry.path().filename());
    EXPECT_EQ(refusal_of(entry.path()), "");
  }
}

TEST_F(Assets, DamagedHelmetHasAllTextures) {
  const Scene scene = import_gltf(folder_ / "gltf/DamagedHelmet.glb");
  ASSERT_EQ(scene.materials.size(), 1u);
  const shared::Material& material = scene.materials[0];
  for (const shared::TextureSlot* slot :
       {&material.base_color_texture, &material.metallic_roughness_texture,
        &material.normal_texture, &material.occlusion_texture, &material.emissive_texture}) {
    ASSERT_LT(slot->texture, scene.textures.size());
    const Image& image = scene.images[scene.textures[slot->texture].image];
    EXPECT_EQ(image.width, 2048u);
    EXPECT_EQ(image.levels, 12u);
  }
  EXPECT_EQ(material.emissive, glm::vec3(1.0f));
}

TEST_F(Assets, CamerasOfBothKinds) {
  const Scene scene = import_gltf(folder_ / "gltf/Cameras/Cameras.gltf");
  ASSERT_EQ(scene.cameras.size(), 2u);
  EXPECT_EQ(scene.cameras[0].orthographic_height, 0.0f);
  EXPECT_NEAR(scene.cameras[0].vertical_fov, 40.1f, 0.1f);
  EXPECT_FLOAT_EQ(scene.cameras[1].orthographic_height, 2.0f);
  EXPECT_LT(glm::distance(scene.cameras[0].eye, glm::vec3(0.5f, 0.5f, 3.0f)), 1e-5f);
}

TEST_F(Assets, LightsOfEveryKind) {
  const Scene scene = import_gltf(folder_ / "gltf/Lights.glb");
  ASSERT_EQ(scene.lights.size(), 4u);
  for (const Light& light : scene.lights) {
    EXPECT_GT(light.device.color.x + light.device.color.y + light.device.color.z, 0.0f);
    EXPECT_NEAR(glm::length(light.device.direction), 1.0f, 1e-5f);
  }
}

TEST_F(Assets, CornellBoxEmission) {
  const Scene scene = import_gltf(folder_ / "gltf/CornellBox.glb");
  float brightest = 0.0f;
  for (const shared::Material& material : scene.materials)
    brightest = std::max(brightest, material.emissive.x);
  EXPECT_GT(brightest, 1.0f) << "KHR_materials_emissive_strength";
}

TEST_F(Assets, MaskedHouseHasAlphaHeap) {
  const Scene scene = import_gltf(folder_ / "gltf/house.glb");
  EXPECT_EQ(scene.alpha_heap.size(), 1024u * 1024u);
}

// FlightHelmet has tangents of the MikkTSpace reference implementation: generated ones must match.
TEST_F(Assets, GeneratedTangentsMatchMikkTSpace) {
  const Scene scene = import_gltf(folder_ / "gltf/FlightHelmet/FlightHelmet.gltf");
  const shared::TextureSlot plain = default_material().normal_texture;
  std::size_t compared = 0;
  std::size_t same_hand = 0;
  std::size_t close = 0;
  for (const Mesh& mesh : scene.meshes) {
    std::vector<shared::Vertex> vertices = mesh.vertices;
    std::vector<std::uint32_t> indices = mesh.indices;
    generate_tangents(vertices, indices, plain);
    for (std::size_t i = 0; i < indices.size(); ++i) {
      const glm::vec4& made = vertices[indices[i]].tangent;
      const glm::vec4& given = mesh.vertices[mesh.indices[i]].tangent;
      ++compared;
      same_hand += made.w == given.w;
      close += made.w == given.w && glm::dot(glm::vec3(made), glm::vec3(given)) > 0.99f;
    }
  }
  EXPECT_GT(static_cast<double>(same_hand) / compared, 0.999);
  EXPECT_GT(static_cast<double>(close) / compared, 0.98);
}

TEST_F(Assets, EnvironmentsAreNotBlack) {
  for (const char* file : {"hdr/studio.hdr", "hdr/venice.hdr", "hdr/std_env.hdr"}) {
    SCOPED_TRACE(file);
    const Environment environment = load_environment(folder_ / file);
    EXPECT_EQ(environment.width, 2 * environment.height);
    glm::dvec3 sum(0.0);
    for (const glm::vec3& texel : environment.radiance) sum += glm::dvec3(texel);
    EXPECT_GT(sum.x / environment.radiance.size(), 0.01);
  }
}

}  // namespace
}  // namespace heliograph::scene::test
