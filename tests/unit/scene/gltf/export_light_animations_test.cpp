// Exports of edited lights that clips animate.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "scene/animation/tracks.hpp"
#include "tests/unit/scene/support/exported_scene.hpp"

namespace heliograph::scene::test {
namespace {

using nlohmann::json;
using Pointed = PointedProperty;

std::string light_pointer(int light, const std::string& member) {
  return "/extensions/KHR_lights_punctual/lights/" + std::to_string(light) + "/" + member;
}

json pointer_target(const std::string& pointer) {
  return {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}};
}

/// Adds a clip of one channel, with keys at 0 and 2 seconds.
void animate_target(GltfBuilder& builder, const json& target, const char* type,
                    const std::vector<float>& values) {
  const auto times = builder.add_accessor(std::vector<float>{0, 2}, 5126, "SCALAR", 2);
  const auto output = builder.add_accessor(values, 5126, type, 2);
  builder.add("animations", {{"samplers", {{{"input", times}, {"output", output}}}},
                             {"channels", {{{"sampler", 0}, {"target", target}}}}});
}

/// A triangle, and two nodes with lights, which may be the same.
GltfBuilder two_light_nodes(int first, int second, const json& lights) {
  GltfBuilder builder = triangle();
  builder.json["extensionsUsed"] = {"KHR_lights_punctual", "KHR_animation_pointer"};
  builder.json["extensions"]["KHR_lights_punctual"]["lights"] = lights;
  const auto bulb = [&](const char* name, int light, float x) {
    const auto node =
        builder.add("nodes", {{"name", name},
                              {"translation", {x, 0, 2}},
                              {"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}});
    builder.json["scenes"][0]["nodes"].push_back(node);
  };
  bulb("left", first, -1.0f);
  bulb("right", second, 1.0f);
  return builder;
}

/// The members of lights that clips animate, as pairs of node name and property.
std::set<std::pair<std::string, Pointed>> animated_members(const Scene& scene) {
  std::set<std::pair<std::string, Pointed>> members;
  for (const Light& light : scene.lights) {
    for (const Clip& clip : scene.clips) {
      for (const Track& track : clip.tracks) {
        const bool own = light.punctual && track.object == light.punctual->number;
        if (own) members.emplace(light.name, track.property);
      }
    }
  }
  return members;
}

TEST(GlbExport, MovedLightsBecomeChildrenOfNodesThatClipsMove) {
  const struct {
    json target;
    const char* type;
    std::vector<float> values;
  } cases[] = {
      {{{"node", 1}, {"path", "translation"}}, "VEC3", {0, 0, 2, 0, 3, 2}},
      {pointer_target("/nodes/1/translation"), "VEC3", {0, 0, 2, 0, 3, 2}},
      {pointer_target("/nodes/1/rotation"), "VEC4", {0, 0, 0, 1, 0, 0, 1, 0}},
      {pointer_target("/nodes/1/scale"), "VEC3", {1, 1, 1, 2, 2, 2}},
  };
  for (const auto& [target, type, values] : cases) {
    GltfBuilder builder = two_light_nodes(0, 1, {{{"type", "point"}}, {{"type", "point"}}});
    animate_target(builder, target, type, values);
    Exported exported(builder);
    exported.edit_lights();
    exported.light(0).position = {1.0f, 1.0f, 1.0f};
    exported.light(1).position = {5.0f, 1.0f, 1.0f};
    exported.write();
    const json nodes = exported.document().at("nodes");
    ASSERT_EQ(nodes.size(), 4u) << target << ": one child, of the animated node";
    EXPECT_EQ(nodes[1].at("translation"), json({-1, 0, 2})) << target;
    EXPECT_FALSE(nodes[1].contains("matrix")) << target;
    EXPECT_EQ(nodes[1].at("children"), json::array({3})) << target;
    EXPECT_FALSE(nodes[2].contains("children")) << target;
    ASSERT_EQ(exported.after.clips.size(), 1u) << target;
    EXPECT_EQ(exported.after.clips[0].duration, 2.0f) << target;
    for (const Light& light : exported.after.lights) {
      const float x = light.name == "left" ? 1.0f : 5.0f;
      EXPECT_LT(glm::distance(light.device.position, glm::vec3(x, 1.0f, 1.0f)), 1e-5f) << target;
    }
  }
}

TEST(GlbExport, VisibilityOfANodeDoesNotHoldItsLight) {
  GltfBuilder builder = two_light_nodes(0, 1, {{{"type", "point"}}, {{"type", "point"}}});
  builder.json["extensionsUsed"].push_back("KHR_node_visibility");
  const auto times = builder.add_accessor(std::vector<float>{0, 2}, 5126, "SCALAR", 2);
  const auto output =
      builder.add_accessor(builder.add_view(std::vector<std::uint8_t>{0, 1}), 5121, "SCALAR", 2);
  const json target = pointer_target("/nodes/1/extensions/KHR_node_visibility/visible");
  builder.add("animations",
              {{"samplers", {{{"input", times}, {"output", output}, {"interpolation", "STEP"}}}},
               {"channels", {{{"sampler", 0}, {"target", target}}}}});
  Exported exported(builder);
  exported.edit_lights();
  exported.light(0).position = {1.0f, 1.0f, 1.0f};
  exported.write();
  EXPECT_EQ(exported.document().at("nodes").size(), 3u) << "its place moves with it";
}

/// A spot that two nodes share, with a clip for each of its members.
GltfBuilder shared_spot() {
  const json spot = {{"type", "spot"},
                     {"color", {0.5, 0.25, 0.25}},
                     {"intensity", 10},
                     {"range", 5},
                     {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.5}}}};
  GltfBuilder builder = two_light_nodes(0, 0, json::array({spot}));
  animate_target(builder, pointer_target(light_pointer(0, "color")), "VEC3", {1, 0, 0, 0, 1, 0});
  animate_target(builder, pointer_target(light_pointer(0, "intensity")), "SCALAR", {1, 10});
  animate_target(builder, pointer_target(light_pointer(0, "range")), "SCALAR", {3, 7});
  animate_target(builder, pointer_target(light_pointer(0, "spot/innerConeAngle")), "SCALAR",
                 {0.1f, 0.3f});
  animate_target(builder, pointer_target(light_pointer(0, "spot/outerConeAngle")), "SCALAR",
                 {0.6f, 0.9f});
  return builder;
}

constexpr Pointed all_of_spot[] = {Pointed::light_color, Pointed::light_intensity,
                                   Pointed::light_range, Pointed::inner_cone, Pointed::outer_cone};

TEST(GlbExport, CopiesOfSharedLightsAreAnimatedButForEditedMembers) {
  const struct {
    void (*edit)(LightChange&);
    std::set<Pointed> edited;
  } cases[] = {
      {[](LightChange& light) { light.device.radius = 0.25f; }, {}},
      {[](LightChange& light) { light.device.color *= 3.0f; }, {Pointed::light_intensity}},
      {[](LightChange& light) { light.off = true; }, {Pointed::light_intensity}},
      {[](LightChange& light) {
         light.device.color = {2.5f, 5.0f, 1.0f};
       },
       {Pointed::light_color}},
      {[](LightChange& light) {
         light.device.color = {0.0f, 1.0f, 0.0f};
       },
       {Pointed::light_color, Pointed::light_intensity}},
      {[](LightChange& light) { light.device.range = 0.0f; }, {Pointed::light_range}},
      {[](LightChange& light) {
         const float outer = -light.device.spot_offset / light.device.spot_scale;
         light.device.spot_scale = 1.0f / (std::cos(0.3f) - outer);
         light.device.spot_offset = -outer * light.device.spot_scale;
       },
       {Pointed::inner_cone}},
      {[](LightChange& light) {
         const float inner = (1.0f - light.device.spot_offset) / light.device.spot_scale;
         light.device.spot_scale = 1.0f / (inner - std::cos(0.7f));
         light.device.spot_offset = -std::cos(0.7f) * light.device.spot_scale;
       },
       {Pointed::outer_cone}},
  };
  for (std::size_t i = 0; i < std::size(cases); ++i) {
    Exported exported(shared_spot());
    exported.edit_lights();
    cases[i].edit(exported.changes.lights[1]);
    exported.write();
    const json document = exported.document();
    EXPECT_EQ(document.at("extensions").at("KHR_lights_punctual").at("lights").size(), 2u) << i;
    const auto animated = animated_members(exported.after);
    for (const Pointed member : all_of_spot) {
      EXPECT_TRUE(animated.contains({"left", member})) << i << ": of the unedited one";
      EXPECT_EQ(animated.contains({"right", member}), !cases[i].edited.contains(member)) << i;
    }
    EXPECT_EQ(exported.after.clips.size(), 5u) << i;
    for (const json& animation : document.at("animations")) {
      EXPECT_EQ(animation.at("samplers").size(), 1u) << i << ": the same one";
      for (const json& channel : animation.at("channels")) EXPECT_EQ(channel.at("sampler"), 0) << i;
    }
  }
}

TEST(GlbExport, CopiesAreAnimatedWithTheValuesOfTheOriginal) {
  Exported exported(shared_spot());
  exported.edit_lights();
  exported.light(0).range = 9.0f;
  exported.write();
  const Clip& clip = exported.after.clips.at(1);
  ASSERT_EQ(clip.tracks.size(), 2u);
  for (const Track& track : clip.tracks) EXPECT_FLOAT_EQ(value_of(track, 2.0f)[0], 10.0f);
  EXPECT_EQ(exported.after.lights[0].device.range, 9.0f);
  EXPECT_EQ(exported.after.lights[1].device.range, 5.0f);
}

TEST(GlbExport, EveryUserOfASharedLightCanBeEdited) {
  Exported exported(shared_spot());
  exported.edit_lights();
  exported.light(0).range = 9.0f;
  exported.light(1).color *= 2.0f;
  exported.write();
  const auto animated = animated_members(exported.after);
  for (const Pointed member : all_of_spot) {
    EXPECT_EQ(animated.contains({"left", member}), member != Pointed::light_range);
    EXPECT_EQ(animated.contains({"right", member}), member != Pointed::light_intensity);
  }
  EXPECT_EQ(exported.after.clips.size(), 5u);
}

TEST(GlbExport, EditedMembersOfALightAreNotAnimated) {
  GltfBuilder builder =
      two_light_nodes(0, 1, {{{"type", "point"}, {"range", 5}}, {{"type", "point"}}});
  animate_target(builder, pointer_target(light_pointer(0, "intensity")), "SCALAR", {1, 10});
  animate_target(builder, pointer_target(light_pointer(0, "range")), "SCALAR", {3, 7});
  animate_target(builder, pointer_target(light_pointer(1, "intensity")), "SCALAR", {1, 10});
  Exported exported(builder);
  exported.edit_lights();
  exported.light(0).color = glm::vec3(4.0f);
  exported.write();
  const std::set<std::pair<std::string, Pointed>> expected = {{"left", Pointed::light_range},
                                                              {"right", Pointed::light_intensity}};
  EXPECT_EQ(animated_members(exported.after), expected);
  EXPECT_EQ(exported.document().at("animations").size(), 2u) << "none without channels";
  exported.light(0).range = 0.0f;
  exported.light(1).color = glm::vec3(2.0f);
  exported.write();
  EXPECT_FALSE(exported.document().contains("animations"));
}

TEST(GlbExport, EditedColoursKeepTheScaleOfTheFile) {
  Exported exported(shared_spot());
  exported.edit_lights();
  exported.light(0).color = {0.0f, 5.0f, 2.5f};
  exported.light(1).color = {10.0f, 5.0f, 5.0f};
  exported.write();
  const json lights = exported.document().at("extensions").at("KHR_lights_punctual").at("lights");
  EXPECT_EQ(lights[1].at("color"), json({0.0, 0.5, 0.25})) << "that of the first, a copy";
  EXPECT_EQ(lights[1].at("intensity"), 10.0);
  EXPECT_EQ(lights[0].at("color"), json({0.5, 0.25, 0.25}));
  EXPECT_EQ(lights[0].at("intensity"), 20.0);
}

}  // namespace
}  // namespace heliograph::scene::test
