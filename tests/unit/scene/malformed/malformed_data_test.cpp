// Valid JSON with invalid content: wrong types, numbers out of range, node graphs that are no
// trees, and data that does not match its description.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "tests/unit/scene/malformed/malformed.hpp"
#include "tests/unit/scene/malformed/rich_document.hpp"

namespace heliograph::scene::test {
namespace {

using nlohmann::json;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

template <typename T>
std::uint32_t add(GltfBuilder& document, const std::vector<T>& values, int component,
                  std::string_view type, std::size_t count) {
  return document.add_accessor(values, component, type, count);
}

class MalformedData : public Malformed {
 protected:
  json& at(GltfBuilder& document, const std::string& place) const {
    return document.json.at(json::json_pointer(place));
  }

  void refuse(const std::string& place, const json& value, std::string_view named) {
    GltfBuilder damaged = good_;
    damaged.json[json::json_pointer(place)] = value;
    expect_refused(place + " = " + value.dump(), damaged, named);
  }

  /// Overwrites a component of the accessor that member `place` refers to.
  void refuse_number(const std::string& place, std::size_t component, float value) {
    GltfBuilder damaged = good_;
    const auto accessor = at(damaged, place).get<std::size_t>();
    const auto view = damaged.json["accessors"][accessor]["bufferView"].get<std::size_t>();
    const auto offset = damaged.json["bufferViews"][view]["byteOffset"].get<std::size_t>();
    std::memcpy(damaged.binary.data() + offset + 4 * component, &value, sizeof value);
    expect_refused(place + " holds " + std::to_string(value), damaged, "");
  }

  const GltfBuilder good_ = rich_document();
};

TEST_F(MalformedData, NumbersOutOfRange) {
  const struct {
    const char* place;
    json value;
  } cases[] = {
      {"/cameras/0/perspective/yfov", 0},
      {"/cameras/0/perspective/yfov", -1},
      {"/cameras/0/perspective/znear", 0},
      {"/cameras/0/perspective/znear", -1},
      {"/cameras/0/perspective/zfar", 0.1},
      {"/cameras/0/perspective/zfar", -5},
      {"/cameras/0/perspective/aspectRatio", 0},
      {"/cameras/0/perspective/aspectRatio", -2},
      {"/cameras/1/orthographic/ymag", 0},
      {"/cameras/1/orthographic/xmag", 0},
      {"/cameras/1/orthographic/zfar", 0.05},
      {"/cameras/1/orthographic/znear", -1},
      {"/materials/0/alphaCutoff", -0.5},
      {"/materials/0/emissiveFactor", {-1, 0, 0}},
      {"/materials/0/extensions/KHR_materials_ior/ior", 0.5},
      {"/materials/0/extensions/KHR_materials_ior/ior", -1},
      {"/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength", -1},
      {"/materials/0/extensions/KHR_materials_transmission/transmissionFactor", 1.5},
      {"/materials/0/extensions/KHR_materials_transmission/transmissionFactor", -0.5},
      {"/materials/0/extensions/KHR_materials_clearcoat/clearcoatFactor", 2},
      {"/materials/0/extensions/KHR_materials_specular/specularFactor", -1},
      {"/materials/0/extensions/KHR_materials_iridescence/iridescenceFactor", 2},
      {"/materials/0/extensions/KHR_materials_iridescence/iridescenceIor", 0.9},
      {"/materials/0/extensions/KHR_materials_iridescence/iridescenceThicknessMaximum", -1},
      {"/materials/0/extensions/KHR_materials_anisotropy/anisotropyStrength", 1.5},
      {"/materials/0/extensions/KHR_materials_dispersion/dispersion", -1},
      {"/materials/0/extensions/KHR_materials_diffuse_transmission/diffuseTransmissionFactor", 1.5},
      {"/materials/0/extensions/KHR_materials_diffuse_transmission/diffuseTransmissionColorFactor",
       {1, 1, 2}},
      {"/materials/0/extensions/KHR_materials_volume/attenuationDistance", -1},
      {"/materials/0/extensions/KHR_materials_volume/thicknessFactor", -1},
      {"/extensions/KHR_lights_punctual/lights/0/intensity", -1},
      {"/extensions/KHR_lights_punctual/lights/0/color", {1, -1, 1}},
      {"/extensions/KHR_lights_punctual/lights/1/range", 0},
      {"/extensions/KHR_lights_punctual/lights/1/range", -1},
      {"/extensions/KHR_lights_punctual/lights/1/spot/innerConeAngle", -1},
      {"/extensions/KHR_lights_punctual/lights/1/spot/innerConeAngle", 0.5},
      {"/extensions/KHR_lights_punctual/lights/1/spot/outerConeAngle", 2},
      {"/nodes/2/extras/angularDiameterDeg", -1},
      {"/nodes/2/extras/angularDiameterDeg", 91},
      {"/nodes/4/extras/radius", -1},
      {"/nodes/5/extras/areaLight/width", 0},
      {"/nodes/5/extras/areaLight/height", -1},
      {"/nodes/5/extras/areaLight/width", 1e9},
      {"/nodes/1/rotation", {0, 0, 0, 0}},
      {"/accessors/0/componentType", 5120.5},
      {"/accessors/0/componentType", 5124},
      {"/accessors/0/componentType", 0},
      {"/bufferViews/0/byteStride", 3},
      {"/bufferViews/0/byteStride", 2},
      {"/bufferViews/0/byteStride", 256},
      {"/samplers/0/wrapS", 10496},
      {"/samplers/0/wrapT", 0},
      {"/samplers/0/magFilter", 9984},
      {"/samplers/0/minFilter", 9983},
      {"/meshes/0/primitives/0/mode", 7},
      {"/meshes/0/primitives/0/mode", -1},
      {"/materials/0/normalTexture/texCoord", -1},
      {"/materials/0/normalTexture/texCoord", 0.5},
      {"/accessors/0/count", 0},
      {"/buffers/0/byteLength", 0},
      {"/bufferViews/0/byteLength", 0},
      {"/accessors/5/sparse/count", 0},
  };
  for (const auto& [place, value] : cases) refuse(place, value, named_in_errors(place));
}

// Factors outside 0..1 are common in files and harmless: clamped, with a warning.
TEST_F(MalformedData, FactorsOutOfRangeAreClamped) {
  for (const char* const place : {"/materials/0/pbrMetallicRoughness/metallicFactor",
                                  "/materials/0/pbrMetallicRoughness/roughnessFactor",
                                  "/materials/0/occlusionTexture/strength"}) {
    for (const json& value : {json(-1), json(2), json(1e30)}) {
      GltfBuilder damaged = good_;
      damaged.json[json::json_pointer(place)] = value;
      expect_loaded(place, damaged);
      const auto warnings = damaged.import().warnings;
      EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), [&](const std::string& warning) {
        return warning.find(named_in_errors(place)) != std::string::npos;
      }));
    }
  }
}

