#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "tests/unit/scene/support/gltf_builder.hpp"

namespace heliograph::scene::test {
namespace {

using nlohmann::json;

struct Damage {
  const char* name;
  std::function<void(GltfBuilder&)> inflict;
  const char* expected;  // must appear in the refusal
};

void PrintTo(const Damage& damage, std::ostream* stream) {
  *stream << damage.name;
}

/// A buffer that a view refers to.
std::uint32_t add_buffer(GltfBuilder& b, const json& buffer) {
  const auto index = b.json["buffers"].size();
  b.json["buffers"].push_back(buffer);
  b.json["bufferViews"].push_back({{"buffer", index}, {"byteLength", 4}});
  return static_cast<std::uint32_t>(index);
}

json& primitive(GltfBuilder& b) {
  return b.json["meshes"][0]["primitives"][0];
}

template <typename T>
void overwrite(GltfBuilder& b, std::size_t view, std::size_t offset, T value) {
  const std::size_t start = b.json["bufferViews"][view]["byteOffset"].get<std::size_t>() + offset;
  std::memcpy(b.binary.data() + start, &value, sizeof value);
}

void add_sparse(GltfBuilder& b, std::uint32_t index, std::uint32_t count,
                std::size_t index_offset) {
  const auto indices = b.add_view(std::vector<std::uint32_t>{index, index});
  const auto values = b.add_view(std::vector<float>{1, 2, 3});
  b.json["accessors"][0]["sparse"] = {
      {"count", count},
      {"indices", {{"bufferView", indices}, {"componentType", 5125}, {"byteOffset", index_offset}}},
      {"values", {{"bufferView", values}}}};
}

const Damage damages[] = {
    {"NoAsset", [](auto& b) { b.json.erase("asset"); }, "asset"},
    {"AssetVersion1", [](auto& b) { b.json["asset"]["version"] = "1.0"; }, "asset.version"},
    {"AssetVersion3", [](auto& b) { b.json["asset"]["version"] = "3.0"; }, "asset.version"},
    {"AssetVersionNumber", [](auto& b) { b.json["asset"]["version"] = 2.0; }, "asset.version"},
    {"AssetMinVersion", [](auto& b) { b.json["asset"]["minVersion"] = "3.0"; }, "asset.minVersion"},
    {"UnknownRequiredExtension",
     [](auto& b) {
       b.json["extensionsRequired"] = {"EXT_unknown", "KHR_lights_punctual"};
     },
     "EXT_unknown"},
    {"ArrayIsObject", [](auto& b) { b.json["meshes"] = json::object(); },
     "meshes: must be an array"},
    {"ElementIsNumber", [](auto& b) { b.json["nodes"][1] = 5; }, "nodes[1]: must be an object"},

    {"BufferTooShort", [](auto& b) { b.json["buffers"][0]["byteLength"] = 1'000'000; },
     "buffers[0]"},
    {"BufferWithoutLength", [](auto& b) { b.json["buffers"][0].erase("byteLength"); },
     "is missing"},
    {"BufferWithoutData",
     [](auto& b) {
       add_buffer(b, {{"byteLength", 4}});
     },
     "buffers[1]"},
    {"ViewOfNoBuffer", [](auto& b) { b.json["bufferViews"][0]["buffer"] = 9; },
     "bufferViews[0].buffer"},
    {"ViewPastTheEnd", [](auto& b) { b.json["bufferViews"][0]["byteLength"] = 1u << 30; },
     "past the end"},
    {"ViewOffsetWraps",
     [](auto& b) { b.json["bufferViews"][0]["byteOffset"] = 0xffffffffffffffe0ull; },
     "past the end"},
    {"ViewNegativeOffset", [](auto& b) { b.json["bufferViews"][0]["byteOffset"] = -4; },
     "whole number"},
    {"ViewEmpty", [](auto& b) { b.json["bufferViews"][0]["byteLength"] = 0; }, "at least 1"},
    {"ViewStride", [](auto& b) { b.json["bufferViews"][0]["byteStride"] = 3; }, "byteStride"},

    {"AccessorOfNoView", [](auto& b) { b.json["accessors"][0]["bufferView"] = 99; },
     "99 is not an index"},
    {"AccessorPastTheEnd", [](auto& b) { b.json["accessors"][0]["count"] = 500; }, "past the end"},
    {"AccessorOffset", [](auto& b) { b.json["accessors"][0]["byteOffset"] = 4; }, "past the end"},
    {"AccessorOffsetWraps",
     [](auto& b) { b.json["accessors"][0]["byteOffset"] = 0xfffffffffffffffcull; }, "past the end"},
    {"AccessorCountHuge", [](auto& b) { b.json["accessors"][0]["count"] = 0xffffffffu; }, "limit"},
    {"AccessorCount64", [](auto& b) { b.json["accessors"][0]["count"] = 0x100000004ull; }, "limit"},
    {"AccessorCountZero", [](auto& b) { b.json["accessors"][0]["count"] = 0; }, "at least 1"},
    {"AccessorCountNegative", [](auto& b) { b.json["accessors"][0]["count"] = -1; },
     "whole number"},
    {"AccessorCountFraction", [](auto& b) { b.json["accessors"][0]["count"] = 1.5; },
     "whole number"},
    {"AccessorComponentType", [](auto& b) { b.json["accessors"][0]["componentType"] = 5130; },
     "5130"},
    {"AccessorDouble", [](auto& b) { b.json["accessors"][0]["componentType"] = 5124; }, "5124"},
    {"AccessorType", [](auto& b) { b.json["accessors"][0]["type"] = "VEC5"; }, "element type"},
    {"AccessorStrideTooSmall", [](auto& b) { b.json["bufferViews"][0]["byteStride"] = 8; },
     "wider than"},
    {"SparseIndexOutOfRange", [](auto& b) { add_sparse(b, 4, 1, 0); }, "index 4 is out of range"},
    {"SparseIndicesRepeat", [](auto& b) { add_sparse(b, 1, 2, 0); }, "ascend"},
    {"SparseCount", [](auto& b) { add_sparse(b, 1, 5, 0); }, "count"},
    {"SparsePastTheEnd", [](auto& b) { add_sparse(b, 1, 1, 400); }, "past the end"},
    {"SparseWithoutValues",
     [](auto& b) {
       add_sparse(b, 1, 1, 0);
       b.json["accessors"][0]["sparse"].erase("values");
     },
     "values"},

    {"IndexOutOfRange", [](auto& b) { overwrite<std::uint16_t>(b, 3, 4, 4); },
     "index 4 is out of range"},
    {"PrimitiveRestart", [](auto& b) { overwrite<std::uint16_t>(b, 3, 4, 0xffff); },
     "65535 is out of range"},
    {"IndicesOfFloats", [](auto& b) { primitive(b)["indices"] = 0; }, "cannot hold indices"},
    {"IndicesOfNothing", [](auto& b) { primitive(b)["indices"] = 77; }, "indices: 77"},
    {"PositionNaN", [](auto& b) { overwrite(b, 0, 8, std::numeric_limits<float>::quiet_NaN()); },
     "not finite"},
    {"PositionInfinite",
     [](auto& b) { overwrite(b, 0, 8, std::numeric_limits<float>::infinity()); }, "not finite"},
    {"PositionFarOut", [](auto& b) { overwrite(b, 0, 8, 3e38f); }, "coordinate limit"},
    {"UvNaN", [](auto& b) { overwrite(b, 2, 0, std::numeric_limits<float>::quiet_NaN()); },
     "not finite"},
    {"PositionIsVec2", [](auto& b) { primitive(b)["attributes"]["POSITION"] = 2; }, "element type"},
    {"AttributeOfNothing", [](auto& b) { primitive(b)["attributes"]["POSITION"] = 42; },
     "POSITION: 42"},
    {"UnknownAttributeOfNothing", [](auto& b) { primitive(b)["attributes"]["_MINE"] = 42; },
     "_MINE: 42"},
    {"AttributeCounts", [](auto& b) { b.json["accessors"][1]["count"] = 3; }, "differs in count"},
    {"NoAttributes", [](auto& b) { primitive(b).erase("attributes"); }, "attributes"},
    {"NoPrimitives", [](auto& b) { b.json["meshes"][0]["primitives"] = json::array(); },
     "primitives: must not be empty"},
    {"PrimitiveMode", [](auto& b) { primitive(b)["mode"] = 7; }, "mode"},
    {"MaterialOfNothing", [](auto& b) { primitive(b)["material"] = 1; },
     "1 is not an index into 1 materials"},
    {"MorphTargetOfNothing",
     [](auto& b) {
       primitive(b)["targets"] = {{{"POSITION", 50}}};
     },
     "POSITION: 50"},
    {"MorphTargetCount",
     [](auto& b) {
       primitive(b)["targets"] = {{{"POSITION", 3}}};
     },
     "differs in count"},

    {"TextureOfNothing", [](auto& b) { b.json["materials"][0]["normalTexture"]["index"] = 4; },
     "normalTexture.index: 4"},
    {"TextureIndexNegative", [](auto& b) { b.json["materials"][0]["normalTexture"]["index"] = -1; },
     "whole number"},
    {"TextureIndexWraps",
     [](auto& b) { b.json["materials"][0]["normalTexture"]["index"] = 0x100000000ull; },
     "not an index"},
    {"TextureWithoutIndex", [](auto& b) { b.json["materials"][0]["normalTexture"].erase("index"); },
     "missing"},
    {"ImageOfNothing", [](auto& b) { b.json["textures"][0]["source"] = 3; },
     "textures[0].source: 3"},
    {"SamplerOfNothing", [](auto& b) { b.json["textures"][0]["sampler"] = 3; },
     "textures[0].sampler: 3"},
    {"SamplerWrap", [](auto& b) { b.json["samplers"][0]["wrapS"] = 1; }, "wrapS"},
    {"SamplerFilter", [](auto& b) { b.json["samplers"][0]["minFilter"] = 1; }, "minFilter"},
    {"AlphaMode", [](auto& b) { b.json["materials"][0]["alphaMode"] = "GLASS"; }, "alphaMode"},
    {"FactorOfFive",
     [](auto& b) {
       b.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 1, 1};
     },
     "array of 4 numbers"},
    {"FactorIsText",
     [](auto& b) { b.json["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = "one"; },
     "metallicFactor"},
    {"FactorTooLarge",
     [](auto& b) {
       b.json["materials"][0]["emissiveFactor"] = {1e300, 0, 0};
     },
     "emissiveFactor"},
    {"EmissiveNegative",
     [](auto& b) {
       b.json["materials"][0]["emissiveFactor"] = {-1, 0, 0};
     },
     "negative"},

    {"NodeCycle", [](auto& b) { b.json["nodes"][1]["children"] = {0}; }, "cycle"},
    {"NodeOwnChild",
     [](auto& b) {
       b.json["nodes"].push_back({{"children", {3}}});
     },
     "cycle"},
    {"NodeTwoParents", [](auto& b) { b.json["nodes"][1]["children"] = {2}; },
     "nodes[2]: has more than one"},
    {"NodeChildTwice",
     [](auto& b) {
       b.json["nodes"][0]["children"] = {1, 1};
     },
     "more than one parent"},
    {"NodeChildOfNothing", [](auto& b) { b.json["nodes"][0]["children"] = {9}; }, "children: 9"},
    {"NodeMeshOfNothing", [](auto& b) { b.json["nodes"][0]["mesh"] = 5; }, "nodes[0].mesh: 5"},
    {"NodeCameraOfNothing", [](auto& b) { b.json["nodes"][1]["camera"] = 5; },
     "nodes[1].camera: 5"},
    {"NodeSkinOfNothing", [](auto& b) { b.json["nodes"][0]["skin"] = 5; }, "nodes[0].skin: 5"},
    {"NodeLightOfNothing",
     [](auto& b) { b.json["nodes"][2]["extensions"]["KHR_lights_punctual"]["light"] = 5; },
     "light: 5"},
    {"Matrix17", [](auto& b) { b.json["nodes"][0]["matrix"] = std::vector<int>(17, 1); },
     "16 numbers"},
    {"MatrixProjective", [](auto& b) { b.json["nodes"][0]["matrix"] = std::vector<int>(16, 1); },
     "not affine"},
    {"RotationZero",
     [](auto& b) {
       b.json["nodes"][0]["rotation"] = {0, 0, 0, 0};
     },
     "quaternion"},
    {"TranslationIsText",
     [](auto& b) {
       b.json["nodes"][0]["translation"] = {"a", 0, 0};
     },
     "3 numbers"},
    {"SceneOfNothing", [](auto& b) { b.json["scene"] = 1; }, "scene: 1"},
    {"SceneNodeOfNothing", [](auto& b) { b.json["scenes"][0]["nodes"] = {7}; },
     "scenes[0].nodes: 7"},
    {"SceneNodeTwice",
     [](auto& b) {
       b.json["scenes"][0]["nodes"] = {0, 0};
     },
     "twice"},

    {"CameraType", [](auto& b) { b.json["cameras"][0]["type"] = "fisheye"; }, "cameras[0].type"},
    {"CameraWithoutLens", [](auto& b) { b.json["cameras"][0].erase("perspective"); }, "missing"},
    {"CameraFov", [](auto& b) { b.json["cameras"][0]["perspective"]["yfov"] = 0; }, "yfov"},
    {"CameraNear", [](auto& b) { b.json["cameras"][0]["perspective"]["znear"] = 0; }, "znear"},
    {"LightType",
     [](auto& b) { b.json["extensions"]["KHR_lights_punctual"]["lights"][0]["type"] = "laser"; },
     "type"},
    {"LightNegative",
     [](auto& b) { b.json["extensions"]["KHR_lights_punctual"]["lights"][0]["intensity"] = -1; },
     "negative"},
    {"LightCone",
     [](auto& b) {
       b.json["extensions"]["KHR_lights_punctual"]["lights"][0] = {
           {"type", "spot"}, {"spot", {{"innerConeAngle", 1.0}, {"outerConeAngle", 0.5}}}};
     },
     "innerConeAngle"},
    {"SunAngle", [](auto& b) { b.json["nodes"][2]["extras"]["angularDiameterDeg"] = 360; },
     "must be from 0 to 90"},

    {"SkinJoint",
     [](auto& b) {
       b.json["skins"][0]["joints"] = {1, 30};
     },
     "joints: 30"},
    {"SkinWithoutJoints", [](auto& b) { b.json["skins"][0].erase("joints"); }, "joints"},
    {"SkinMatrices", [](auto& b) { b.json["skins"][0]["inverseBindMatrices"] = 0; }, "4x4"},
    {"AnimationSampler", [](auto& b) { b.json["animations"][0]["channels"][0]["sampler"] = 2; },
     "sampler: 2"},
    {"AnimationNode",
     [](auto& b) { b.json["animations"][0]["channels"][0]["target"]["node"] = 33; }, "node: 33"},
    {"AnimationPath",
     [](auto& b) { b.json["animations"][0]["channels"][0]["target"]["path"] = "color"; }, "path"},
    {"AnimationInput", [](auto& b) { b.json["animations"][0]["samplers"][0]["input"] = 0; },
     "scalars"},

    {"ImageWithoutPixels",
     [](auto& b) { b.json["images"][0]["bufferView"] = b.add_view(png(0, 0, 4, {})); },
     "images[0]"},
    {"ImageHuge",
     [](auto& b) { b.json["images"][0]["bufferView"] = b.add_view(png(60000, 60000, 4, {})); },
     "images[0]"},
    {"ImageCut",
     [](auto& b) {
       Bytes file = png(16, 16, 4, Bytes(1024, 9));
       file.resize(file.size() / 2);
       b.json["images"][0]["bufferView"] = b.add_view(file);
     },
     "images[0]"},
    {"ImageOtherFormat",
     [](auto& b) { b.json["images"][0]["bufferView"] = b.add_view(Bytes(100, 'x')); },
     "neither PNG, JPEG, WebP nor KTX2"},
    {"ImageWithoutSource", [](auto& b) { b.json["images"][0].erase("bufferView"); },
     "neither a uri"},
};

class MalformedDocument : public testing::TestWithParam<Damage> {};

TEST_P(MalformedDocument, IsRejectedWithReason) {
  GltfBuilder builder = everything();
  ASSERT_EQ(refusal_of(builder), "");
  GetParam().inflict(builder);
  const std::string refusal = refusal_of(builder);
  EXPECT_NE(refusal.find(GetParam().expected), std::string::npos)
      << (refusal.empty() ? "accepted" : refusal);
}

INSTANTIATE_TEST_SUITE_P(Damages, MalformedDocument, testing::ValuesIn(damages),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace heliograph::scene::test
