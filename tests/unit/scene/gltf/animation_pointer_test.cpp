// The import of KHR_animation_pointer, and what its tracks give at a moment.
#include "scene/gltf/nodes/animation_pointer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "scene/animation/tracks.hpp"
#include "scene/gltf/materials/texture_kinds.hpp"
#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene::test {
namespace {

using nlohmann::json;
using Numbers = std::vector<float>;
using Pointed = PointedProperty;

/// A document with all that pointers may name: materials 0 (textured), 1 (transmits light),
/// 2 (unlit), 3 (blended), 4 (specular-glossiness), lights 0 (directional) and 1 (spot), cameras
/// 0 (perspective) and 1 (orthographic).
GltfBuilder pointed_document() {
  GltfBuilder b = everything();
  b.json.erase("animations");
  b.json["extensionsUsed"].push_back("KHR_animation_pointer");
  b.json["materials"][0]["emissiveFactor"] = {0.5, 0.25, 0.0};
  b.json["materials"][0]["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 4;
  b.json["materials"][0]["normalTexture"]["extensions"]["KHR_texture_transform"] = {
      {"offset", {0.25, 0.5}}, {"scale", {-2, 2}}};
  b.add("materials",
        {{"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 0.5}}}}}});
  b.add("materials", {{"extensions", {{"KHR_materials_unlit", json::object()}}}});
  b.add("materials", {{"alphaMode", "BLEND"}});
  b.add("materials",
        {{"extensions", {{"KHR_materials_pbrSpecularGlossiness", {{"glossinessFactor", 0.5}}}}}});
  json& lights = b.json["extensions"]["KHR_lights_punctual"]["lights"];
  lights.push_back({{"type", "spot"}, {"color", {1, 0.5, 0.25}}, {"intensity", 8}});
  b.add("cameras", {{"type", "orthographic"},
                    {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0}, {"zfar", 9}}}});
  const auto spot = b.add("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}});
  const auto flat = b.add("nodes", {{"camera", 1}});
  b.json["scenes"][0]["nodes"].push_back(spot);
  b.json["scenes"][0]["nodes"].push_back(flat);
  return b;
}

/// Adds an animation of what `pointer` names, with two keys at 0 and 2 seconds.
void add_pointer(GltfBuilder& b, const std::string& pointer, std::uint32_t output,
                 const char* interpolation = "LINEAR") {
  const auto times = b.add_accessor(Numbers{0, 2}, 5126, "SCALAR", 2);
  b.add("animations",
        {{"samplers", {{{"input", times}, {"output", output}, {"interpolation", interpolation}}}},
         {"channels",
          {{{"sampler", 0},
            {"target",
             {{"path", "pointer"},
              {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}}}}}}});
}

/// The same, of float values.
void add_pointer(GltfBuilder& b, const std::string& pointer, const char* type,
                 const Numbers& values, const char* interpolation = "LINEAR") {
  const std::size_t keys = std::string_view(interpolation) == "CUBICSPLINE" ? 6 : 2;
  add_pointer(b, pointer, b.add_accessor(values, 5126, type, keys), interpolation);
}

std::uint32_t visibility_keys(GltfBuilder& b) {
  return b.add_accessor(b.add_view(std::vector<std::uint8_t>{0, 7}), 5121, "SCALAR", 2);
}

bool warns_of(const Scene& scene, std::string_view part) {
  return std::ranges::any_of(scene.warnings, [&](const std::string& warning) {
    return warning.find(part) != std::string::npos;
  });
}

TEST(AnimationPointer, NamesWhatOtherAnimationsHave) {
  const struct {
    const char* path;
    const char* type;
    Numbers values;
    Property property;
  } cases[] = {{"translation", "VEC3", {0, 0, 0, 2, 4, 6}, Property::translation},
               {"rotation", "VEC4", {0, 0, 0, 1, 0, 0, 1, 0}, Property::rotation},
               {"scale", "VEC3", {1, 1, 1, 3, 3, 3}, Property::scale}};
  for (const auto& [path, type, values, property] : cases) {
    GltfBuilder b = pointed_document();
    add_pointer(b, std::string("/nodes/1/") + path, type, values);
    const Scene scene = b.import();
    ASSERT_EQ(scene.clips.size(), 1u) << path;
    EXPECT_EQ(scene.clips[0].duration, 2.0f);
    EXPECT_TRUE(scene.clips[0].tracks.empty());
    const Channel& channel = scene.clips[0].channels.at(0);
    EXPECT_EQ(channel.property, property);
    EXPECT_EQ(channel.node, *scene.cameras[0].node);
    EXPECT_FALSE(warns_of(scene, "animat"));
  }
}

TEST(AnimationPointer, NamesMorphWeights) {
  GltfBuilder b = triangle();
  const auto lift = b.add_accessor(Numbers{0, 0, 0, 0, 0, 0, 0, 2, 0}, 5126, "VEC3", 3);
  b.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", lift}}};
  add_pointer(b, "/nodes/0/weights", "SCALAR", {0, 1});
  const Channel channel = b.import().clips.at(0).channels.at(0);
  EXPECT_EQ(channel.property, Property::weights);
  EXPECT_EQ(channel.width, 1u);
}

struct Named {
  const char* pointer;
  const char* type;
  Pointed property;
  std::uint32_t object;
};

const Named named[] = {
    {"/materials/0/pbrMetallicRoughness/baseColorFactor", "VEC4", Pointed::base_color, 0},
    {"/materials/0/pbrMetallicRoughness/metallicFactor", "SCALAR", Pointed::metallic, 0},
    {"/materials/1/pbrMetallicRoughness/roughnessFactor", "SCALAR", Pointed::roughness, 1},
    {"/materials/2/pbrMetallicRoughness/baseColorFactor", "VEC4", Pointed::base_color, 2},
    {"/materials/0/emissiveFactor", "VEC3", Pointed::emissive, 0},
    {"/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength", "SCALAR",
     Pointed::emissive_strength, 0},
    {"/materials/0/normalTexture/scale", "SCALAR", Pointed::normal_scale, 0},
    {"/materials/0/occlusionTexture/strength", "SCALAR", Pointed::occlusion_strength, 0},
    {"/materials/0/extensions/KHR_materials_ior/ior", "SCALAR", Pointed::ior, 0},
    {"/materials/0/extensions/KHR_materials_specular/specularFactor", "SCALAR", Pointed::specular,
     0},
    {"/materials/0/extensions/KHR_materials_specular/specularColorFactor", "VEC3",
     Pointed::specular_color, 0},
    {"/materials/0/extensions/KHR_materials_clearcoat/clearcoatFactor", "SCALAR",
     Pointed::clearcoat, 0},
    {"/materials/0/extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor", "SCALAR",
     Pointed::clearcoat_roughness, 0},
    {"/materials/0/extensions/KHR_materials_clearcoat/clearcoatNormalTexture/scale", "SCALAR",
     Pointed::clearcoat_normal_scale, 0},
    {"/materials/0/extensions/KHR_materials_sheen/sheenColorFactor", "VEC3", Pointed::sheen_color,
     0},
    {"/materials/0/extensions/KHR_materials_sheen/sheenRoughnessFactor", "SCALAR",
     Pointed::sheen_roughness, 0},
    {"/materials/1/extensions/KHR_materials_transmission/transmissionFactor", "SCALAR",
     Pointed::transmission, 1},
    {"/materials/1/extensions/KHR_materials_volume/thicknessFactor", "SCALAR", Pointed::thickness,
     1},
    {"/materials/1/extensions/KHR_materials_volume/attenuationDistance", "SCALAR",
     Pointed::attenuation_distance, 1},
    {"/materials/1/extensions/KHR_materials_volume/attenuationColor", "VEC3",
     Pointed::attenuation_color, 1},
    {"/materials/1/extensions/KHR_materials_dispersion/dispersion", "SCALAR", Pointed::dispersion,
     1},
    {"/materials/0/extensions/KHR_materials_iridescence/iridescenceFactor", "SCALAR",
     Pointed::iridescence, 0},
    {"/materials/0/extensions/KHR_materials_iridescence/iridescenceIor", "SCALAR",
     Pointed::iridescence_ior, 0},
    {"/materials/0/extensions/KHR_materials_iridescence/iridescenceThicknessMinimum", "SCALAR",
     Pointed::iridescence_thickness_minimum, 0},
    {"/materials/0/extensions/KHR_materials_iridescence/iridescenceThicknessMaximum", "SCALAR",
     Pointed::iridescence_thickness_maximum, 0},
    {"/materials/0/extensions/KHR_materials_anisotropy/anisotropyStrength", "SCALAR",
     Pointed::anisotropy, 0},
    {"/materials/0/extensions/KHR_materials_anisotropy/anisotropyRotation", "SCALAR",
     Pointed::anisotropy_rotation, 0},
    {"/materials/0/extensions/KHR_materials_diffuse_transmission/diffuseTransmissionFactor",
     "SCALAR", Pointed::diffuse_transmission, 0},
    {"/materials/0/extensions/KHR_materials_diffuse_transmission/diffuseTransmissionColorFactor",
     "VEC3", Pointed::diffuse_transmission_color, 0},
    {"/extensions/KHR_lights_punctual/lights/0/color", "VEC3", Pointed::light_color, 0},
    {"/extensions/KHR_lights_punctual/lights/1/intensity", "SCALAR", Pointed::light_intensity, 1},
    {"/extensions/KHR_lights_punctual/lights/1/range", "SCALAR", Pointed::light_range, 1},
    {"/extensions/KHR_lights_punctual/lights/1/spot/innerConeAngle", "SCALAR", Pointed::inner_cone,
     1},
    {"/extensions/KHR_lights_punctual/lights/1/spot/outerConeAngle", "SCALAR", Pointed::outer_cone,
     1},
    {"/cameras/0/perspective/yfov", "SCALAR", Pointed::vertical_fov, 0},
    {"/cameras/1/orthographic/ymag", "SCALAR", Pointed::orthographic_height, 1},
};

Numbers keys_of(std::string_view type) {
  if (type == "SCALAR") return {0.25f, 0.75f};
  if (type == "VEC2") return {0.25f, 0.5f, 0.75f, 1.0f};
  if (type == "VEC3") return {0.25f, 0.5f, 0.75f, 0.75f, 0.5f, 0.25f};
  return {0.25f, 0.5f, 0.75f, 1.0f, 0.75f, 0.5f, 0.25f, 1.0f};
}

TEST(AnimationPointer, NamesEveryPropertyThatCanBeAnimated) {
  for (const auto& [pointer, type, property, object] : named) {
    GltfBuilder b = pointed_document();
    add_pointer(b, pointer, type, keys_of(type));
    b.json["extensionsRequired"] = {"KHR_animation_pointer"};
    const Scene scene = b.import();
    ASSERT_EQ(scene.clips.size(), 1u) << pointer;
    const Track& track = scene.clips[0].tracks.at(0);
    EXPECT_EQ(track.property, property) << pointer;
    EXPECT_EQ(track.object, object) << pointer;
    EXPECT_EQ(scene.clips[0].duration, 2.0f) << pointer;
    EXPECT_FALSE(warns_of(scene, "animat")) << pointer;
    EXPECT_TRUE(has_tracks(scene));
  }
}

TEST(AnimationPointer, OutputsOfAnotherElementTypeAreRefused) {
  for (const auto& [pointer, type, property, object] : named) {
    GltfBuilder b = pointed_document();
    const char* const other = std::string_view(type) == "SCALAR" ? "VEC2" : "SCALAR";
    add_pointer(b, pointer, other, keys_of(other));
    EXPECT_NE(refusal_of(b).find("wrong element type"), std::string::npos) << pointer;
  }
}

TEST(AnimationPointer, TextureTransformsKeepWhatTheFileSaysOfTheOthers) {
  GltfBuilder b = pointed_document();
  add_pointer(b, "/materials/0/normalTexture/extensions/KHR_texture_transform/offset", "VEC2",
              keys_of("VEC2"));
  add_pointer(b, "/materials/0/normalTexture/extensions/KHR_texture_transform/rotation", "SCALAR",
              keys_of("SCALAR"));
  add_pointer(b,
              "/materials/0/extensions/KHR_materials_clearcoat/clearcoatTexture/extensions/"
              "KHR_texture_transform/scale",
              "VEC2", keys_of("VEC2"));
  add_pointer(b,
              "/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/"
              "KHR_texture_transform/scale",
              "VEC2", keys_of("VEC2"));
  const Scene scene = b.import();
  ASSERT_EQ(scene.clips.size(), 4u);
  ASSERT_EQ(scene.animated_slots.size(), 3u) << "the first two have the same";
  EXPECT_EQ(scene.clips[0].tracks[0].property, Pointed::texture_offset);
  EXPECT_EQ(scene.clips[0].tracks[0].object, scene.clips[1].tracks[0].object);
  EXPECT_EQ(scene.clips[1].tracks[0].property, Pointed::texture_rotation);
  EXPECT_EQ(scene.clips[2].tracks[0].property, Pointed::texture_scale);
  const auto kind = [&](std::size_t slot) {
    return texture_kinds()[scene.animated_slots[slot].kind].name;
  };
  EXPECT_EQ(kind(0), "normal");
  EXPECT_EQ(kind(1), "clearcoat");
  EXPECT_EQ(kind(2), "base_color");
  EXPECT_EQ(scene.animated_slots[0].transform.offset, glm::vec2(0.25f, 0.5f));
  EXPECT_EQ(scene.animated_slots[0].transform.scale, glm::vec2(-2.0f, 2.0f));
  EXPECT_EQ(scene.animated_slots[1].transform.scale, glm::vec2(1.0f)) << "the file has none";
}

TEST(AnimationPointer, WhatTheFileSaysOfCombinedValuesIsKept) {
  const Scene scene = pointed_document().import();
  EXPECT_EQ(scene.materials[0].emissive, glm::vec3(2.0f, 1.0f, 0.0f));
  EXPECT_EQ(scene.material_layers[0].emissive_factor, glm::vec3(0.5f, 0.25f, 0.0f));
  EXPECT_EQ(scene.material_layers[0].emissive_strength, 4.0f);
  ASSERT_EQ(scene.lights.size(), 2u);
  EXPECT_EQ(scene.lights[1].punctual->number, 1u);
  EXPECT_EQ(scene.lights[1].punctual->intensity, 8.0f);
  EXPECT_EQ(scene.lights[1].punctual->color, glm::vec3(1.0f, 0.5f, 0.25f));
}

TEST(AnimationPointer, OthersAreLeftOutWithAWarningAndRefusedWhereRequired) {
  for (const char* const pointer :
       {"/materials/0/alphaCutoff", "/materials/0/extensions/ADOBE_paint/gloss", "/asset/version",
        "/nodes/0/weights/0", "/nodes/0/extras/speed", "/meshes/0/weights",
        "/materials/2/extensions/KHR_materials_ior/ior",
        "/materials/0/extensions/KHR_materials_transmission/transmissionFactor",
        "/materials/4/pbrMetallicRoughness/metallicFactor",
        "/materials/3/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/scale",
        "/extensions/KHR_lights_punctual/lights/0/range",
        "/extensions/KHR_lights_punctual/lights/0/spot/outerConeAngle",
        "/cameras/0/orthographic/ymag", "/cameras/0/perspective/znear", "/materials/0"}) {
    GltfBuilder b = pointed_document();
    add_pointer(b, pointer, "SCALAR", {0, 1});
    const Scene scene = b.import();
    EXPECT_TRUE(scene.clips.empty()) << pointer;
    const std::string named_part(pointer, std::min<std::size_t>(79, std::string(pointer).size()));
    EXPECT_TRUE(warns_of(scene, "\"" + named_part)) << pointer;
    b.json["extensionsRequired"] = {"KHR_animation_pointer"};
    const std::string refusal = refusal_of(b);
    EXPECT_TRUE(refusal.starts_with("requires extensions that are not supported")) << refusal;
    EXPECT_NE(refusal.find(named_part), std::string::npos) << refusal;
  }
}

TEST(AnimationPointer, MalformedPointersAreRefused) {
  const struct {
    const char* pointer;
    const char* reason;
  } cases[] = {{"", "is not a JSON pointer"},
               {"nodes/0/scale", "is not a JSON pointer"},
               {"/nodes/0/sc~ale", "is not a JSON pointer"},
               {"/nodes/0/scale~", "is not a JSON pointer"},
               {"/nodes/99/scale", "\"99\" is not an index into 5 nodes"},
               {"/nodes/99999999999/scale", "is not an index into 5 nodes"},
               {"/nodes/-1/scale", "\"-1\" is not an index"},
               {"/nodes/01/scale", "\"01\" is not an index"},
               {"/nodes/1x/scale", "\"1x\" is not an index"},
               {"/nodes//scale", "\"\" is not an index"},
               {"/materials/5/alphaCutoff", "\"5\" is not an index into 5 materials"},
               {"/cameras/2/perspective/yfov", "is not an index into 2 cameras"},
               {"/extensions/KHR_lights_punctual/lights/2/color", "is not an index into 2 lights"}};
  for (const auto& [pointer, reason] : cases) {
    GltfBuilder b = pointed_document();
    add_pointer(b, pointer, "VEC3", keys_of("VEC3"));
    const std::string refusal = refusal_of(b);
    EXPECT_NE(refusal.find(reason), std::string::npos) << pointer << ": " << refusal;
    EXPECT_TRUE(refusal.starts_with("animations[0].channels[0].target")) << refusal;
  }
}

TEST(AnimationPointer, MalformedTargetsAreRefused) {
  const auto refused = [](const std::function<void(json&)>& damage) {
    GltfBuilder b = pointed_document();
    add_pointer(b, "/nodes/1/scale", "VEC3", keys_of("VEC3"));
    damage(b.json["animations"][0]["channels"][0]["target"]);
    return refusal_of(b);
  };
  EXPECT_EQ(refused([](json& target) { target["node"] = 1; }),
            "animations[0].channels[0].target.node: must not be beside a pointer");
  EXPECT_EQ(refused([](json& target) { target.erase("extensions"); }),
            "animations[0].channels[0].target.extensions.KHR_animation_pointer: is missing");
  EXPECT_NE(refused([](json& target) {
              target["extensions"]["KHR_animation_pointer"]["pointer"] = 7;
            }).find("pointer: must be a string"),
            std::string::npos);
  EXPECT_NE(refused([](json& target) {
              target["extensions"]["KHR_animation_pointer"].erase("pointer");
            }).find("pointer: is missing"),
            std::string::npos);
}

TEST(AnimationPointer, NothingIsAnimatedTwiceInAClip) {
  GltfBuilder b = pointed_document();
  add_pointer(b, "/nodes/1/translation", "VEC3", keys_of("VEC3"));
  add_pointer(b, "/materials/0/emissiveFactor", "VEC3", keys_of("VEC3"));
  EXPECT_EQ(refusal_of(b), "") << "these are two clips";
  json& channels = b.json["animations"][0]["channels"];
  channels.push_back({{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}});
  EXPECT_EQ(refusal_of(b), "animations[0].channels[1].target: is animated twice");
  channels.erase(1);
  b.json["animations"][1]["channels"].push_back(b.json["animations"][1]["channels"][0]);
  EXPECT_EQ(refusal_of(b), "animations[1].channels[1].target: is animated twice");
}

TEST(AnimationPointer, IntegersBecomeFloats) {
  const auto values_of_output = [](int component, bool normalized, const auto& values) {
    GltfBuilder b = pointed_document();
    const auto view = b.add_view(values);
    add_pointer(b, "/materials/0/normalTexture/scale",
                b.add_accessor(view, component, "SCALAR", 2, normalized));
    return b.import().clips.at(0).tracks.at(0).values;
  };
  EXPECT_EQ(values_of_output(5121, true, std::vector<std::uint8_t>{0, 255}), (Numbers{0, 1}));
  EXPECT_EQ(values_of_output(5122, true, std::vector<std::int16_t>{-32767, 32767}),
            (Numbers{-1, 1}));
  EXPECT_EQ(values_of_output(5121, false, std::vector<std::uint8_t>{0, 3}), (Numbers{0, 3}));
}

TEST(AnimationPointer, VisibilityNeedsBytesThatDoNotBlend) {
  const char* const pointer = "/nodes/0/extensions/KHR_node_visibility/visible";
  GltfBuilder b = pointed_document();
  add_pointer(b, pointer, visibility_keys(b), "LINEAR");
  EXPECT_NE(refusal_of(b).find("interpolation: must be STEP"), std::string::npos) << refusal_of(b);
  b = pointed_document();
  add_pointer(b, pointer, "SCALAR", {0, 1}, "STEP");
  EXPECT_NE(refusal_of(b).find("wrong component type"), std::string::npos) << refusal_of(b);
}

TEST(AnimationPointer, HiddenNodesStayWhereAClipMayShowThem) {
  GltfBuilder b = pointed_document();
  b.json["nodes"][0]["extensions"]["KHR_node_visibility"]["visible"] = false;
  const Scene without = b.import();
  EXPECT_TRUE(without.instances.empty());
  EXPECT_TRUE(shown_nodes(without, nullptr, 0.0).empty()) << "nothing is left to be hidden";
  add_pointer(b, "/nodes/0/extensions/KHR_node_visibility/visible", visibility_keys(b), "STEP");
  const Scene scene = b.import();
  ASSERT_EQ(scene.instances.size(), 1u);
  ASSERT_EQ(scene.lights.size(), 2u) << "one is below the node";
  const std::uint32_t node = scene.instances[0].node;
  const auto shown = [&](const Clip* clip, double seconds) {
    const std::vector<bool> nodes = shown_nodes(scene, clip, seconds);
    const bool below = nodes.empty() || nodes[*scene.lights[0].node];
    EXPECT_EQ(nodes.empty() || nodes[node], below) << seconds;
    EXPECT_TRUE(nodes.empty() || nodes[*scene.lights[1].node]) << "it is elsewhere";
    return below;
  };
  EXPECT_FALSE(shown(nullptr, 2.0)) << "as in the file";
  EXPECT_FALSE(shown(&scene.clips[0], 1.9));
  EXPECT_TRUE(shown(&scene.clips[0], 2.0)) << "every value but 0 is true";
  EXPECT_FALSE(shown(&scene.clips[0], 2.1)) << "clips loop";
}

TEST(AnimationPointer, AlphaThatChangesIsToldOf) {
  for (const float alpha : {1.0f, 0.5f}) {
    GltfBuilder b = pointed_document();
    add_pointer(b, "/materials/3/pbrMetallicRoughness/baseColorFactor", "VEC4",
                {1, 0, 0, 1, 0, 0, 1, alpha});
    EXPECT_EQ(warns_of(b.import(), "leaves alpha as it is"), alpha != 1.0f);
  }
}

}  // namespace
}  // namespace heliograph::scene::test