TEST_F(MalformedData, AttributesOfWrongType) {
  const struct {
    const char* place;
    std::vector<std::string_view> wrong;
  } cases[] = {
      {"/meshes/0/primitives/0/attributes/POSITION", {"SCALAR", "VEC2", "MAT2", "MAT3", "MAT4"}},
      {"/meshes/0/primitives/0/attributes/NORMAL", {"SCALAR", "VEC2", "MAT2"}},
      {"/meshes/0/primitives/0/attributes/TEXCOORD_0", {"SCALAR", "VEC3", "VEC4", "MAT2"}},
      {"/meshes/0/primitives/0/attributes/COLOR_0", {"SCALAR", "VEC2", "MAT2"}},
      {"/meshes/1/primitives/0/attributes/JOINTS_0", {"SCALAR", "VEC2", "VEC3", "MAT2"}},
      {"/meshes/1/primitives/0/attributes/WEIGHTS_0", {"SCALAR", "VEC2", "VEC3", "MAT2"}},
      {"/meshes/1/primitives/0/targets/0/POSITION", {"SCALAR", "VEC2", "VEC4", "MAT2"}},
      {"/meshes/0/primitives/0/indices", {"VEC2", "VEC3", "VEC4", "MAT2"}},
      {"/animations/0/samplers/0/input", {"VEC2", "VEC3", "VEC4", "MAT2"}},
      {"/animations/0/samplers/0/output", {"SCALAR", "VEC2", "VEC4", "MAT2"}},
      {"/animations/0/samplers/1/output", {"SCALAR", "VEC2", "VEC3", "MAT2"}},
      {"/skins/0/inverseBindMatrices", {"SCALAR", "VEC4", "MAT2", "MAT3"}},
      {"/nodes/6/extensions/EXT_mesh_gpu_instancing/attributes/TRANSLATION",
       {"SCALAR", "VEC2", "VEC4", "MAT3"}},
  };
  for (const auto& [place, wrong] : cases) {
    for (const std::string_view type : wrong) {
      GltfBuilder damaged = good_;
      // A new accessor of zeros: only its type is wrong.
      json accessor = good_.json["accessors"][at(damaged, place).get<std::size_t>()];
      accessor.erase("bufferView");
      accessor.erase("sparse");
      accessor["type"] = type;
      at(damaged, place) = damaged.add("accessors", accessor);
      expect_refused(std::string(place) + " of " + std::string(type), damaged, "");
    }
  }
}

