#include "scene/gltf/document/gltf_file.hpp"

#include <nlohmann/json.hpp>
#include <utility>

#include "scene/gltf/document/extension_value.hpp"
#include "scene/gltf/document/model_parser.hpp"
#include "scene/gltf/document/uri.hpp"
#include "scene/gltf/geometry/meshopt.hpp"
#include "scene/gltf/schema/json_text.hpp"
#include "scene/gltf/schema/versions.hpp"
#include "scene/import_error.hpp"

namespace heliograph::scene {

GltfFile::GltfFile(const std::filesystem::path& path, const ImportLimits& limits,
                   Warnings& warnings, const std::stop_token& stop)
    : GltfFile(examine_file(path), ConfinedFolder(path.parent_path(), limits.file_bytes),
               RegularFile(path, limits.file_bytes, "the file"), limits, warnings, stop) {}

GltfFile::GltfFile(RegularFile file, const ImportLimits& limits, Warnings& warnings,
                   const std::stop_token& stop)
    : GltfFile({}, {}, std::move(file), limits, warnings, stop) {}

GltfFile::GltfFile(SourceFile self, ConfinedFolder folder, RegularFile file,
                   const ImportLimits& limits, Warnings& warnings, const std::stop_token& stop)
    : stop_(stop),
      self_(std::move(self)),
      folder_(std::move(folder)),
      container_(std::move(file)),
      document_(read_document(limits, warnings)),
      model_(parse_model(document_, [this](std::size_t index) { return read_buffer(index); })) {
  document_.text = {};
  // tinygltf's last view stands for none.
  model_.bufferViews.pop_back();
  for (tinygltf::Accessor& accessor : model_.accessors) {
    if (static_cast<std::size_t>(accessor.bufferView) == model_.bufferViews.size()) {
      accessor.bufferView = -1;
    }
  }
  read_views(limits);
}

CheckedDocument GltfFile::read_document(const ImportLimits& limits, Warnings& warnings) {
  nlohmann::json json =
      parse_json(container_.take_text(), limits.json_depth, limits.json_values, stop_);
  check_versions(json, warnings);
  return check_document(json, limits, warnings, stop_);
}

std::vector<SourceFile> GltfFile::sources() const {
  std::vector<SourceFile> sources{self_};
  sources.insert(sources.end(), folder_.files().begin(), folder_.files().end());
  return sources;
}

std::vector<std::uint8_t> GltfFile::resource(const std::string& place) {
  std::string& uri = document_.uris.at(place);
  try {
    auto bytes = decode_data_uri(uri);
    if (!bytes) return folder_.read(decode_file_uri(uri), stop_);
    uri = {};
    return std::move(*bytes);
  } catch (const MissingFile& error) {
    throw MissingFile(place + ".uri: " + error.what());
  } catch (const ImportError& error) {
    refuse_at(place, "uri", error.what());
  }
}

std::vector<std::uint8_t> GltfFile::read_buffer(std::size_t index) {
  const std::uint64_t length = document_.buffer_lengths[index];
  const std::string place = item_path("", "buffers", index);
  const auto check_length = [&](std::uint64_t available) {
    if (length <= available) return;
    refuse_at(place, "byteLength",
              std::to_string(length) + " is more than the " + std::to_string(available) +
                  " bytes there are");
  };
  if (document_.uris.contains(place)) {
    std::vector<std::uint8_t> bytes = resource(place);
    check_length(bytes.size());
    bytes.resize(length);
    return bytes;
  }
  if (index != 0 || !container_.has_binary()) {
    refuse_at(place, "has neither a uri nor a GLB binary chunk");
  }
  check_length(container_.binary_bytes());
  return container_.read_binary(length, stop_);
}

void GltfFile::read_views(const ImportLimits& limits) {
  std::uint64_t unpacked_budget = limits.unpacked_bytes;
  views_.reserve(model_.bufferViews.size());
  for (std::size_t i = 0; i < model_.bufferViews.size(); ++i) {
    views_.push_back(read_view(i, unpacked_budget));
  }
}

BufferView GltfFile::read_view(std::size_t index, std::uint64_t& unpacked_budget) {
  throw_if_cancelled(stop_);
  const tinygltf::BufferView& view = model_.bufferViews[index];
  const auto stride = static_cast<std::uint32_t>(view.byteStride);
  const std::string place = item_path("", "bufferViews", index);
  const auto bytes_of = [&](std::uint64_t buffer, std::uint64_t offset, std::uint64_t length) {
    if (!document_.buffers_with_data[buffer]) {
      refuse_at(place, "buffer", "refers to a buffer without data");
    }
    return std::span(model_.buffers[buffer].data).subspan(offset, length);
  };
  if (const auto packed = find_extension(view.extensions, "EXT_meshopt_compression", place)) {
    const auto source =
        bytes_of(*packed->integer("buffer"), packed->integer("byteOffset").value_or(0),
                 *packed->integer("byteLength"));
    unpacked_views_.push_back(unpack_meshopt(*packed, source, view.byteLength, unpacked_budget));
    return {unpacked_views_.back(), stride};
  }
  return {bytes_of(static_cast<std::uint64_t>(view.buffer), view.byteOffset, view.byteLength),
          stride};
}

}  // namespace heliograph::scene
