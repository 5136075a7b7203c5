#include "scene/gltf/document/gltf_file.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "scene/gltf/document/extension_value.hpp"
#include "scene/gltf/document/image_views.hpp"
#include "scene/gltf/document/model_parser.hpp"
#include "scene/gltf/document/uri.hpp"
#include "scene/gltf/geometry/meshopt.hpp"
#include "scene/gltf/schema/json_text.hpp"
#include "scene/gltf/schema/versions.hpp"
#include "scene/import_error.hpp"

namespace heliograph::scene {

GltfFile::GltfFile(const std::filesystem::path& path, const ImportLimits& limits,
                   Warnings& warnings, const std::stop_token& stop, Document document)
    : GltfFile(examine_file(path), ConfinedFolder(path.parent_path(), limits.file_bytes),
               RegularFile(path, limits.file_bytes, "the file"), limits, warnings, stop, document) {
}

GltfFile::GltfFile(RegularFile file, const ImportLimits& limits, Warnings& warnings,
                   const std::stop_token& stop)
    : GltfFile({}, {}, std::move(file), limits, warnings, stop, Document::dropped) {}

GltfFile::GltfFile(SourceFile self, ConfinedFolder folder, RegularFile file,
                   const ImportLimits& limits, Warnings& warnings, const std::stop_token& stop,
                   Document document)
    : stop_(stop),
      self_(std::move(self)),
      folder_(std::move(folder)),
      container_(std::move(file)),
      document_(read_document(limits, warnings, document)),
      model_(parse_model(document_)) {
  document_.text = {};
  // tinygltf's last view stands for none.
  model_.bufferViews.pop_back();
  for (tinygltf::Accessor& accessor : model_.accessors) {
    if (static_cast<std::size_t>(accessor.bufferView) == model_.bufferViews.size()) {
      accessor.bufferView = -1;
    }
  }
  read_buffers();
  read_views(limits);
}

CheckedDocument GltfFile::read_document(const ImportLimits& limits, Warnings& warnings,
                                        Document document) {
  nlohmann::json json =
      parse_json(container_.take_text(), limits.json_depth, limits.json_values, stop_);
  check_versions(json, warnings);
  CheckedDocument checked = check_document(json, limits, warnings, stop_);
  if (document == Document::kept) whole_ = std::make_shared<nlohmann::json>(std::move(json));
  return checked;
}

nlohmann::json GltfFile::take_document() {
  return std::move(*whole_);
}

void GltfFile::copy_buffer(std::size_t buffer, std::span<std::uint8_t> to) const {
  const Bytes& bytes = buffers_[buffer];
  if (bytes.binary) return container_.read_binary(0, to, stop_);
  std::ranges::copy(bytes.all, to.begin());
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

std::uint64_t GltfFile::resource_bytes(const std::string& place) const {
  const std::string& uri = address(place);
  if (uri.starts_with("data:")) return uri.size() / 4 * 3;
  try {
    return folder_.size_of(decode_file_uri(uri));
  } catch (const ImportError&) {
    return 0;  // reading it tells why
  }
}

void GltfFile::read_buffers() {
  image_views_.resize(model_.bufferViews.size());
  buffers_.resize(document_.buffer_lengths.size());
  for (std::size_t index = 0; index < buffers_.size(); ++index) {
    if (!document_.buffers_with_data[index]) continue;
    const std::uint64_t length = document_.buffer_lengths[index];
    const std::string place = item_path("", "buffers", index);
    const auto check_length = [&](std::uint64_t available) {
      if (length <= available) return;
      refuse_at(place, "byteLength",
                std::to_string(length) + " is more than the " + std::to_string(available) +
                    " bytes there are");
    };
    Bytes& buffer = buffers_[index];
    if (document_.uris.contains(place)) {
      buffer.file = resource(place);
      check_length(buffer.file.size());
      buffer.all = std::span(buffer.file).first(length);
      continue;
    }
    if (index != 0 || !container_.has_binary()) {
      refuse_at(place, "has neither a uri nor a GLB binary chunk");
    }
    check_length(container_.binary_bytes());
    image_views_ = find_image_views(model_);
    for (std::size_t i = 0; i < image_views_.size(); ++i) {
      if (model_.bufferViews[i].buffer != 0) image_views_[i] = false;
    }
    buffer.binary = std::make_unique_for_overwrite<std::uint8_t[]>(length);
    buffer.all = {buffer.binary.get(), length};
    read_binary({buffer.binary.get(), length});
  }
}

void GltfFile::read_binary(std::span<std::uint8_t> bytes) const {
  std::vector<std::pair<std::uint64_t, std::uint64_t>> ranges;  // first byte, and the one after
  for (std::size_t i = 0; i < image_views_.size(); ++i) {
    const tinygltf::BufferView& view = model_.bufferViews[i];
    if (const auto packed = find_extension(view.extensions, "EXT_meshopt_compression", "")) {
      const std::uint64_t first = packed->integer("byteOffset").value_or(0);
      if (packed->integer("buffer") == 0u) {
        ranges.emplace_back(first, first + *packed->integer("byteLength"));
      }
    } else if (view.buffer == 0 && !image_views_[i]) {
      ranges.emplace_back(view.byteOffset, view.byteOffset + view.byteLength);
    }
  }
  std::ranges::sort(ranges);
  std::uint64_t done = 0;
  for (const auto& [first, end] : ranges) {
    const std::uint64_t from = std::max(first, done);
    if (from >= end) continue;
    container_.read_binary(from, bytes.subspan(from, end - from), stop_);
    done = end;
  }
}

std::vector<std::uint8_t> GltfFile::image_file(std::uint32_t view) const {
  if (!image_views_[view]) return {views_[view].bytes.begin(), views_[view].bytes.end()};
  const tinygltf::BufferView& source = model_.bufferViews[view];
  std::vector<std::uint8_t> bytes(source.byteLength);
  container_.read_binary(source.byteOffset, bytes, stop_);
  return bytes;
}

void GltfFile::drop_views() {
  for (const tinygltf::Image& image : model_.images) {
    const auto view = to_index(image.bufferView);
    if (view && !image_views_[*view]) return;
  }
  views_.assign(views_.size(), {});
  unpacked_views_.clear();
  buffers_.clear();
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
    return buffers_[buffer].all.subspan(offset, length);
  };
  if (image_views_[index]) return {{}, stride};
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