TEST_F(MalformedData, AttributesOfWrongComponentType) {
  const struct {
    const char* place;
    std::vector<int> wrong;
  } cases[] = {
      {"/meshes/0/primitives/0/attributes/POSITION", {5125}},
      {"/meshes/0/primitives/0/attributes/TEXCOORD_0", {5125}},
      {"/meshes/0/primitives/0/attributes/COLOR_0", {5125}},
      {"/meshes/1/primitives/0/attributes/JOINTS_0", {5120, 5122, 5125, 5126}},
      {"/meshes/0/primitives/0/indices", {5120, 5122, 5126}},
      {"/animations/0/samplers/0/input", {5120, 5121, 5122, 5123, 5125}},
      {"/animations/0/samplers/0/output", {5120, 5121, 5122, 5123, 5125}},
      {"/skins/0/inverseBindMatrices", {5120, 5121, 5122, 5123, 5125}},
      {"/nodes/6/extensions/EXT_mesh_gpu_instancing/attributes/TRANSLATION",
       {5120, 5121, 5122, 5123, 5125}},
  };
  for (const auto& [place, wrong] : cases) {
    for (const int component : wrong) {
      GltfBuilder damaged = good_;
      json accessor = good_.json["accessors"][at(damaged, place).get<std::size_t>()];
      accessor.erase("bufferView");
      accessor["componentType"] = component;
      at(damaged, place) = damaged.add("accessors", accessor);
      expect_refused(std::string(place) + " of " + std::to_string(component), damaged, "");
    }
  }
}

TEST_F(MalformedData, MismatchedCounts) {
  for (const char* const place :
       {"/meshes/0/primitives/0/attributes/NORMAL", "/meshes/0/primitives/0/attributes/TEXCOORD_0",
        "/meshes/0/primitives/0/attributes/COLOR_0", "/meshes/1/primitives/0/attributes/JOINTS_0",
        "/meshes/1/primitives/0/attributes/WEIGHTS_0", "/meshes/1/primitives/0/targets/0/POSITION",
        "/animations/0/samplers/0/output", "/animations/0/samplers/2/output"}) {
    for (const int change : {-1, 1, 1000}) {
      GltfBuilder damaged = good_;
      json accessor = good_.json["accessors"][at(damaged, place).get<std::size_t>()];
      accessor.erase("bufferView");
      accessor["count"] = accessor["count"].get<int>() + change;
      at(damaged, place) = damaged.add("accessors", accessor);
      expect_refused(std::string(place) + " by " + std::to_string(change), damaged, "");
    }
  }
  GltfBuilder damaged = good_;
  damaged
      .json["accessors"][at(damaged, "/skins/0/inverseBindMatrices").get<std::size_t>()]["count"] =
      1;
  expect_refused("too few matrices", damaged, "skins[0].inverseBindMatrices");
}

TEST_F(MalformedData, NonFiniteNumbers) {
  for (const char* const place :
       {"/meshes/0/primitives/0/attributes/POSITION", "/meshes/0/primitives/0/attributes/NORMAL",
        "/meshes/0/primitives/0/attributes/TEXCOORD_0",
        "/meshes/1/primitives/0/attributes/POSITION", "/meshes/1/primitives/0/attributes/WEIGHTS_0",
        "/meshes/1/primitives/0/targets/0/POSITION", "/skins/0/inverseBindMatrices",
        "/animations/0/samplers/0/input", "/animations/0/samplers/0/output",
        "/animations/0/samplers/1/output", "/animations/0/samplers/2/output",
        "/nodes/6/extensions/EXT_mesh_gpu_instancing/attributes/TRANSLATION"}) {
    for (const float value : {nan, infinity, -infinity}) {
      refuse_number(place, 0, value);
      refuse_number(place, 1, value);
    }
  }
}

