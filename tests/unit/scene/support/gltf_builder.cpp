#include "tests/unit/scene/support/gltf_builder.hpp"

#include <turbojpeg.h>
#include <unistd.h>

#include <array>
#include <cstdlib>

namespace heliograph::scene::test {
namespace {

void append_u32(Bytes& bytes, std::uint32_t value, bool big_endian = false) {
  for (int i = 0; i < 4; ++i) {
    bytes.push_back(static_cast<std::uint8_t>(value >> (big_endian ? 24 - 8 * i : 8 * i)));
  }
}

std::uint32_t crc32(const std::uint8_t* bytes, std::size_t count) {
  std::uint32_t crc = 0xffffffffu;
  for (std::size_t i = 0; i < count; ++i) {
    crc ^= bytes[i];
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0u);
  }
  return ~crc;
}

void append_chunk(Bytes& file, std::string_view type, const Bytes& data) {
  append_u32(file, static_cast<std::uint32_t>(data.size()), true);
  const std::size_t start = file.size();
  file.insert(file.end(), type.begin(), type.end());
  file.insert(file.end(), data.begin(), data.end());
  append_u32(file, crc32(file.data() + start, file.size() - start), true);
}

// zlib with stored blocks.
Bytes store(const Bytes& data) {
  Bytes result = {0x78, 0x01};
  std::uint32_t a = 1;
  std::uint32_t b = 0;
  for (const std::uint8_t byte : data) {
    a = (a + byte) % 65521;
    b = (b + a) % 65521;
  }
  for (std::size_t offset = 0; offset < data.size(); offset += 65535) {
    const std::size_t size = std::min<std::size_t>(65535, data.size() - offset);
    result.push_back(offset + size == data.size());
    for (const std::size_t word : {size, ~size}) {
      result.push_back(static_cast<std::uint8_t>(word));
      result.push_back(static_cast<std::uint8_t>(word >> 8));
    }
    result.insert(result.end(), data.begin() + offset, data.begin() + offset + size);
  }
  append_u32(result, b << 16 | a, true);
  return result;
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
  const char* output = std::getenv("HELIOGRAPH_TEST_OUTPUT");
  std::string pattern =
      (output ? std::filesystem::path(output) : std::filesystem::temp_directory_path()) /
      "scene_XXXXXX";
  if (!mkdtemp(pattern.data())) throw std::runtime_error("cannot make a temporary folder");
  path_ = pattern;
}

std::filesystem::path TemporaryFolder::write(std::string_view name, const Bytes& bytes) const {
  return write(name, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

std::filesystem::path TemporaryFolder::write(std::string_view name, std::string_view text) const {
  const std::filesystem::path path = path_ / name;
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

std::uint32_t GltfBuilder::add_view(const Bytes& bytes, std::uint32_t stride) {
  binary.resize((binary.size() + 3) / 4 * 4);
  nlohmann::json view = {
      {"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}};
  if (stride != 0) view["byteStride"] = stride;
  binary.insert(binary.end(), bytes.begin(), bytes.end());
  json["buffers"] = {{{"byteLength", binary.size()}}};
  return add("bufferViews", view);
}

std::uint32_t GltfBuilder::add_accessor(std::uint32_t view, int component_type,
                                        std::string_view type, std::size_t count, bool normalized) {
  nlohmann::json accessor = {
      {"bufferView", view}, {"componentType", component_type}, {"type", type}, {"count", count}};
  if (normalized) accessor["normalized"] = true;
  return add("accessors", accessor);
}

std::uint32_t GltfBuilder::add(const std::string& array, nlohmann::json value) {
  json[array].push_back(std::move(value));
  return static_cast<std::uint32_t>(json[array].size() - 1);
}

void GltfBuilder::show(nlohmann::json primitive) {
  const std::uint32_t mesh =
      add("meshes", {{"primitives", nlohmann::json::array({std::move(primitive)})}});
  const std::uint32_t node = add("nodes", {{"mesh", mesh}});
  if (!json.contains("scenes")) json["scenes"] = {{{"nodes", nlohmann::json::array()}}};
  json["scenes"][0]["nodes"].push_back(node);
}

std::uint32_t GltfBuilder::add_image(const Bytes& file) {
  return add("images", {{"bufferView", add_view(file)}, {"mimeType", "image/png"}});
}

Bytes GltfBuilder::glb() const {
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  Bytes data = binary;
  data.resize((data.size() + 3) / 4 * 4);
  Bytes file = {'g', 'l', 'T', 'F'};
  append_u32(file, 2);
  append_u32(file, static_cast<std::uint32_t>(12 + 8 + text.size() +
                                              (data.empty() ? 0 : 8 + data.size())));
  append_u32(file, static_cast<std::uint32_t>(text.size()));
  append_u32(file, 0x4e4f534a);
  file.insert(file.end(), text.begin(), text.end());
  if (!data.empty()) {
    append_u32(file, static_cast<std::uint32_t>(data.size()));
    append_u32(file, 0x004e4942);
    file.insert(file.end(), data.begin(), data.end());
  }
  return file;
}

Scene GltfBuilder::import(const ImportLimits& limits, const SceneChoice& choice) const {
  const TemporaryFolder folder;
  return import_gltf(folder.write("scene.glb", glb()), limits, {.choice = choice});
}

GltfBuilder triangle() {
  GltfBuilder builder;
  const std::uint32_t position =
      builder.add_accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, 5126, "VEC3", 3);
  builder.show({{"attributes", {{"POSITION", position}}}});
  return builder;
}

GltfBuilder everything() {
  GltfBuilder builder;
  const auto position =
      builder.add_accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, 5126, "VEC3", 4);
  const auto normal =
      builder.add_accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 5126, "VEC3", 4);
  const auto uv = builder.add_accessor(std::vector<float>{0, 1, 1, 1, 0, 0, 1, 0}, 5126, "VEC2", 4);
  const auto indices =
      builder.add_accessor(std::vector<std::uint16_t>{0, 1, 2, 2, 1, 3}, 5123, "SCALAR", 6);
  const auto image = builder.add_image(png(2, 2, 4, Bytes(16, 200)));
  const auto sampler = builder.add("samplers", {{"wrapS", 33071}});
  const auto texture = builder.add("textures", {{"source", image}, {"sampler", sampler}});
  const auto material = builder.add(
      "materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}},
                    {"normalTexture", {{"index", texture}}}});
  builder.show({{"attributes", {{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", uv}}},
                {"indices", indices},
                {"material", material}});

  builder.json["extensionsUsed"] = {"KHR_lights_punctual"};
  builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "directional"}}};
  builder.add("cameras",
              {{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}});
  builder.json["nodes"][0]["children"] = {1, 2};
  builder.add("nodes", {{"camera", 0}, {"translation", {0, 0, 3}}});
  builder.add("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});

  const auto times = builder.add_accessor(std::vector<float>{0, 1}, 5126, "SCALAR", 2);
  const auto places = builder.add_accessor(std::vector<float>{0, 0, 0, 1, 0, 0}, 5126, "VEC3", 2);
  builder.add(
      "animations",
      {{"samplers", {{{"input", times}, {"output", places}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}}}});
  builder.add("skins", {{"joints", {1, 2}}});
  return builder;
}

Bytes png(std::uint32_t width, std::uint32_t height, int channels, const Bytes& samples,
          int depth) {
  static constexpr std::array<std::uint8_t, 5> color_types = {0, 0, 4, 2, 6};
  Bytes header;
  append_u32(header, width, true);
  append_u32(header, height, true);
  header.insert(header.end(), {static_cast<std::uint8_t>(depth), color_types[channels], 0, 0, 0});
  Bytes rows;
  const std::size_t row_bytes = std::size_t(width) * channels * depth / 8;
  for (std::size_t offset = 0; offset < samples.size(); offset += row_bytes) {
    rows.push_back(0);
    rows.insert(rows.end(), samples.begin() + offset, samples.begin() + offset + row_bytes);
  }
  Bytes file = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  append_chunk(file, "IHDR", header);
  append_chunk(file, "IDAT", store(rows));
  append_chunk(file, "IEND", {});
  return file;
}

Bytes jpeg(std::uint32_t width, std::uint32_t height, const Bytes& rgb, bool progressive) {
  const tjhandle compressor = tjInitCompress();
  unsigned char* data = nullptr;
  unsigned long size = 0;
  tjCompress2(compressor, rgb.data(), static_cast<int>(width), 0, static_cast<int>(height),
              TJPF_RGB, &data, &size, TJSAMP_420, 95, progressive ? TJFLAG_PROGRESSIVE : 0);
  const Bytes file(data, data + size);
  tjFree(data);
  tjDestroy(compressor);
  return file;
}

std::string base64(const Bytes& bytes) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t j = 0; j < 3; ++j)
      bits = bits << 8 | (i + j < bytes.size() ? bytes[i + j] : 0);
    for (std::size_t j = 0; j < 4; ++j) {
      text += i + j <= bytes.size() ? digits[bits >> (18 - 6 * j) & 63] : '=';
    }
  }
  return text;
}

std::string refusal_of(const std::filesystem::path& path, const ImportLimits& limits) {
  try {
    import_gltf(path, limits);
  } catch (const ImportError& error) {
    return error.what();
  }
  return "";
}

std::string refusal_of(const GltfBuilder& builder, const ImportLimits& limits) {
  const TemporaryFolder folder;
  return refusal_of(folder.write("scene.glb", builder.glb()), limits);
}

}  // namespace heliograph::scene::test
