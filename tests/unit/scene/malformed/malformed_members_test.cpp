// Damage to single members: every member of a kind gets every value that is invalid for it.
#include <gtest/gtest.h>

#include "tests/unit/scene/malformed/malformed.hpp"
#include "tests/unit/scene/malformed/rich_document.hpp"

namespace heliograph::scene::test {
namespace {

using nlohmann::json;

// All members that are indices.
const char* const indices[] = {
    "/scene",
    "/scenes/0/nodes/0",
    "/scenes/0/extensions/EXT_lights_image_based/light",
    "/nodes/0/children/0",
    "/nodes/0/mesh",
    "/nodes/1/camera",
    "/nodes/3/skin",
    "/nodes/2/extensions/KHR_lights_punctual/light",
    "/nodes/6/extensions/EXT_mesh_gpu_instancing/attributes/TRANSLATION",
    "/meshes/0/primitives/0/indices",
    "/meshes/0/primitives/0/material",
    "/meshes/0/primitives/0/attributes/POSITION",
    "/meshes/0/primitives/0/attributes/NORMAL",
    "/meshes/0/primitives/0/attributes/TEXCOORD_0",
    "/meshes/0/primitives/0/attributes/COLOR_0",
    "/meshes/0/primitives/0/extensions/KHR_materials_variants/mappings/0/material",
    "/meshes/0/primitives/0/extensions/KHR_materials_variants/mappings/0/variants/0",
    "/meshes/1/primitives/0/attributes/JOINTS_0",
    "/meshes/1/primitives/0/attributes/WEIGHTS_0",
    "/meshes/1/primitives/0/targets/0/POSITION",
    "/meshes/2/primitives/0/extensions/KHR_draco_mesh_compression/bufferView",
    "/materials/0/pbrMetallicRoughness/baseColorTexture/index",
    "/materials/0/pbrMetallicRoughness/metallicRoughnessTexture/index",
    "/materials/0/normalTexture/index",
    "/materials/0/occlusionTexture/index",
    "/materials/0/emissiveTexture/index",
    "/materials/0/extensions/KHR_materials_clearcoat/clearcoatTexture/index",
    "/textures/0/source",
    "/textures/0/sampler",
    "/textures/1/extensions/EXT_texture_webp/source",
    "/images/0/bufferView",
    "/accessors/0/bufferView",
    "/accessors/5/sparse/indices/bufferView",
    "/accessors/5/sparse/values/bufferView",
    "/bufferViews/0/buffer",
    "/animations/0/channels/0/sampler",
    "/animations/0/channels/0/target/node",
    "/animations/0/samplers/0/input",
    "/animations/0/samplers/0/output",
    "/skins/0/joints/0",
    "/skins/0/skeleton",
    "/skins/0/inverseBindMatrices",
};

const char* const counts[] = {
    "/accessors/0/count",
    "/accessors/0/byteOffset",
    "/accessors/5/sparse/count",
    "/accessors/5/sparse/indices/byteOffset",
    "/accessors/5/sparse/values/byteOffset",
    "/buffers/0/byteLength",
    "/bufferViews/0/byteLength",
    "/bufferViews/0/byteOffset",
    "/bufferViews/0/byteStride",
    "/extensions/EXT_lights_image_based/lights/0/specularImageSize",
};

// Required members.
const char* const required[] = {
    "/asset",
    "/asset/version",
    "/accessors/0/componentType",
    "/accessors/0/count",
    "/accessors/0/type",
    "/accessors/5/sparse/count",
    "/accessors/5/sparse/indices",
    "/accessors/5/sparse/indices/bufferView",
    "/accessors/5/sparse/indices/componentType",
    "/accessors/5/sparse/values",
    "/accessors/5/sparse/values/bufferView",
    "/animations/0/channels",
    "/animations/0/channels/0/sampler",
    "/animations/0/channels/0/target",
    "/animations/0/channels/0/target/path",
    "/animations/0/samplers",
    "/animations/0/samplers/0/input",
    "/animations/0/samplers/0/output",
    "/buffers/0/byteLength",
    "/bufferViews/0/buffer",
    "/bufferViews/0/byteLength",
    "/cameras/0/type",
    "/cameras/0/perspective",
    "/cameras/0/perspective/yfov",
    "/cameras/0/perspective/znear",
    "/cameras/1/orthographic",
    "/cameras/1/orthographic/ymag",
    "/cameras/1/orthographic/zfar",
    "/cameras/1/orthographic/znear",
    "/images/0/bufferView",
    "/materials/0/normalTexture/index",
    "/materials/0/pbrMetallicRoughness/baseColorTexture/index",
    "/meshes/0/primitives",
    "/meshes/0/primitives/0/attributes",
    "/meshes/0/primitives/0/extensions/KHR_materials_variants/mappings/0/material",
    "/meshes/0/primitives/0/extensions/KHR_materials_variants/mappings/0/variants",
    "/meshes/1/primitives/0/attributes/WEIGHTS_0",
    "/meshes/1/primitives/0/attributes/JOINTS_0",
    "/meshes/2/primitives/0/extensions/KHR_draco_mesh_compression/attributes",
    "/meshes/2/primitives/0/extensions/KHR_draco_mesh_compression/bufferView",
    "/nodes/2/extensions/KHR_lights_punctual/light",
    "/nodes/5/extras/areaLight/shape",
    "/nodes/5/extras/areaLight/width",
    "/nodes/6/extensions/EXT_mesh_gpu_instancing/attributes",
    "/skins/0/joints",
    "/extensions/KHR_lights_punctual/lights/0/type",
    "/extensions/EXT_lights_image_based/lights/0/irradianceCoefficients",
    "/extensions/EXT_lights_image_based/lights/0/specularImages",
    "/extensions/EXT_lights_image_based/lights/0/specularImageSize",
    "/scenes/0/extensions/EXT_lights_image_based/light",
};

const char* const vectors[] = {
    "/nodes/1/translation",
    "/nodes/1/rotation",
    "/nodes/1/scale",
    "/nodes/7/matrix",
    "/nodes/3/weights",
    "/meshes/1/weights",
    "/materials/0/emissiveFactor",
    "/materials/0/pbrMetallicRoughness/baseColorFactor",
    "/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/offset",
    "/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/scale",
    "/materials/0/extensions/KHR_materials_sheen/sheenColorFactor",
    "/extensions/KHR_lights_punctual/lights/0/color",
    "/extensions/EXT_lights_image_based/lights/0/rotation",
};

const char* const numbers[] = {
    "/materials/0/alphaCutoff",
    "/materials/0/normalTexture/scale",
    "/materials/0/occlusionTexture/strength",
    "/materials/0/pbrMetallicRoughness/metallicFactor",
    "/materials/0/pbrMetallicRoughness/roughnessFactor",
    "/materials/0/extensions/KHR_materials_ior/ior",
    "/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength",
    "/materials/0/extensions/KHR_materials_transmission/transmissionFactor",
    "/materials/0/extensions/KHR_materials_volume/thicknessFactor",
    "/cameras/0/perspective/yfov",
    "/cameras/0/perspective/znear",
    "/cameras/0/perspective/zfar",
    "/cameras/1/orthographic/xmag",
    "/cameras/1/orthographic/ymag",
    "/extensions/KHR_lights_punctual/lights/0/intensity",
    "/extensions/EXT_lights_image_based/lights/0/intensity",
    "/extensions/KHR_lights_punctual/lights/1/range",
    "/extensions/KHR_lights_punctual/lights/1/spot/innerConeAngle",
    "/extensions/KHR_lights_punctual/lights/1/spot/outerConeAngle",
    "/nodes/5/extras/areaLight/radiance",
};

const char* const arrays[] = {
    "/scenes",
    "/nodes",
    "/meshes",
    "/materials",
    "/textures",
    "/images",
    "/samplers",
    "/buffers",
    "/bufferViews",
    "/accessors",
    "/animations",
    "/skins",
    "/cameras",
    "/extensionsUsed",
    "/extensionsRequired",
    "/meshes/0/primitives",
    "/meshes/1/primitives/0/targets",
    "/animations/0/samplers",
    "/animations/0/channels",
    "/extensions/KHR_lights_punctual/lights",
    "/extensions/KHR_materials_variants/variants",
    "/extensions/EXT_lights_image_based/lights",
    "/extensions/EXT_lights_image_based/lights/0/irradianceCoefficients",
    "/extensions/EXT_lights_image_based/lights/0/specularImages",
};

const char* const texts[] = {
    "/asset/version",
    "/accessors/0/type",
    "/animations/0/name",
    "/animations/0/channels/0/target/path",
    "/animations/0/samplers/0/interpolation",
    "/cameras/0/type",
    "/materials/0/alphaMode",
    "/nodes/0/name",
    "/images/2/uri",
    "/extensions/KHR_lights_punctual/lights/0/type",
    "/bufferViews/15/extensions/EXT_meshopt_compression/mode",
    "/bufferViews/15/extensions/EXT_meshopt_compression/filter",
};

/// Members that are enumerations of strings.
const char* const names_of_choices[] = {
    "/asset/version",
    "/accessors/0/type",
    "/animations/0/channels/0/target/path",
    "/animations/0/samplers/0/interpolation",
    "/cameras/0/type",
    "/materials/0/alphaMode",
    "/extensions/KHR_lights_punctual/lights/0/type",
    "/nodes/5/extras/areaLight/shape",
};

class MalformedMembers : public Malformed {
 protected:
  MalformedMembers() { EXPECT_EQ(refusal_of(good_), ""); }

