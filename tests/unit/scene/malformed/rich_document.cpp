#include "tests/unit/scene/malformed/rich_document.hpp"

#include "tests/unit/scene/support/encoders.hpp"

namespace heliograph::scene::test {
namespace {

using nlohmann::json;

const std::vector<float> square = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};

template <typename T>
std::uint32_t add(GltfBuilder& b, const std::vector<T>& values, int component,
                  std::string_view type, std::size_t count) {
  return b.add_accessor(values, component, type, count);
}

void add_textures(GltfBuilder& b) {
  const Bytes pixels(64, 200);
  b.add_image(png(4, 4, 4, pixels));
  b.add("images", {{"bufferView", b.add_view(webp(4, 4, pixels))}, {"mimeType", "image/webp"}});
  b.add("images", {{"uri", "data:image/jpeg;base64," + base64(jpeg(4, 4, Bytes(48, 90)))}});
  b.add("samplers", {{"wrapS", 33071}, {"magFilter", 9729}, {"minFilter", 9987}});
  b.add("textures", {{"source", 0}, {"sampler", 0}});
  b.add("textures", {{"source", 0}, {"extensions", {{"EXT_texture_webp", {{"source", 1}}}}}});
  b.add("textures", {{"source", 2}});
}

void add_materials(GltfBuilder& b) {
  b.add("materials",
        {{"pbrMetallicRoughness",
          {{"baseColorTexture",
            {{"index", 0},
             {"texCoord", 0},
             {"extensions",
              {{"KHR_texture_transform",
                {{"offset", {0.5, 0}}, {"rotation", 1}, {"scale", {2, 2}}}}}}}},
           {"metallicRoughnessTexture", {{"index", 1}}},
           {"baseColorFactor", {1, 1, 1, 1}},
           {"metallicFactor", 0.5},
           {"roughnessFactor", 0.5}}},
         {"normalTexture", {{"index", 2}, {"scale", 1}}},
         {"occlusionTexture", {{"index", 1}, {"strength", 0.5}}},
         {"emissiveTexture", {{"index", 0}}},
         {"emissiveFactor", {1, 0, 0}},
         {"alphaMode", "MASK"},
         {"alphaCutoff", 0.25},
         {"doubleSided", true},
         {"extensions",
          {{"KHR_materials_emissive_strength", {{"emissiveStrength", 2}}},
           {"KHR_materials_ior", {{"ior", 1.4}}},
           {"KHR_materials_specular", {{"specularFactor", 0.5}}},
           {"KHR_materials_clearcoat",
            {{"clearcoatFactor", 1}, {"clearcoatTexture", {{"index", 0}}}}},
           {"KHR_materials_sheen", {{"sheenColorFactor", {1, 1, 1}}}},
           {"KHR_materials_iridescence",
            {{"iridescenceFactor", 0.5},
             {"iridescenceIor", 1.6},
             {"iridescenceTexture", {{"index", 1}}}}},
           {"KHR_materials_anisotropy",
            {{"anisotropyStrength", 0.5},
             {"anisotropyRotation", 1},
             {"anisotropyTexture", {{"index", 1}}}}},
           {"KHR_materials_dispersion", {{"dispersion", 0.5}}},
           {"KHR_materials_diffuse_transmission",
            {{"diffuseTransmissionFactor", 0.5},
             {"diffuseTransmissionTexture", {{"index", 1}}},
             {"diffuseTransmissionColorFactor", {0.5, 1, 0.5}}}},
           {"KHR_materials_transmission", {{"transmissionFactor", 0.5}}},
           {"KHR_materials_volume", {{"thicknessFactor", 1}, {"attenuationDistance", 1}}}}}});
  b.add("materials", {{"extensions", {{"KHR_materials_unlit", json::object()}}}});
  b.json["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "a"}}, {{"name", "b"}}};
}

void add_plain_mesh(GltfBuilder& b) {
  const auto position = add(b, square, 5126, "VEC3", 4);
  const auto normal =
      add(b, std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 5126, "VEC3", 4);
  const auto uv = add(b, std::vector<float>{0, 1, 1, 1, 0, 0, 1, 0}, 5126, "VEC2", 4);
  const auto color = add(b, Bytes(16, 255), 5121, "VEC4", 4);
  b.json["accessors"][color]["normalized"] = true;
  const auto indices = add(b, std::vector<std::uint16_t>{0, 1, 2, 2, 1, 3}, 5123, "SCALAR", 6);
  const json mapping = {{"material", 1}, {"variants", {1}}};
  b.add(
      "meshes",
      {{"primitives",
        {{{"attributes",
           {{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", uv}, {"COLOR_0", color}}},
          {"indices", indices},
          {"material", 0},
          {"mode", 4},
          {"extensions", {{"KHR_materials_variants", {{"mappings", json::array({mapping})}}}}}}}}});
}

void add_deforming_mesh(GltfBuilder& b) {
  const auto position = add(b, square, 5126, "VEC3", 4);
  const auto index = b.add_view(std::vector<std::uint32_t>{3});
  const auto value = b.add_view(std::vector<float>{2, 2, 0});
  b.json["accessors"][position]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", index}, {"componentType", 5125}}},
      {"values", {{"bufferView", value}}}};
  const auto joints =
      add(b, Bytes{0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}, 5121, "VEC4", 4);
  const auto weights = add(b, std::vector<float>(16, 0.25f), 5126, "VEC4", 4);
  const auto moved = add(b, std::vector<float>(12, 0.5f), 5126, "VEC3", 4);
  b.add("meshes",
        {{"weights", {0.5}},
         {"primitives",
          {{{"attributes", {{"POSITION", position}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}}},
            {"mode", 5},
            {"targets", {{{"POSITION", moved}}}}}}}});
  std::vector<float> matrices(32, 0.0f);
  for (std::size_t i = 0; i < 32; i += 16) {
    for (std::size_t k = 0; k < 16; k += 5) matrices[i + k] = 1.0f;
  }
  const auto bind = add(b, matrices, 5126, "MAT4", 2);
  b.add("skins", {{"joints", {1, 2}}, {"skeleton", 0}, {"inverseBindMatrices", bind}});
}

void add_compressed_meshes(GltfBuilder& b) {
  DracoInput input;
  for (std::size_t i = 0; i < 12; i += 3) {
    input.positions.push_back({square[i], square[i + 1], square[i + 2]});
  }
  input.indices = {0, 1, 2, 2, 1, 3};
  const DracoOutput packed = draco(input);
  const auto position =
      b.add("accessors", {{"componentType", 5126}, {"type", "VEC3"}, {"count", packed.vertices}});
  const auto indices = b.add(
      "accessors", {{"componentType", 5123}, {"type", "SCALAR"}, {"count", packed.triangles * 3}});
  b.add("meshes",
        {{"primitives",
          {{{"attributes", {{"POSITION", position}}},
            {"indices", indices},
            {"extensions",
             {{"KHR_draco_mesh_compression",
               {{"bufferView", b.add_view(packed.bytes)}, {"attributes", packed.ids}}}}}}}}});

  const Bytes vertices = pack_vertices(exponential(input.positions), 12);
  const auto view = b.add_view(vertices);
  json& added = b.json["bufferViews"][view];
  added = {{"buffer", 0},
           {"byteLength", 48},
           {"byteStride", 12},
           {"extensions",
            {{"EXT_meshopt_compression",
              {{"buffer", 0},
               {"byteOffset", added["byteOffset"]},
               {"byteLength", vertices.size()},
               {"byteStride", 12},
               {"count", 4},
               {"mode", "ATTRIBUTES"},
               {"filter", "EXPONENTIAL"}}}}}};
  b.add("meshes", {{"primitives",
                    {{{"attributes", {{"POSITION", b.add_accessor(view, 5126, "VEC3", 4)}}},
                      {"mode", 6},
                      {"material", 1}}}}});
}

void add_nodes(GltfBuilder& b) {
  b.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "directional"}, {"color", {1, 1, 1}}, {"intensity", 2}},
      {{"type", "spot"},
       {"range", 10},
       {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}}};
  b.add("cameras",
        {{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}, {"zfar", 10}}}});
  b.add("cameras", {{"type", "orthographic"},
                    {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0.1}, {"zfar", 10}}}});
  const auto places = add(b, std::vector<float>{0, 1, 0, 0, 2, 0}, 5126, "VEC3", 2);
  b.add("nodes", {{"mesh", 0}, {"children", {1, 2, 3}}, {"name", "root"}});
  b.add("nodes", {{"camera", 0},
                  {"translation", {0, 0, 3}},
                  {"rotation", {0, 0, 0, 1}},
                  {"scale", {1, 1, 1}}});
  b.add("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}},
                  {"extras", {{"angularDiameterDeg", 0.5}}}});
  b.add("nodes", {{"mesh", 1}, {"skin", 0}, {"weights", {0.25}}});
  b.add("nodes",
        {{"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}, {"extras", {{"radius", 0.1}}}});
  b.add("nodes",
        {{"extras",
          {{"areaLight", {{"shape", "rect"}, {"width", 1}, {"height", 2}, {"radiance", 3}}}}}});
  b.add("nodes", {{"mesh", 2},
                  {"extensions",
                   {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", places}}}}}}}});
  b.add("nodes",
        {{"mesh", 3}, {"camera", 1}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3, 4, 5, 1}}});
  b.json["extensions"]["EXT_lights_image_based"]["lights"] = {
      {{"rotation", {0, 0, 0, 1}},
       {"intensity", 2},
       {"irradianceCoefficients", json(9, json(3, 0.5))},
       {"specularImages", json::array({json(6, json(0))})},
       {"specularImageSize", 4}}};
  b.add("scenes",
        {{"nodes", {0, 4, 5, 6, 7}}, {"extensions", {{"EXT_lights_image_based", {{"light", 0}}}}}});
  b.json["scene"] = 0;
}

void add_animation(GltfBuilder& b) {
  const auto times = add(b, std::vector<float>{0, 1}, 5126, "SCALAR", 2);
  const auto places = add(b, std::vector<float>{0, 0, 0, 1, 0, 0}, 5126, "VEC3", 2);
  const auto turns = add(b, std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1}, 5126, "VEC4", 2);
  const auto shares = add(b, std::vector<float>{0, 0, 0, 0, 1, 0}, 5126, "SCALAR", 6);
  const auto sampler = [&](std::uint32_t output, const char* interpolation) {
    return json{{"input", times}, {"output", output}, {"interpolation", interpolation}};
  };
  const auto channel = [](int index, int node, const char* path) {
    return json{{"sampler", index}, {"target", {{"node", node}, {"path", path}}}};
  };
  b.add("animations",
        {{"name", "move"},
         {"samplers",
          {sampler(places, "LINEAR"), sampler(turns, "STEP"), sampler(shares, "CUBICSPLINE")}},
         {"channels",
          {channel(0, 1, "translation"), channel(1, 1, "rotation"), channel(2, 3, "weights")}}});
}

}  // namespace

GltfBuilder rich_document() {
  GltfBuilder b;
  b.json["asset"]["minVersion"] = "2.0";
  b.json["extensionsUsed"] = {"EXT_lights_image_based",     "KHR_lights_punctual",
                              "KHR_texture_transform",      "EXT_texture_webp",
                              "KHR_draco_mesh_compression", "EXT_meshopt_compression",
                              "EXT_mesh_gpu_instancing",    "KHR_materials_variants",
                              "KHR_materials_ior",          "KHR_materials_specular",
                              "KHR_materials_clearcoat",    "KHR_materials_sheen",
                              "KHR_materials_transmission", "KHR_materials_volume",
                              "KHR_materials_unlit",        "KHR_materials_emissive_strength",
                              "KHR_materials_iridescence",  "KHR_materials_anisotropy",
                              "KHR_materials_dispersion",   "KHR_materials_diffuse_transmission"};
  b.json["extensionsRequired"] = {"KHR_draco_mesh_compression", "EXT_meshopt_compression"};
  add_textures(b);
  add_materials(b);
  add_plain_mesh(b);
  add_deforming_mesh(b);
  add_compressed_meshes(b);
  add_nodes(b);
  add_animation(b);
  return b;
}

}  // namespace heliograph::scene::test