TEST_F(MalformedData, InconsistentValues) {
  refuse_number("/meshes/1/primitives/0/attributes/WEIGHTS_0", 2, -1.0f);
  refuse_number("/meshes/0/primitives/0/attributes/POSITION", 0, 3e38f);
  refuse_number("/animations/0/samplers/0/input", 0, -1.0f);
  refuse_number("/animations/0/samplers/0/input", 0, 2.0f);
}

TEST_F(MalformedData, InvalidVertexIndices) {
  const auto refuse_indices = [&]<typename T>(int component, T last) {
    GltfBuilder damaged = good_;
    at(damaged, "/meshes/0/primitives/0/indices") =
        damaged.add_accessor(std::vector<T>{0, 1, last}, component, "SCALAR", 3);
    expect_refused(std::to_string(last), damaged, "out of range");
  };
  for (const std::uint8_t last : {4, 5, 127, 128, 254, 255}) refuse_indices(5121, last);
  for (const std::uint16_t last : {4, 256, 32768, 65534, 65535}) refuse_indices(5123, last);
  for (const std::uint32_t last : {4u, 65536u, 0x7fffffffu, 0x80000000u, 0xffffffffu}) {
    refuse_indices(5125, last);
  }
}

TEST_F(MalformedData, InvalidJoints) {
  GltfBuilder damaged = good_;
  const auto accessor =
      at(damaged, "/meshes/1/primitives/0/attributes/JOINTS_0").get<std::size_t>();
  const auto view = damaged.json["accessors"][accessor]["bufferView"].get<std::size_t>();
  const auto offset = damaged.json["bufferViews"][view]["byteOffset"].get<std::size_t>();
  for (const std::uint8_t joint : {2, 3, 200, 255}) {
    damaged.binary[offset] = joint;
    expect_refused("joint " + std::to_string(joint), damaged, "nodes[3].mesh: joint");
  }
}

TEST_F(MalformedData, InvalidSparseIndices) {
  const auto with_sparse = [&](const std::vector<std::uint32_t>& indices) {
    GltfBuilder damaged = good_;
    json& sparse = at(damaged, "/accessors/5/sparse");
    sparse["count"] = indices.size();
    sparse["indices"]["bufferView"] = damaged.add_view(indices);
    at(damaged, "/accessors/5/sparse/values/bufferView") =
        damaged.add_view(std::vector<float>(3 * indices.size(), 1.0f));
    return damaged;
  };
  expect_loaded("in order", with_sparse({0, 1, 3}));
  expect_refused("out of range", with_sparse({4}), "accessors[5].sparse.indices");
  expect_refused("far out of range", with_sparse({0, 0xffffffffu}), "accessors[5].sparse.indices");
  expect_refused("twice", with_sparse({1, 1}), "accessors[5].sparse.indices");
  expect_refused("falling", with_sparse({2, 1}), "accessors[5].sparse.indices");
  expect_refused("more than there are", with_sparse({0, 1, 2, 3, 3}), "accessors[5].sparse.count");
  refuse("/accessors/5/sparse/indices/componentType", 5126, "accessors[5].sparse.indices");
  refuse("/accessors/5/sparse/indices/componentType", 5122, "accessors[5].sparse.indices");
}

TEST_F(MalformedData, CyclicAndSharedNodes) {
  for (int length = 1; length <= 20; ++length) {
    GltfBuilder damaged = good_;
    const int first = static_cast<int>(damaged.json["nodes"].size());
    for (int i = 0; i < length; ++i) {
      damaged.add("nodes", {{"children", {first + (i + 1) % length}}});
    }
    expect_refused("a ring of " + std::to_string(length), damaged, "nodes: the hierarchy");
  }
  GltfBuilder diamond = good_;
  const int first = static_cast<int>(diamond.json["nodes"].size());
  diamond.add("nodes", {{"children", {first + 1, first + 2}}});
  diamond.add("nodes", {{"children", {first + 3}}});
  diamond.add("nodes", {{"children", {first + 3}}});
  diamond.add("nodes", json::object());
  expect_refused("a diamond", diamond, "has more than one parent");
  // Each node refers to the next one twice: 2^30 leaves if they were traversed.
  GltfBuilder doubling = good_;
  for (int i = 0; i < 30; ++i) {
    const int next = static_cast<int>(doubling.json["nodes"].size()) + 1;
    doubling.add("nodes", {{"children", {next, next}}});
  }
  doubling.add("nodes", json::object());
  expect_refused("doubling", doubling, "has more than one parent");
  refuse("/scenes/0/nodes", {0, 0}, "scenes[0].nodes");
  refuse("/nodes/0/children", {1, 1}, "nodes[1]: has more than one parent");
  refuse("/nodes/0/children", {0}, "cycle");
}

