#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "scene/gltf/export/glb_export.hpp"
#include "scene/import.hpp"
#include "tests/unit/scene/support/encoders.hpp"
#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene::test {
namespace {

using nlohmann::json;

/// A scene in a folder, its export, and the export imported again.
class Exported {
 public:
  explicit Exported(const GltfBuilder& builder, const SceneChoice& choice = {})
      : Exported(builder.glb(), "scene.glb", choice) {}
  Exported(const Bytes& file, const std::string& name, const SceneChoice& choice = {},
           const std::vector<std::pair<std::string, Bytes>>& beside = {}) {
    for (const auto& [other, bytes] : beside) folder.write(other, bytes);
    before = import_gltf(folder.write(name, file), {}, {.choice = choice});
  }

  /// Exports with `changes` and imports in a folder without other files.
  void write() {
    std::ostringstream out;
    warnings = export_glb(before, changes, limits, out);
    file = std::move(out).str();
    const TemporaryFolder alone;
    after = import_gltf(alone.write("exported.glb", file), strict_limits);
  }
  void edit_lights() {
    for (const Light& light : before.lights) {
      changes.lights.push_back({.name = light.name, .device = light.device});
    }
  }
  shared::Light& light(std::size_t index) { return changes.lights.at(index).device; }
  shared::Material& material(std::size_t index) {
    if (changes.materials.empty()) changes.materials = before.materials;
    return changes.materials.at(index);
  }
  /// Of the exported file.
  json document() const {
    std::uint32_t length = 0;
    std::memcpy(&length, file.data() + 12, sizeof length);
    return json::parse(file.substr(20, length));
  }

  TemporaryFolder folder;
  ImportLimits limits;
  SceneChanges changes;
  Scene before;
  Scene after;
  std::string file;
  std::vector<std::string> warnings;
};

void expect_same_geometry(const Scene& a, const Scene& b) {
  ASSERT_EQ(a.meshes.size(), b.meshes.size());
  EXPECT_EQ(a.instances.size(), b.instances.size());
  for (std::size_t i = 0; i < a.meshes.size(); ++i) {
    EXPECT_EQ(a.meshes[i].indices, b.meshes[i].indices);
    ASSERT_EQ(a.meshes[i].vertices.size(), b.meshes[i].vertices.size());
    EXPECT_EQ(0, std::memcmp(a.meshes[i].vertices.data(), b.meshes[i].vertices.data(),
                             a.meshes[i].vertices.size() * sizeof(shared::Vertex)));
  }
}

void expect_same_images(const Scene& a, const Scene& b) {
  ASSERT_EQ(a.images.size(), b.images.size());
  for (std::size_t i = 0; i < a.images.size(); ++i) {
    ASSERT_TRUE(a.images[i].file && b.images[i].file);
    EXPECT_EQ(*a.images[i].file, *b.images[i].file);
  }
}

void expect_near(const glm::vec3& a, const glm::vec3& b, float tolerance = 1e-5f) {
  EXPECT_LT(glm::distance(a, b), tolerance) << a.x << " " << a.y << " " << a.z;
}

/// A triangle with lights of all punctual types; the last two share one, below a scaled node.
GltfBuilder lit() {
  GltfBuilder builder = triangle();
  builder.json["extensionsUsed"] = {"KHR_lights_punctual"};
  builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "directional"}, {"intensity", 3}},
      {{"type", "point"}, {"intensity", 20}, {"range", 9}},
      {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.5}}}}};
  const auto light = [](int index) { return json{{"KHR_lights_punctual", {{"light", index}}}}; };
  builder.add("nodes", {{"name", "sun"}, {"extensions", light(0)}, {"children", {2}}});
  builder.add("nodes", {{"name", "bulb"}, {"extensions", light(1)}, {"translation", {1, 2, 3}}});
  builder.add(
      "nodes",
      {{"name", "rig"}, {"scale", {2, 2, 2}}, {"translation", {0, 5, 0}}, {"children", {4, 5}}});
  builder.add("nodes", {{"name", "left"}, {"extensions", light(2)}, {"translation", {-1, 0, 0}}});
  builder.add("nodes", {{"name", "right"}, {"extensions", light(2)}, {"translation", {1, 0, 0}}});
  builder.json["scenes"][0]["nodes"] = {0, 1, 3};
  return builder;
}