  void refuse(const char* place, const json& value) {
    const json::json_pointer pointer(place);
    ASSERT_TRUE(good_.json.contains(pointer.parent_pointer())) << place;
    GltfBuilder damaged = good_;
    damaged.json[pointer] = value;
    expect_refused(place + (" = " + value.dump()), damaged, named_in_errors(place));
  }

  const GltfBuilder good_ = rich_document();
};

TEST_F(MalformedMembers, InvalidIndices) {
  const json values[] = {999, -1,   4294967296u, 18446744073709551615ull, 1.5, 1e300,
                         "0", true, nullptr,     json::object(),          {0}};
  for (const char* const place : indices) {
    for (const json& value : values) refuse(place, value);
  }
}

TEST_F(MalformedMembers, InvalidCounts) {
  const json values[] = {-1, 1.5, 1e300, "1", true, nullptr, json::array()};
  for (const char* const place : counts) {
    for (const json& value : values) refuse(place, value);
  }
}

TEST_F(MalformedMembers, CountsBeyondData) {
  for (const char* const place : counts) {
    for (const std::uint64_t value :
         {0x7fffffffull, 0x80000000ull, 0xffffffffull, 0x100000000ull, 0x7fffffffffffffffull,
          0xfffffffffffffff0ull, 0xffffffffffffffffull}) {
      GltfBuilder damaged = good_;
      damaged.json[json::json_pointer(place)] = value;
      const std::string owner =
          named_in_errors(std::string(place).substr(0, std::string(place).rfind('/')));
      expect_refused(place + (" = " + std::to_string(value)), damaged, owner);
    }
  }
}

TEST_F(MalformedMembers, MissingRequiredMembers) {
  for (const char* const place : required) {
    const std::string text = place;
    const json::json_pointer pointer(text);
    ASSERT_TRUE(good_.json.contains(pointer)) << place;
    GltfBuilder damaged = good_;
    damaged.json[pointer.parent_pointer()].erase(pointer.back());
    const std::string owner = text.substr(0, text.rfind('/'));
    expect_refused(text + " is missing", damaged, owner.empty() ? "" : named_in_errors(owner));
  }
}

TEST_F(MalformedMembers, VectorsOfWrongSizeAndType) {
  for (const char* const place : vectors) {
    json longer = good_.json[json::json_pointer(place)];
    longer.push_back(1);
    json text = good_.json[json::json_pointer(place)];
    text[0] = "one";
    json huge = good_.json[json::json_pointer(place)];
    huge[0] = 1e300;
    json nothing = good_.json[json::json_pointer(place)];
    nothing[0] = nullptr;
    for (const json& value : {longer, text, huge, nothing, json(5), json("x"), json::object()}) {
      refuse(place, value);
    }
    // No weights are common for "the default ones".
    if (!std::string_view(place).ends_with("/weights")) refuse(place, json::array());
  }
}

TEST_F(MalformedMembers, InvalidNumbers) {
  for (const char* const place : numbers) {
    for (const json& value : {json("1"), json(true), json(nullptr), json::array(), json(1e300)}) {
      refuse(place, value);
    }
  }
}

TEST_F(MalformedMembers, InvalidArrays) {
  for (const char* const place : arrays) {
    for (const json& value :
         {json(5), json("x"), json(nullptr), json{{"0", 1}}, json::array({7})}) {
      refuse(place, value);
    }
  }
}

TEST_F(MalformedMembers, InvalidStrings) {
  for (const char* const place : texts) {
    for (const json& value : {json(5), json(true), json(nullptr), json::array(), json::object()}) {
      refuse(place, value);
    }
  }
}

TEST_F(MalformedMembers, InvalidEnumValues) {
  for (const char* const place : names_of_choices) {
    for (const char* const value : {"x", "linear ", "\n\x01", "0"}) refuse(place, value);
    refuse(place, std::string(100'000, 'a'));
  }
}

// Values other than objects in place of objects.
TEST_F(MalformedMembers, InvalidObjects) {
  for (const char* const place :
       {"/asset", "/nodes/0", "/nodes/2/extensions", "/materials/0/pbrMetallicRoughness",
        "/materials/0/normalTexture", "/materials/0/extensions/KHR_materials_ior",
        "/materials/0/extensions/KHR_materials_volume", "/cameras/0/perspective",
        "/meshes/0/primitives/0", "/meshes/0/primitives/0/attributes", "/accessors/5/sparse",
        "/accessors/5/sparse/indices", "/animations/0/channels/0/target",
        "/nodes/2/extensions/KHR_lights_punctual", "/extensions", "/skins/0",
        "/nodes/6/extensions/EXT_mesh_gpu_instancing",
        "/meshes/2/primitives/0/extensions/KHR_draco_mesh_compression"}) {
    for (const json& value : {json(5), json("x"), json(true), json::array()}) refuse(place, value);
  }
}

}  // namespace
}  // namespace heliograph::scene::test
