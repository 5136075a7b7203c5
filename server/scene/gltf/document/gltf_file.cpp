#include "scene/gltf/document/gltf_file.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <nlohmann/json.hpp>

#include "scene/gltf/document/uri.hpp"
#include "scene/gltf/geometry/meshopt.hpp"
#include "scene/quote.hpp"

namespace heliograph::scene {
namespace {

constexpr std::uint32_t glb_magic = 0x46546c67;         // "glTF"
constexpr std::uint32_t glb_json_chunk = 0x4e4f534a;    // "JSON"
constexpr std::uint32_t glb_binary_chunk = 0x004e4942;  // "BIN"

constexpr std::string_view meshopt_extension = "EXT_meshopt_compression";

constexpr std::array<std::string_view, 16> supported_extensions = {
    meshopt_extension,
    "EXT_mesh_gpu_instancing",
    "EXT_texture_webp",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_materials_clearcoat",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
};

bool is_supported(const std::string& extension) {
  return std::find(supported_extensions.begin(), supported_extensions.end(), extension) !=
         supported_extensions.end();
}

// glTF is little-endian, as is every machine this server runs on.
std::uint32_t read_u32(std::span<const std::uint8_t> bytes, std::size_t offset) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

struct Chunk {
  std::uint32_t type = 0;
  std::span<const std::uint8_t> bytes;
};

std::vector<Chunk> read_glb_chunks(std::span<const std::uint8_t> file) {
  if (file.size() < 12) throw ImportError("GLB header is truncated");
  const std::uint32_t version = read_u32(file, 4);
  if (version != 2) throw ImportError("GLB version " + std::to_string(version) + " is not 2");
  const std::uint32_t length = read_u32(file, 8);
  if (length > file.size() || length < 12)
    throw ImportError("GLB is truncated: its header claims more bytes");
  std::vector<Chunk> chunks;
  std::size_t offset = 12;
  while (offset < length && chunks.size() < 2) {
    if (length - offset < 8) throw ImportError("GLB chunk header is truncated");
    const std::uint32_t size = read_u32(file, offset);
    const std::uint32_t type = read_u32(file, offset + 4);
    offset += 8;
    if (size > length - offset) throw ImportError("GLB chunk reaches past the end of the file");
    chunks.push_back({type, file.subspan(offset, size)});
    offset += std::min<std::size_t>((std::size_t(size) + 3) / 4 * 4, length - offset);
  }
  if (chunks.empty() || chunks[0].type != glb_json_chunk) {
    throw ImportError("GLB does not begin with a JSON chunk");
  }
  return chunks;
}

/// A fallback buffer of EXT_meshopt_compression, which has no data.
bool is_fallback(const JsonValue& buffer) {
  const auto extension = buffer.object("extensions", meshopt_extension);
  return extension && extension->boolean("fallback", false);
}

/// The byteOffset of `length` bytes, which must lie within the `available` ones.
std::uint64_t check_range(const JsonValue& view, std::uint64_t available, std::uint64_t length) {
  const std::uint64_t offset = view.integer("byteOffset", 0);
  if (offset > available || length > available - offset) {
    view.refuse("reaches past the end of its buffer");
  }
  return offset;
}

std::string_view as_text(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

GltfFile::GltfFile(const std::filesystem::path& path, const ImportLimits& limits)
    : self_(examine_file(path)),
      folder_(path.parent_path(), limits.file_bytes),
      file_(read_regular_file(path, limits.file_bytes, "the file")) {
  read_container(file_, limits);
  check_asset();
  check_extensions();
  read_buffers();
  read_views(limits);
}

GltfFile::~GltfFile() = default;

std::vector<SourceFile> GltfFile::sources() const {
  std::vector<SourceFile> sources{self_};
  sources.insert(sources.end(), folder_.files().begin(), folder_.files().end());
  return sources;
}

JsonValue GltfFile::root() const {
  return JsonValue(*json_, "");
}

void GltfFile::read_container(const std::vector<std::uint8_t>& file, const ImportLimits& limits) {
  if (file.empty()) throw ImportError("the file is empty");
  std::string_view text = as_text(file);
  if (file.size() >= 4 && read_u32(file, 0) == glb_magic) {
    const std::vector<Chunk> chunks = read_glb_chunks(file);
    text = as_text(chunks[0].bytes);
    if (chunks.size() > 1 && chunks[1].type == glb_binary_chunk) binary_chunk_ = chunks[1].bytes;
  } else {
    const std::size_t start = text.find_first_not_of(" \t\r\n");
    if (start == std::string_view::npos || text[start] != '{') {
      throw ImportError("not a glTF file: neither GLB nor JSON");
    }
  }
  json_ = std::make_unique<nlohmann::json>(parse_json(text, limits.json_depth, limits.json_values));
}

void GltfFile::check_asset() const {
  const auto asset = root().object("asset");
  if (!asset) throw ImportError("not a glTF file: asset is missing");
  const std::string version = asset->text("version");
  if (!version.starts_with("2.")) asset->refuse("version", in_quotes(version) + " is not 2.x");
  const std::string minimum = asset->text("minVersion");
  if (!minimum.empty() && minimum != "2.0") {
    asset->refuse("minVersion", in_quotes(minimum) + " is newer than 2.0");
  }
}

void GltfFile::check_extensions() {
  std::string missing;
  for (const std::string& extension : root().texts("extensionsRequired")) {
    if (!is_supported(extension)) missing += (missing.empty() ? "" : ", ") + in_quotes(extension);
  }
  if (!missing.empty()) throw ImportError("requires extensions that are not supported: " + missing);
  for (const std::string& extension : root().texts("extensionsUsed")) {
    if (!is_supported(extension)) ignored_extensions_.push_back(in_quotes(extension));
  }
}

std::vector<std::uint8_t> GltfFile::resource(const JsonValue& owner) {
  const std::string uri = owner.text("uri");
  try {
    if (auto bytes = decode_data_uri(uri)) return std::move(*bytes);
    return folder_.read(decode_file_uri(uri));
  } catch (const ImportError& error) {
    owner.refuse("uri", error.what());
  }
}

void GltfFile::read_buffers() {
  const std::vector<JsonValue> buffers = root().objects("buffers");
  loaded_buffers_.reserve(buffers.size());
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const JsonValue& buffer = buffers[i];
    const std::uint64_t length = buffer.required_integer("byteLength");
    if (length == 0) buffer.refuse("byteLength", "must be at least 1");
    std::span<const std::uint8_t> bytes = binary_chunk_;
    if (buffer.has("uri")) {
      bytes = loaded_buffers_.emplace_back(resource(buffer));
    } else if (is_fallback(buffer)) {
      buffers_.push_back({{}, length});
      continue;
    } else if (i != 0 || binary_chunk_.empty()) {
      buffer.refuse("has neither a uri nor a GLB binary chunk");
    }
    if (length > bytes.size()) {
      buffer.refuse("byteLength", std::to_string(length) + " is more than the " +
                                      std::to_string(bytes.size()) + " bytes there are");
    }
    buffers_.push_back({bytes.first(length), length});
  }
}

void GltfFile::read_views(const ImportLimits& limits) {
  std::uint64_t unpacked_budget = limits.unpacked_bytes;
  for (const JsonValue& view : root().objects("bufferViews")) {
    views_.push_back(read_view(view, unpacked_budget));
  }
}

BufferView GltfFile::read_view(const JsonValue& view, std::uint64_t& unpacked_budget) {
  const Buffer& buffer = buffers_[view.required_index("buffer", buffers_.size(), "buffers")];
  const std::uint64_t length = view.required_integer("byteLength");
  if (length == 0) view.refuse("byteLength", "must be at least 1");
  const std::uint64_t offset = check_range(view, buffer.length, length);
  const std::uint64_t stride = view.integer("byteStride", 0);
  if (stride != 0 && (stride < 4 || stride > 252 || stride % 4 != 0)) {
    view.refuse("byteStride", "must be a multiple of 4 from 4 to 252");
  }
  if (const auto packed = view.object("extensions", meshopt_extension)) {
    const Buffer& source = buffers_[packed->required_index("buffer", buffers_.size(), "buffers")];
    const std::uint64_t packed_length = packed->required_integer("byteLength");
    const std::uint64_t packed_offset = check_range(*packed, source.bytes.size(), packed_length);
    unpacked_views_.push_back(unpack_meshopt(
        *packed, source.bytes.subspan(packed_offset, packed_length), length, unpacked_budget));
    return {unpacked_views_.back(), static_cast<std::uint32_t>(stride)};
  }
  if (buffer.bytes.empty()) view.refuse("buffer", "refers to a buffer without data");
  return {buffer.bytes.subspan(offset, length), static_cast<std::uint32_t>(stride)};
}

}  // namespace heliograph::scene