TEST(GlbExport, WithoutChangesTheSceneIsTheSame) {
  Exported exported(everything());
  exported.write();
  expect_same_geometry(exported.before, exported.after);
  expect_same_images(exported.before, exported.after);
  ASSERT_EQ(exported.before.materials.size(), exported.after.materials.size());
  EXPECT_EQ(0, std::memcmp(exported.before.materials.data(), exported.after.materials.data(),
                           exported.before.materials.size() * sizeof(shared::Material)));
  EXPECT_EQ(exported.before.lights.size(), exported.after.lights.size());
  EXPECT_EQ(exported.before.cameras.size(), exported.after.cameras.size());
  EXPECT_EQ(exported.before.clips.size(), exported.after.clips.size());
  EXPECT_EQ(exported.before.skins.size(), exported.after.skins.size());
  EXPECT_TRUE(exported.warnings.empty());
}

TEST(GlbExport, BuffersAndImagesBesideTheFileBecomePartOfIt) {
  GltfBuilder builder = everything();
  const Bytes image = png(2, 2, 4, Bytes(16, 99));
  builder.json["buffers"][0]["uri"] = "data%20of.bin";
  builder.json["images"][0] = {{"uri", "colour.png"}, {"name", "paint"}};
  const std::string text = builder.json.dump();
  Exported exported({text.begin(), text.end()}, "scene.gltf", {},
                    {{"data of.bin", builder.binary}, {"colour.png", image}});
  exported.write();
  expect_same_geometry(exported.before, exported.after);
  expect_same_images(exported.before, exported.after);
  EXPECT_EQ(*exported.after.images.at(0).file, image);
  const json document = exported.document();
  EXPECT_EQ(document.at("images")[0].at("mimeType"), "image/png");
  EXPECT_EQ(document.at("images")[0].at("name"), "paint");
  EXPECT_EQ(document.at("buffers").size(), 1u);
  EXPECT_EQ(exported.after.sources.size(), 1u);
}

TEST(GlbExport, DataUrisAndSeveralBuffersAreJoined) {
  GltfBuilder builder = triangle();
  const Bytes more = {1, 0, 0, 0, 0, 0, 0, 0, 1};
  builder.json["buffers"][0]["uri"] =
      "data:application/octet-stream;base64," + base64(builder.binary);
  builder.add("buffers",
              {{"byteLength", 9}, {"uri", "data:application/octet-stream;base64," + base64(more)}});
  builder.add("buffers", {{"byteLength", 1}, {"uri", "nothing_uses_it.bin"}});
  builder.add("bufferViews", {{"buffer", 1}, {"byteOffset", 3}, {"byteLength", 6}});
  builder.json["accessors"].push_back(
      {{"bufferView", 1}, {"componentType", 5121}, {"type", "SCALAR"}, {"count", 3}});
  builder.json["meshes"][0]["primitives"][0]["indices"] = 1;
  builder.json["accessors"][1]["byteOffset"] = 0;
  builder.binary.clear();
  const std::string text = builder.json.dump();
  Exported exported({text.begin(), text.end()}, "scene.gltf");
  exported.write();
  const json views = exported.document().at("bufferViews");
  EXPECT_EQ(views[1].at("buffer"), 0);
  const auto offset = views[1].at("byteOffset").get<std::size_t>();
  EXPECT_EQ(offset % 4, 3u) << "alignment within the buffer stays";
  expect_same_geometry(exported.before, exported.after);
}

