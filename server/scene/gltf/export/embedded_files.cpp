#include "scene/gltf/export/embedded_files.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "scene/gltf/schema/place.hpp"
#include "scene/import_error.hpp"

namespace heliograph::scene {
namespace {

using nlohmann::json;

// Of every buffer and image, so that accessors stay aligned.
constexpr std::size_t chunk_alignment = 8;

class Embedding {
 public:
  Embedding(GltfFile& file, EditableDocument& document, const ImportLimits& limits)
      : file_(file), document_(document), most_(limits.file_bytes) {}

  std::vector<std::uint8_t> embed(std::span<const AddedImage> added) {
    json buffers = document_.list("buffers");
    for (std::size_t i = 0; i < buffers.size(); ++i) join(i, buffers[i]);
    for (json& view : document_.list("bufferViews")) relocate(view);
    json& images = document_.list("images");
    for (std::size_t i = 0; i < images.size(); ++i) embed_image(i);
    for (const AddedImage& image : added) put(image.image, image.file);
    json joined = json::array();
    if (!bytes_.empty()) joined.push_back({{"byteLength", bytes_.size()}});
    for (json& placeholder : placeholders_) joined.push_back(std::move(placeholder));
    document_.root()["buffers"] = std::move(joined);
    return std::move(bytes_);
  }

 private:
  struct BufferPlace {
    std::size_t buffer = 0;
    std::uint64_t offset = 0;
  };

  /// Room for more, aligned.
  std::span<std::uint8_t> grow(std::uint64_t more) {
    const std::size_t start =
        (bytes_.size() + chunk_alignment - 1) / chunk_alignment * chunk_alignment;
    if (more > most_ || start > most_ - more) {
      throw ImportError("the file would have more than the " + std::to_string(most_) +
                        " bytes of the limit on files");
    }
    bytes_.resize(start + more);
    return std::span(bytes_).subspan(start);
  }

  std::uint64_t offset_of(std::span<const std::uint8_t> part) const {
    return static_cast<std::uint64_t>(part.data() - bytes_.data());
  }

  /// Buffers without data stand for unpacked views; so does what no view uses, without its bytes.
  void join(std::size_t index, json& buffer) {
    BufferPlace& place = places_.emplace_back();
    if (file_.has_data(index)) {
      const std::span<std::uint8_t> part = grow(file_.buffer_bytes(index));
      file_.copy_buffer(index, part);
      place.offset = offset_of(part);
      return;
    }
    buffer.erase("uri");
    placeholders_.push_back(std::move(buffer));
    place.buffer = placeholders_.size();
  }

  void relocate(json& owner) {
    move_reference(owner);
    const auto extensions = owner.find("extensions");
    if (extensions == owner.end()) return;
    for (json& extension : *extensions) {
      if (extension.is_object()) move_reference(extension);
    }
  }

  void move_reference(json& owner) {
    const auto buffer = owner.find("buffer");
    if (buffer == owner.end() || !buffer->is_number()) return;
    const BufferPlace& place = places_.at(buffer->get<std::size_t>());
    *buffer = place.buffer;
    const std::uint64_t offset = place.offset + owner.value("byteOffset", std::uint64_t(0));
    if (offset > 0) owner["byteOffset"] = offset;
  }

  void embed_image(std::size_t index) {
    if (!document_.list("images")[index].contains("uri")) return;
    const std::string place = item_path("", "images", index);
    std::vector<std::uint8_t> file;
    try {
      file = file_.resource(place);
    } catch (const MissingFile& error) {
      document_.list("images")[index]["uri"] = file_.address(place);
      return document_.warn(std::string(error.what()) + ": the image stays outside the file");
    }
    document_.list("images")[index].erase("uri");
    put(index, file);
  }

  void put(std::size_t index, std::span<const std::uint8_t> file) {
    const std::span<std::uint8_t> part = grow(file.size());
    std::ranges::copy(file, part.begin());
    const std::size_t view = document_.append(
        "bufferViews",
        {{"buffer", 0}, {"byteOffset", offset_of(part)}, {"byteLength", part.size()}});
    json& image = document_.list("images")[index];
    image["bufferView"] = view;
    if (!image.contains("mimeType")) image["mimeType"] = mime_type_of(file);
  }

  GltfFile& file_;
  EditableDocument& document_;
  const std::uint64_t most_;
  std::vector<std::uint8_t> bytes_;
  std::vector<BufferPlace> places_;  // by buffer of the source
  std::vector<json> placeholders_;
};

}  // namespace

std::string_view mime_type_of(std::span<const std::uint8_t> file) {
  using namespace std::string_view_literals;
  const std::string_view start(reinterpret_cast<const char*>(file.data()),
                               std::min<std::size_t>(file.size(), 16));
  if (start.starts_with("\x89PNG"sv)) return "image/png";
  if (start.starts_with("\xff\xd8"sv)) return "image/jpeg";
  if (start.starts_with("RIFF"sv) && start.substr(8).starts_with("WEBP"sv)) return "image/webp";
  if (start.starts_with("\xabKTX 20"sv)) return "image/ktx2";
  return "application/octet-stream";
}

std::vector<std::uint8_t> embed_files(GltfFile& file, EditableDocument& document,
                                      std::span<const AddedImage> added,
                                      const ImportLimits& limits) {
  return Embedding(file, document, limits).embed(added);
}

}  // namespace heliograph::scene
