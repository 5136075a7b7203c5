#include "scenes/generator/gltf/glb.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <variant>

#include "scenes/generator/parallel.hpp"

namespace heliograph::scenes {
namespace {

using Json = nlohmann::ordered_json;

constexpr int array_buffer = 34962;
constexpr int element_array_buffer = 34963;
constexpr int type_unsigned_short = 5123;
constexpr int type_unsigned_int = 5125;
constexpr int type_float = 5126;
constexpr int filter_linear = 9729;
constexpr int filter_trilinear = 9987;
constexpr int wrap_repeat = 10497;

Json to_json(glm::vec3 v) {
  return Json::array({v.x, v.y, v.z});
}

Json to_json(const MaterialExtension& extension) {
  Json json = Json::object();
  for (const auto& [name, value] : extension.members) {
    const auto* number = std::get_if<float>(&value);
    json[name] = number ? Json(*number) : to_json(std::get<glm::vec3>(value));
  }
  return json;
}

void fill_channel(Image& image, std::size_t channel, std::uint8_t value) {
  for (std::size_t i = channel; i < image.pixels.size(); i += std::size_t(image.channels)) {
    image.pixels[i] = value;
  }
}

class GlbWriter {
 public:
  GlbWriter(const Document& document, int texture_size)
      : document_(document), texture_size_(texture_size) {}

  std::vector<std::uint8_t> write();

 private:
  template <typename T>
  int add_view(std::span<const T> data, int target);
  int add_accessor(int view, int component_type, std::size_t count, const char* type);
  template <typename Vector, typename Member>
  int add_attribute(const Mesh& mesh, Member member, const char* type);
  int add_indices(const Mesh& mesh);
  int add_bounded_floats(const std::vector<float>& values);
  int add_texture(const std::string& name, const std::vector<std::uint8_t>& png);

  void write_materials();
  Json material_json(const Material& material);
  void write_meshes();
  void write_cameras_and_lights();
  void write_nodes();
  void write_animations();
  std::vector<std::uint8_t> assemble();