TEST(GlbExport, CompressedViewsStayCompressed) {
  GltfBuilder builder = triangle();
  const Scene plain = builder.import();
  const Bytes packed = pack_vertices(builder.binary, 12);
  const json compression = {{"buffer", 0},
                            {"byteLength", packed.size()},
                            {"byteStride", 12},
                            {"count", 3},
                            {"mode", "ATTRIBUTES"}};
  builder.json["extensionsRequired"] = {"EXT_meshopt_compression"};
  builder.json["bufferViews"][0] = {{"buffer", 1},
                                    {"byteLength", 36},
                                    {"byteStride", 12},
                                    {"extensions", {{"EXT_meshopt_compression", compression}}}};
  builder.json["buffers"] = {
      {{"byteLength", packed.size()}},
      {{"byteLength", 36}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
  builder.binary = packed;
  Exported exported(builder);
  exported.write();
  expect_same_geometry(plain, exported.after);
  EXPECT_EQ(exported.document().at("bufferViews"), builder.json["bufferViews"]);
  EXPECT_EQ(exported.document().at("buffers"), builder.json["buffers"]);
}

TEST(GlbExport, ImagesWithoutTypeGetThatOfTheirBytes) {
  GltfBuilder builder = triangle();
  const auto add = [&](std::string file) {
    builder.add("images", {{"uri", "data:;base64," + base64({file.begin(), file.end()})}});
  };
  add(std::string("RIFF\0\0\0\0WEBPVP8 ", 16));
  add("\xabKTX 20\xbb\r\n\x1a\n");
  add("\xff\xd8\xff\xe0");
  Exported exported(builder);
  exported.write();
  const json images = exported.document().at("images");
  EXPECT_EQ(images[0].at("mimeType"), "image/webp");
  EXPECT_EQ(images[1].at("mimeType"), "image/ktx2");
  EXPECT_EQ(images[2].at("mimeType"), "image/jpeg");
}

TEST(GlbExport, WhatTheImporterDoesNotReadStays) {
  GltfBuilder builder = everything();
  builder.json["asset"]["copyright"] = "the author";
  builder.json["extensionsUsed"].push_back("VENDOR_notes");
  builder.json["extensions"]["VENDOR_notes"] = {{"id", 1234567890123}, {"none", nullptr}};
  builder.json["nodes"][1]["extras"] = {{"id", 1234567890123}};
  builder.json["bufferViews"][0]["extensions"] = {{"VENDOR_notes", {{"stored", true}}}};
  builder.json["skins"][0]["extras"] = "a skin";
  Exported exported(builder);
  exported.write();
  const json document = exported.document();
  for (const char* const member : {"asset", "nodes", "skins", "animations", "extensions", "cameras",
                                   "meshes", "accessors", "textures", "samplers"}) {
    EXPECT_EQ(document.at(member), builder.json.at(member)) << member;
  }
  EXPECT_EQ(document.at("bufferViews")[0].at("extensions"),
            builder.json["bufferViews"][0]["extensions"]);
}

TEST(GlbExport, FactorsOfMaterials) {
  GltfBuilder builder = everything();
  builder.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 0.5};
  builder.json["materials"][0]["occlusionTexture"] = {{"index", 0}};
  Exported exported(builder);
  shared::Material& material = exported.material(0);
  material.base_color = {0.1f, 0.2f, 0.3f, 0.5f};
  material.metallic = 1.0f;
  material.roughness = 0.3f;
  material.emissive = {0.7f, 12.3f, 0.0f};
  material.normal_scale = 1.7f;
  material.occlusion_strength = 0.4f;
  exported.write();
  EXPECT_EQ(0, std::memcmp(&exported.after.materials[0], &material, sizeof material));
  const json written = exported.document().at("materials")[0];
  EXPECT_LE(written.at("emissiveFactor")[1], 1.0);
  EXPECT_EQ(written.at("pbrMetallicRoughness").at("baseColorFactor")[3], 0.5);
  EXPECT_TRUE(exported.warnings.empty());
}

TEST(GlbExport, FactorsOfExtensionsAreWrittenWhereTheyDoSomething) {
  Exported exported(everything());
  exported.material(0).ior = 1.3f;
  MaterialLayers layers = exported.before.material_layers.empty()
                              ? MaterialLayers()
                              : exported.before.material_layers[0];
  layers.clearcoat = 0.75f;
  layers.clearcoat_roughness = 0.25f;
  layers.sheen_color = {0.5f, 0.25f, 0.0f};
  layers.iridescence = 0.5f;
  layers.iridescence_thickness_maximum = 512.0f;
  layers.anisotropy = 0.375f;
  layers.anisotropy_rotation = -1.1f;
  layers.diffuse_transmission = 0.625f;
  layers.diffuse_transmission_color = {0.25f, 1.0f, 0.5f};
  exported.changes.extensions = {layers};
  exported.write();
  ASSERT_FALSE(exported.after.material_layers.empty());
  const MaterialLayers& after = exported.after.material_layers[0];
  EXPECT_EQ(after.clearcoat, 0.75f);
  EXPECT_EQ(after.clearcoat_roughness, 0.25f);
  EXPECT_EQ(after.sheen_color, layers.sheen_color);
  EXPECT_EQ(after.iridescence, 0.5f);
  EXPECT_EQ(after.iridescence_ior, 1.3f);
  EXPECT_EQ(after.iridescence_thickness_maximum, 512.0f);
  EXPECT_EQ(after.anisotropy, 0.375f);
  EXPECT_EQ(after.anisotropy_rotation, -1.1f);
  EXPECT_EQ(after.diffuse_transmission, 0.625f);
  EXPECT_EQ(after.diffuse_transmission_color, layers.diffuse_transmission_color);
  EXPECT_EQ(exported.after.materials[0].ior, 1.3f);
  const json extensions = exported.document().at("materials")[0].at("extensions");
  EXPECT_FALSE(extensions.contains("KHR_materials_volume"));
  EXPECT_FALSE(extensions.contains("KHR_materials_specular"));
  EXPECT_FALSE(extensions.contains("KHR_materials_dispersion"));
  EXPECT_TRUE(exported.warnings.empty());
}

TEST(GlbExport, EmissionUpToOneNeedsNoExtension) {
  GltfBuilder builder = everything();
  builder.json["materials"][0]["emissiveFactor"] = {1, 1, 1};
  builder.json["materials"][0]["extensions"]["KHR_materials_emissive_strength"] = {
      {"emissiveStrength", 8}};
  Exported exported(builder);
  exported.material(0).emissive = {0.5f, 0.25f, 0.0f};
  exported.write();
  EXPECT_EQ(exported.after.materials[0].emissive, glm::vec3(0.5f, 0.25f, 0.0f));
  EXPECT_FALSE(exported.document().at("materials")[0].contains("extensions"));
}

TEST(GlbExport, PrimitivesWithoutMaterialGetTheEditedOne) {
  Exported exported(triangle());
  exported.material(0).roughness = 0.25f;
  exported.write();
  EXPECT_EQ(exported.after.materials.at(0).roughness, 0.25f);
  EXPECT_EQ(exported.after.material_names.at(0), "default");
}

TEST(GlbExport, SpecularGlossinessBecomesTheCoreMaterialWhereItHasNoTextures) {
  GltfBuilder builder = everything();
  const json glossy = {{"diffuseFactor", {0.5, 0.5, 0.5, 1}}, {"glossinessFactor", 0.25}};
  builder.json["materials"][0]["extensions"]["KHR_materials_pbrSpecularGlossiness"] = glossy;
  Exported plain(builder);
  plain.material(0).base_color = {1.0f, 0.0f, 0.0f, 1.0f};
  plain.write();
  EXPECT_EQ(plain.after.materials[0].base_color, glm::vec4(1, 0, 0, 1));
  EXPECT_EQ(plain.after.materials[0].roughness, plain.before.materials[0].roughness);
  EXPECT_TRUE(plain.warnings.empty());

  builder.json["materials"][0]["extensions"]["KHR_materials_pbrSpecularGlossiness"]
              ["diffuseTexture"] = {{"index", 0}};
  Exported textured(builder);
  textured.material(0).base_color = {1.0f, 0.0f, 0.0f, 1.0f};
  textured.write();
  ASSERT_EQ(textured.warnings.size(), 1u);
  EXPECT_NE(textured.warnings[0].find("KHR_materials_pbrSpecularGlossiness"), std::string::npos);
}

TEST(GlbExport, TheShownVariantAndSceneAreThoseOfTheFile) {
  GltfBuilder builder = everything();
  builder.add("materials", {{"name", "red"}, {"doubleSided", true}});
  builder.json["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "red"}}};
  builder.json["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"] = {
      {"mappings", {{{"material", 1}, {"variants", {0}}}}}};
  builder.add("scenes", {{"name", "other"}, {"nodes", {0}}});
  Exported exported(builder, {.scene = "other", .variant = "red"});
  exported.write();
  EXPECT_EQ(exported.after.meshes.at(0).material, 1u);
  EXPECT_EQ(exported.after.shown_scene, 1u);
}

TEST(GlbExport, LightsKeepTheirNodesWhereOnlyTheirLightDiffers) {
  Exported exported(lit());
  exported.edit_lights();
  exported.light(1).color = {10.0f, 5.0f, 2.5f};
  exported.light(1).range = 0.0f;
  exported.light(1).radius = 0.2f;
  exported.light(2).color = glm::vec3(7.0f);
  exported.changes.lights[3].off = true;
  exported.write();
  ASSERT_EQ(exported.after.lights.size(), 4u);
  EXPECT_EQ(exported.document().at("nodes").size(), 6u);
  const shared::Light& bulb = exported.after.lights[1].device;
  expect_near(bulb.color, {10.0f, 5.0f, 2.5f});
  EXPECT_EQ(bulb.range, 0.0f);
  EXPECT_FLOAT_EQ(bulb.radius, 0.2f);
  EXPECT_EQ(bulb.position, exported.before.lights[1].device.position);
  expect_near(exported.after.lights[2].device.color, glm::vec3(7.0f));
  EXPECT_EQ(exported.after.lights[3].device.color, glm::vec3(0.0f)) << "shared it, and is off";
}

TEST(GlbExport, MovedLightsTakeTheirNodesAlongOrBecomeChildren) {
  Exported exported(lit());
  exported.edit_lights();
  const glm::vec3 aside = glm::normalize(glm::vec3(1.0f, -1.0f, 0.5f));
  exported.light(0).direction = aside;
  exported.light(0).tangent = glm::normalize(glm::cross(aside, glm::vec3(0, 1, 0)));
  exported.light(1).position = {4.0f, 4.0f, 4.0f};
  exported.light(2).position = {-3.0f, 1.0f, 2.0f};
  exported.write();
  ASSERT_EQ(exported.after.lights.size(), 4u);
  EXPECT_EQ(exported.document().at("nodes").size(), 7u) << "one child of the sun, which has one";
  EXPECT_EQ(exported.after.nodes.size(), 7u);
  const auto found = [&](const std::string& name) {
    return *std::ranges::find(exported.after.lights, name, &Light::name);
  };
  expect_near(found("sun").device.direction, aside);
  expect_near(found("bulb").device.position, {4.0f, 4.0f, 4.0f});
  expect_near(found("left").device.position, {-3.0f, 1.0f, 2.0f});
  expect_near(found("right").device.position, exported.before.lights[3].device.position);
  EXPECT_FLOAT_EQ(found("left").device.spot_scale, exported.before.lights[2].device.spot_scale);
  EXPECT_FLOAT_EQ(found("sun").device.radius, exported.before.lights[0].device.radius);
}

TEST(GlbExport, RemovedLightsLeaveTheirNodesAndAddedOnesGetNew) {
  Exported exported(lit());
  exported.edit_lights();
  exported.changes.lights[1].removed = true;
  shared::Light spot = exported.light(2);
  spot.position = {9.0f, 8.0f, 7.0f};
  spot.direction = {0.0f, 0.0f, 1.0f};
  spot.color = {1.0f, 4.0f, 2.0f};
  spot.radius = 0.125f;
  exported.changes.lights.push_back({.name = "new spot", .device = spot});
  exported.write();
  ASSERT_EQ(exported.after.lights.size(), 4u);
  EXPECT_EQ(exported.after.nodes.size(), 7u);
  const Light& added = *std::ranges::find(exported.after.lights, "new spot", &Light::name);
  EXPECT_EQ(added.device.position, spot.position);
  expect_near(added.device.direction, spot.direction);
  expect_near(added.device.tangent, spot.tangent);
  expect_near(added.device.color, spot.color);
  EXPECT_NEAR(added.device.spot_scale, spot.spot_scale, 1e-3f);
  EXPECT_NEAR(added.device.spot_offset, spot.spot_offset, 1e-3f);
  EXPECT_EQ(added.device.radius, 0.125f);
}

TEST(GlbExport, SceneWithoutLightsGetsSome) {
  Exported exported(triangle());
  shared::Light sun{};
  sun.type = shared::light_directional;
  sun.direction = {0.0f, -1.0f, 0.0f};
  sun.tangent = {1.0f, 0.0f, 0.0f};
  sun.color = glm::vec3(3.0f);
  sun.radius = 0.01f;
  shared::Light panel = sun;
  panel.type = shared::light_rectangle;
  panel.half_width = 1.5f;
  panel.half_height = 0.5f;
  panel.position = {0.0f, 3.0f, 0.0f};
  exported.changes.lights = {{.name = "sun", .device = sun}, {.name = "panel", .device = panel}};
  exported.write();
  ASSERT_EQ(exported.after.lights.size(), 2u);
  EXPECT_NEAR(exported.after.lights[0].device.radius, 0.01f, 1e-6f);
  EXPECT_EQ(exported.after.lights[1].device.half_width, 1.5f);
  expect_near(exported.after.lights[1].device.direction, panel.direction);
  EXPECT_EQ(exported.document().at("extensionsUsed"), json({"KHR_lights_punctual"}));
  ASSERT_EQ(exported.warnings.size(), 1u);
  EXPECT_NE(exported.warnings[0].find("\"panel\""), std::string::npos);
}

TEST(GlbExport, AreaLightsAreChangedInExtras) {
  GltfBuilder builder = triangle();
  builder.add("nodes",
              {{"name", "panel"},
               {"extras", {{"areaLight", {{"shape", "disk"}, {"radius", 1}}}, {"note", "stays"}}}});
  builder.json["scenes"][0]["nodes"].push_back(1);
  Exported exported(builder);
  exported.edit_lights();
  exported.light(0).color = {2.0f, 1.0f, 1.0f};
  exported.light(0).radius = 0.5f;
  exported.light(0).position = {0.0f, 1.0f, 0.0f};
  exported.write();
  const shared::Light& light = exported.after.lights.at(0).device;
  EXPECT_EQ(light.type, shared::light_disk);
  expect_near(light.color, {2.0f, 1.0f, 1.0f});
  EXPECT_EQ(light.radius, 0.5f);
  expect_near(light.position, {0.0f, 1.0f, 0.0f});
  EXPECT_EQ(exported.document().at("nodes")[1].at("extras").at("note"), "stays");
  EXPECT_EQ(exported.warnings.size(), 1u);
}

TEST(GlbExport, HiddenNodesAreHiddenUnlessTheyHoldLights) {
  GltfBuilder builder = everything();  // node 2, below node 0, has the light
  const auto mesh = builder.json["nodes"][0]["mesh"];
  builder.add("nodes", {{"name", "part"}, {"mesh", mesh}});
  builder.json["nodes"][0]["children"].push_back(3);
  Exported exported(builder);
  ASSERT_EQ(exported.before.instances.size(), 2u);
  exported.changes.hidden = {0};
  exported.write();
  EXPECT_EQ(exported.after.instances.size(), 1u) << "the part is hidden";
  EXPECT_EQ(exported.after.lights.size(), 1u);
  ASSERT_EQ(exported.warnings.size(), 1u);
  EXPECT_NE(exported.warnings[0].find("is visible in the file"), std::string::npos);

  Exported part(builder);
  part.changes.hidden = {3};
  part.write();
  EXPECT_EQ(part.after.instances.size(), 1u);
  EXPECT_TRUE(part.warnings.empty());
}

TEST(GlbExport, MissingImagesStayMissing) {
  GltfBuilder builder = everything();
  builder.json["images"][0] = {{"uri", "nowhere.png"}};
  Exported exported(builder);
  std::ostringstream out;
  exported.warnings = export_glb(exported.before, {}, {}, out);
  exported.file = out.str();
  ASSERT_EQ(exported.warnings.size(), 1u);
  EXPECT_NE(exported.warnings[0].find("images[0]"), std::string::npos);
  EXPECT_EQ(exported.document().at("images")[0].at("uri"), "nowhere.png");
}

std::string export_refusal(const Exported& exported, const ImportLimits& limits = {}) {
  std::ostringstream out;
  try {
    export_glb(exported.before, exported.changes, limits, out);
  } catch (const ImportError& error) {
    EXPECT_TRUE(out.str().empty());
    return error.what();
  }
  return "";
}

TEST(GlbExport, RefusesFilesThatChangedSinceTheSceneWasLoaded) {
  Exported exported(everything());
  exported.folder.write("scene.glb", triangle().glb());
  EXPECT_NE(export_refusal(exported).find("changed"), std::string::npos);
  std::filesystem::remove(exported.folder.path() / "scene.glb");
  EXPECT_NE(export_refusal(exported).find("changed"), std::string::npos);
}

TEST(GlbExport, LimitOnFilesHolds) {
  GltfBuilder builder = triangle();
  builder.binary.resize(100000);
  builder.json["buffers"][0]["byteLength"] = 100000;
  Exported exported(builder);
  EXPECT_NE(export_refusal(exported, {.file_bytes = 50000}).find("limit"), std::string::npos);
  EXPECT_EQ(export_refusal(exported, {.file_bytes = 200000}), "");
}

TEST(GlbExport, SceneThatIsNoFileIsRefused) {
  std::ostringstream out;
  EXPECT_THROW(export_glb(Scene(), {}, {}, out), ImportError);
}

TEST(GlbExport, CanBeCancelled) {
  const Exported exported(everything());
  std::stop_source stop;
  stop.request_stop();
  std::ostringstream out;
  EXPECT_THROW(export_glb(exported.before, {}, {}, out, stop.get_token()), LoadCancelled);
}

}  // namespace
}  // namespace heliograph::scene::test