TEST_F(MalformedData, InvalidAnimations) {
  GltfBuilder twice = good_;
  at(twice, "/animations/0/channels").push_back(at(twice, "/animations/0/channels/0"));
  expect_refused("a property twice", twice, "animations[0].channels[3].target");
  refuse("/animations/0/channels/0/target/path", "rotation", "");
  refuse("/animations/0/samplers/2/interpolation", "LINEAR", "animations[0].samplers[2].output");
  refuse("/animations/0/samplers/0/interpolation", "CUBICSPLINE",
         "animations[0].samplers[0].output");
  refuse("/animations/0/samplers", json::array(), "animations[0]");
  refuse("/animations/0/channels", json::array(), "animations[0]");
}

// Small files that claim large amounts of memory.
TEST_F(MalformedData, SmallFilesWithHugeClaims) {
  GltfBuilder zeros = triangle();
  zeros.json["accessors"][0].erase("bufferView");
  zeros.json["accessors"][0]["count"] = 60'000'001;
  expect_refused("more zeros than the limit", zeros, "accessors[0].count");

  zeros.json["accessors"][0]["count"] = 59'999'999;
  expect_refused("four gigabytes of vertices at one place", zeros, "geometry and animations");

  GltfBuilder sparse = good_;
  for (int i = 0; i < 2000; ++i) sparse.add("accessors", sparse.json["accessors"][5]);
  expect_loaded("many accessors over the same replacements", sparse);

  GltfBuilder places = good_;
  json accessor = {{"componentType", 5126}, {"type", "VEC3"}, {"count", 200'001}};
  at(places, "/nodes/6/extensions/EXT_mesh_gpu_instancing/attributes/TRANSLATION") =
      places.add("accessors", accessor);
  expect_refused("more places than the limit", places, "nodes[6].extensions");

  GltfBuilder keys = good_;
  std::vector<float> times(250'000);
  for (std::size_t i = 0; i < times.size(); ++i) times[i] = float(i);
  const auto input = add(keys, times, 5126, "SCALAR", times.size());
  const auto output =
      keys.add("accessors", {{"componentType", 5126}, {"type", "VEC3"}, {"count", times.size()}});
  json channels = json::array();
  for (int i = 0; i < 600; ++i) {
    const auto node = keys.add("nodes", json::object());
    at(keys, "/scenes/0/nodes").push_back(node);
    channels.push_back({{"sampler", 0}, {"target", {{"node", node}, {"path", "translation"}}}});
  }
  keys.json["animations"] = {
      {{"samplers", {{{"input", input}, {"output", output}}}}, {"channels", channels}}};
  expect_refused("keys that 600 nodes share", keys, "animations[0].samplers[0]");

  GltfBuilder skins = good_;
  const auto matrices =
      skins.add("accessors", {{"componentType", 5126}, {"type", "MAT4"}, {"count", 50'000'000}});
  for (int i = 0; i < 3000; ++i) {
    skins.add("skins", {{"joints", {1, 2}}, {"inverseBindMatrices", matrices}});
  }
  expect_loaded("matrices that unknown asks for", skins);

  GltfBuilder crowd = good_;
  const auto vertices =
      crowd.add("accessors", {{"componentType", 5126}, {"type", "VEC3"}, {"count", 3000}});
  const json target = {{"POSITION", vertices}};
  crowd.json["meshes"][3] = {{"primitives",
                              {{{"attributes", {{"POSITION", vertices}, {"NORMAL", vertices}}},
                                {"targets", std::vector<json>(100, target)}}}}};
  for (int i = 0; i < 3000; ++i) {
    at(crowd, "/scenes/0/nodes").push_back(crowd.add("nodes", {{"mesh", 3}}));
  }
  expect_refused("3000 times a mesh with 100 morph targets", crowd, "geometry and animations");

  GltfBuilder meshopt = good_;
  json& packed = at(meshopt, "/bufferViews/15");
  packed["byteLength"] = 0x3fffffffcull;
  expect_refused("an unpacked view of 16 GiB", meshopt, "bufferViews[15]");
}

}  // namespace
}  // namespace heliograph::scene::test