  const Document& document_;
  int texture_size_;
  Json gltf_;
  std::vector<std::uint8_t> binary_;
  std::vector<std::array<std::vector<std::uint8_t>, 3>> pngs_;  // color, normal, surface
};

template <typename T>
int GlbWriter::add_view(std::span<const T> data, int target) {
  binary_.resize((binary_.size() + 3) / 4 * 4);
  const std::size_t offset = binary_.size();
  binary_.resize(offset + data.size_bytes());
  std::memcpy(binary_.data() + offset, data.data(), data.size_bytes());
  Json view = {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", data.size_bytes()}};
  if (target != 0) view["target"] = target;
  gltf_["bufferViews"].push_back(std::move(view));
  return int(gltf_["bufferViews"].size()) - 1;
}

int GlbWriter::add_accessor(int view, int component_type, std::size_t count, const char* type) {
  gltf_["accessors"].push_back(
      {{"bufferView", view}, {"componentType", component_type}, {"count", count}, {"type", type}});
  return int(gltf_["accessors"].size()) - 1;
}

template <typename Vector, typename Member>
int GlbWriter::add_attribute(const Mesh& mesh, Member member, const char* type) {
  std::vector<Vector> values;
  values.reserve(mesh.vertices.size());
  for (const Vertex& vertex : mesh.vertices) values.push_back(vertex.*member);
  const int view = add_view(std::span<const Vector>(values), array_buffer);
  return add_accessor(view, type_float, values.size(), type);
}

int GlbWriter::add_indices(const Mesh& mesh) {
  // 65535 is left out: it is the primitive restart value.
  if (mesh.vertices.size() < 65535) {
    const std::vector<std::uint16_t> narrow(mesh.indices.begin(), mesh.indices.end());
    const int view = add_view(std::span<const std::uint16_t>(narrow), element_array_buffer);
    return add_accessor(view, type_unsigned_short, narrow.size(), "SCALAR");
  }
  const int view = add_view(std::span<const std::uint32_t>(mesh.indices), element_array_buffer);
  return add_accessor(view, type_unsigned_int, mesh.indices.size(), "SCALAR");
}

int GlbWriter::add_bounded_floats(const std::vector<float>& values) {
  const int view = add_view(std::span<const float>(values), 0);
  const int accessor = add_accessor(view, type_float, values.size(), "SCALAR");
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  gltf_["accessors"][std::size_t(accessor)]["min"] = Json::array({*low});
  gltf_["accessors"][std::size_t(accessor)]["max"] = Json::array({*high});
  return accessor;
}

int GlbWriter::add_texture(const std::string& name, const std::vector<std::uint8_t>& png) {
  const int view = add_view(std::span<const std::uint8_t>(png), 0);
  gltf_["images"].push_back({{"name", name}, {"bufferView", view}, {"mimeType", "image/png"}});
  gltf_["textures"].push_back({{"sampler", 0}, {"source", gltf_["images"].size() - 1}});
  return int(gltf_["textures"].size()) - 1;
}

Json GlbWriter::material_json(const Material& material) {
  Json pbr = {
      {"baseColorFactor",
       {material.color.x, material.color.y, material.color.z, material.opacity.value_or(1.0f)}},
      {"metallicFactor", material.metallic},
      {"roughnessFactor", material.uniform_roughness.value_or(material.roughness)}};
  Json json = {{"name", material.name}};
  const auto& pngs = pngs_[std::size_t(&material - document_.materials.data())];
  if (material.texture) {
    const std::string& name = material.texture->name;
    pbr["baseColorTexture"] = {{"index", add_texture(name + "_color", pngs[0])}};
    const int surface = add_texture(name + "_occlusion_roughness_metallic", pngs[2]);
    pbr["metallicRoughnessTexture"] = {{"index", surface}};
    json["normalTexture"] = {{"index", add_texture(name + "_normal", pngs[1])},
                             {"scale", material.normal_scale}};
    json["occlusionTexture"] = {{"index", surface}};
  }
  json["pbrMetallicRoughness"] = std::move(pbr);
  const float strength = std::max({material.emission.x, material.emission.y, material.emission.z});
  if (strength > 0.0f) {
    json["emissiveFactor"] = to_json(material.emission / std::max(strength, 1.0f));
    if (strength > 1.0f) {
      json["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = strength;
    }
  }
  if (material.masked) {
    json["alphaMode"] = "MASK";
    json["alphaCutoff"] = material.alpha_cutoff;
  }
  if (material.opacity) json["alphaMode"] = "BLEND";
  for (const MaterialExtension& extension : material.extensions) {
    json["extensions"][extension.name] = to_json(extension);
  }
  if (material.double_sided) json["doubleSided"] = true;
  if (material.swept) json["extras"]["sweep"] = true;
  return json;
}

void GlbWriter::write_materials() {
  pngs_.resize(document_.materials.size());
  parallel_for(document_.materials.size(), [&](std::size_t i) {
    if (!document_.materials[i].texture) return;
    TextureSet set = bake(*document_.materials[i].texture, texture_size_);
    if (document_.materials[i].uniform_roughness) fill_channel(set.surface, 1, 255);
    pngs_[i] = {encode_png(set.color), encode_png(set.normal), encode_png(set.surface)};
  });
  std::vector<std::string> extensions;  // in the order of their first use
  bool textured = false;
  for (const Material& material : document_.materials) {
    // First the value: it adds images, and a growing object moves its members.
    Json json = material_json(material);
    if (json.contains("extensions")) {
      for (const auto& extension : json["extensions"].items()) {
        if (std::ranges::find(extensions, extension.key()) == extensions.end()) {
          extensions.push_back(extension.key());
        }
      }
    }
    gltf_["materials"].push_back(std::move(json));
    textured |= material.texture.has_value();
  }
  for (const std::string& extension : extensions) gltf_["extensionsUsed"].push_back(extension);
  if (textured) {
    gltf_["samplers"].push_back({{"magFilter", filter_linear},
                                 {"minFilter", filter_trilinear},
                                 {"wrapS", wrap_repeat},
                                 {"wrapT", wrap_repeat}});
  }
}

void GlbWriter::write_meshes() {
  for (const NamedMesh& named : document_.meshes) {
    const int position = add_attribute<glm::vec3>(named.mesh, &Vertex::position, "VEC3");
    glm::vec3 low(1e30f);
    glm::vec3 high(-1e30f);
    for (const Vertex& vertex : named.mesh.vertices) {
      low = glm::min(low, vertex.position);
      high = glm::max(high, vertex.position);
    }
    gltf_["accessors"][std::size_t(position)]["min"] = to_json(low);
    gltf_["accessors"][std::size_t(position)]["max"] = to_json(high);
    Json attributes = {{"POSITION", position}};
    attributes["NORMAL"] = add_attribute<glm::vec3>(named.mesh, &Vertex::normal, "VEC3");
    const Material& material = document_.materials[std::size_t(named.material)];
    if (material.texture || material.is_anisotropic()) {
      attributes["TANGENT"] = add_attribute<glm::vec4>(named.mesh, &Vertex::tangent, "VEC4");
    }
    if (material.texture) {
      attributes["TEXCOORD_0"] = add_attribute<glm::vec2>(named.mesh, &Vertex::uv, "VEC2");
    }
    Json primitive = {{"attributes", std::move(attributes)},
                      {"indices", add_indices(named.mesh)},
                      {"material", named.material}};
    gltf_["meshes"].push_back(
        {{"name", named.name}, {"primitives", Json::array({std::move(primitive)})}});
  }
}

void GlbWriter::write_cameras_and_lights() {
  for (const Camera& camera : document_.cameras) {
    gltf_["cameras"].push_back({{"name", camera.name},
                                {"type", "perspective"},
                                {"perspective",
                                 {{"aspectRatio", 16.0f / 9.0f},
                                  {"yfov", camera.vertical_fov},
                                  {"znear", 0.05f},
                                  {"zfar", 500.0f}}}});
  }
  if (document_.lights.empty()) return;
  gltf_["extensionsUsed"].push_back("KHR_lights_punctual");
  Json& lights = gltf_["extensions"]["KHR_lights_punctual"]["lights"];
  for (const Light& light : document_.lights) {
    Json json = {{"name", light.name},
                 {"type", light.directional ? "directional" : "point"},
                 {"color", to_json(light.color)},
                 {"intensity", light.intensity}};
    if (light.range > 0.0f) json["range"] = light.range;
    lights.push_back(std::move(json));
  }
}

void GlbWriter::write_nodes() {
  Json roots = Json::array();
  for (const Node& node : document_.nodes) {
    Json json = {{"name", node.name}};
    if (node.translation != glm::vec3(0.0f)) json["translation"] = to_json(node.translation);
    if (node.rotation != glm::quat(1.0f, 0.0f, 0.0f, 0.0f)) {
      json["rotation"] = {node.rotation.x, node.rotation.y, node.rotation.z, node.rotation.w};
    }
    if (node.scale != glm::vec3(1.0f)) json["scale"] = to_json(node.scale);
    if (node.mesh >= 0) json["mesh"] = node.mesh;
    if (node.camera >= 0) json["camera"] = node.camera;
    if (node.light >= 0) json["extensions"]["KHR_lights_punctual"]["light"] = node.light;
    if (node.angular_diameter) json["extras"]["angularDiameterDeg"] = *node.angular_diameter;
    gltf_["nodes"].push_back(std::move(json));
    roots.push_back(gltf_["nodes"].size() - 1);
  }
  gltf_["scene"] = 0;
  gltf_["scenes"].push_back({{"name", document_.name}, {"nodes", std::move(roots)}});
}

void GlbWriter::write_animations() {
  std::vector<std::pair<std::vector<float>, int>> time_accessors;
  const auto times = [&](const std::vector<float>& seconds) {
    for (const auto& [known, accessor] : time_accessors) {
      if (known == seconds) return accessor;
    }
    time_accessors.emplace_back(seconds, add_bounded_floats(seconds));
    return time_accessors.back().second;
  };
  for (const Animation& animation : document_.animations) {
    Json json = {{"name", animation.name}};
    for (const Channel& channel : animation.channels) {
      const bool rotation = channel.path == Channel::Path::rotation;
      std::vector<float> values;
      for (const glm::vec4& value : channel.values) {
        for (int c = 0; c < (rotation ? 4 : 3); ++c) values.push_back(value[c]);
      }
      const int view = add_view(std::span<const float>(values), 0);
      const int output =
          add_accessor(view, type_float, channel.values.size(), rotation ? "VEC4" : "VEC3");
      json["samplers"].push_back(
          {{"input", times(channel.seconds)}, {"output", output}, {"interpolation", "LINEAR"}});
      json["channels"].push_back(
          {{"sampler", json["samplers"].size() - 1},
           {"target", {{"node", channel.node}, {"path", rotation ? "rotation" : "translation"}}}});
    }
    gltf_["animations"].push_back(std::move(json));
  }
}

std::vector<std::uint8_t> GlbWriter::assemble() {
  binary_.resize((binary_.size() + 3) / 4 * 4);
  gltf_["buffers"].push_back({{"byteLength", binary_.size()}});
  std::string text = gltf_.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');

  std::vector<std::uint8_t> file;
  const auto put = [&](std::uint32_t value) {
    for (int shift = 0; shift < 32; shift += 8) file.push_back(std::uint8_t(value >> shift));
  };
  constexpr std::uint32_t magic = 0x46546C67;       // "glTF"
  constexpr std::uint32_t json_chunk = 0x4E4F534A;  // "JSON"
  constexpr std::uint32_t binary_chunk = 0x004E4942;
  file.reserve(28 + text.size() + binary_.size());
  put(magic);
  put(2);
  put(std::uint32_t(28 + text.size() + binary_.size()));
  put(std::uint32_t(text.size()));
  put(json_chunk);
  file.insert(file.end(), text.begin(), text.end());
  put(std::uint32_t(binary_.size()));
  put(binary_chunk);
  file.insert(file.end(), binary_.begin(), binary_.end());
  return file;
}

std::vector<std::uint8_t> GlbWriter::write() {
  gltf_["asset"] = {{"version", "2.0"}, {"generator", "heliograph-scenes"}};
  if (!document_.description.empty()) {
    gltf_["asset"]["extras"]["description"] = document_.description;
  }
  write_materials();
  write_meshes();
  write_cameras_and_lights();
  write_nodes();
  write_animations();
  return assemble();
}

}  // namespace

std::vector<std::uint8_t> encode_glb(const Document& document, int texture_size) {
  return GlbWriter(document, texture_size).write();
}

}  // namespace heliograph::scenes
