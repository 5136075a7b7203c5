#include "scene/gltf/geometry/draco.hpp"

#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>

#include <algorithm>
#include <memory>
#include <string>

namespace heliograph::scene {
namespace {

[[noreturn]] void refuse(const DracoGeometry& geometry, const std::string& reason) {
  throw ImportError(geometry.path + ": " + reason);
}

draco::DecoderBuffer open(const DracoGeometry& geometry) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(geometry.bytes.data()), geometry.bytes.size());
  return buffer;
}

draco::DracoHeader read_header(const DracoGeometry& geometry, draco::DecoderBuffer& buffer) {
  draco::DracoHeader header;
  if (!draco::PointCloudDecoder::DecodeHeader(&buffer, &header).ok()) {
    refuse(geometry, "is not a Draco stream");
  }
  // The only version that KHR_draco_mesh_compression permits.
  if (header.version_major != 2 || header.version_minor != 2) {
    refuse(geometry, "has a bitstream version other than 2.2");
  }
  if (header.encoder_type != draco::TRIANGULAR_MESH) refuse(geometry, "does not contain a mesh");
  buffer.set_bitstream_version(DRACO_BITSTREAM_VERSION(2, 2));
  return header;
}

/// Skips a stream's metadata, which is not used.
class MetadataSkipper {
 public:
  explicit MetadataSkipper(draco::DecoderBuffer& buffer) : buffer_(buffer) {}

  bool skip_all() {
    std::uint32_t attributes = 0;
    if (!draco::DecodeVarint(&attributes, &buffer_)) return false;
    for (std::uint32_t i = 0; i < attributes; ++i) {
      std::uint32_t id = 0;
      if (!draco::DecodeVarint(&id, &buffer_) || !skip(0)) return false;
    }
    return skip(0);
  }

 private:
  bool skip(int depth) {
    constexpr int deepest = 8;
    std::uint32_t entries = 0;
    if (depth > deepest || !draco::DecodeVarint(&entries, &buffer_)) return false;
    for (std::uint32_t i = 0; i < entries; ++i) {
      std::uint32_t size = 0;
      if (!skip_name() || !draco::DecodeVarint(&size, &buffer_) || !advance(size)) return false;
    }
    std::uint32_t children = 0;
    if (!draco::DecodeVarint(&children, &buffer_)) return false;
    for (std::uint32_t i = 0; i < children; ++i) {
      if (!skip_name() || !skip(depth + 1)) return false;
    }
    return true;
  }

  bool skip_name() {
    std::uint8_t length = 0;
    return buffer_.Decode(&length) && advance(length);
  }

  bool advance(std::int64_t bytes) {
    if (bytes > buffer_.remaining_size()) return false;
    buffer_.Advance(bytes);
    return true;
  }

  draco::DecoderBuffer& buffer_;
};

/// Stops after the list of attributes, before their data, which a few bytes can expand to any size.
template <typename Decoder>
class BoundedDecoder : public Decoder {
 protected:
  bool DecodeAllAttributes() override {
    // 16 attributes of four 4-byte components: the maximum that glTF can use.
    constexpr std::int64_t most_bytes_a_vertex = 256;
    std::int64_t bytes = 0;
    for (int i = 0; i < this->point_cloud()->num_attributes(); ++i) {
      const draco::PointAttribute& attribute = *this->point_cloud()->attribute(i);
      bytes += std::max<std::int64_t>(attribute.byte_stride(), 4 * attribute.num_components());
    }
    return bytes <= most_bytes_a_vertex && Decoder::DecodeAllAttributes();
  }
};

std::unique_ptr<draco::MeshDecoder> make_decoder(std::uint8_t method) {
  if (method == draco::MESH_EDGEBREAKER_ENCODING) {
    return std::make_unique<BoundedDecoder<draco::MeshEdgebreakerDecoder>>();
  }
  return std::make_unique<BoundedDecoder<draco::MeshSequentialDecoder>>();
}

std::unique_ptr<draco::Mesh> decode_mesh(const DracoGeometry& geometry) {
  draco::DecoderBuffer buffer = open(geometry);
  const draco::DracoHeader header = read_header(geometry, buffer);
  buffer = open(geometry);
  auto mesh = std::make_unique<draco::Mesh>();
  const draco::DecoderOptions options;
  const auto decoder = make_decoder(header.encoder_method);
  if (!decoder->Decode(options, &buffer, mesh.get()).ok()) refuse(geometry, "has damaged data");
  return mesh;
}

template <typename T>
bool convert(const draco::PointAttribute& attribute, std::uint32_t points,
             std::vector<std::uint8_t>& bytes) {
  const std::int8_t components = attribute.num_components();
  std::vector<T> element(components);
  bytes.resize(std::size_t{points} * components * sizeof(T));
  for (std::uint32_t i = 0; i < points; ++i) {
    const draco::AttributeValueIndex value = attribute.mapped_index(draco::PointIndex(i));
    if (value.value() >= attribute.size()) return false;
    if (!attribute.ConvertValue<T>(value, components, element.data())) return false;
    std::copy_n(reinterpret_cast<const std::uint8_t*>(element.data()), components * sizeof(T),
                bytes.data() + std::size_t{i} * components * sizeof(T));
  }
  return true;
}

bool convert(const draco::PointAttribute& attribute, std::uint32_t points, ComponentType component,
             std::vector<std::uint8_t>& bytes) {
  switch (component) {
    case ComponentType::i8:
      return convert<std::int8_t>(attribute, points, bytes);
    case ComponentType::u8:
      return convert<std::uint8_t>(attribute, points, bytes);
    case ComponentType::i16:
      return convert<std::int16_t>(attribute, points, bytes);
    case ComponentType::u16:
      return convert<std::uint16_t>(attribute, points, bytes);
    case ComponentType::u32:
      return convert<std::uint32_t>(attribute, points, bytes);
    case ComponentType::f32:
      return convert<float>(attribute, points, bytes);
  }
  return false;
}

class Unpacker {
 public:
  Unpacker(const Primitive& primitive, std::span<const Accessor> accessors)
      : geometry_(*primitive.draco),
        accessors_(accessors),
        decoded_(decode_mesh(geometry_)),
        mesh_(*decoded_),
        result_{primitive, {}, {}} {}

  UnpackedPrimitive unpack() {
    Primitive& primitive = result_.primitive;
    primitive.draco.reset();
    primitive.mode =
        Primitive::Mode::triangles;  // Draco meshes are triangles whatever the document's mode
    primitive.for_each_attribute([&](std::string_view name, std::uint32_t& accessor) {
      accessor = take_attribute(name, accessors_[accessor]);
    });
    for (Primitive::Target& target : primitive.targets) {
      for (auto* const accessor : {&target.position, &target.normal, &target.tangent}) {
        if (*accessor) *accessor = keep(accessors_[**accessor]);
      }
    }
    primitive.indices = add_indices();
    return std::move(result_);
  }

 private:
  std::uint32_t append(Accessor accessor) {
    result_.accessors.push_back(std::move(accessor));
    return static_cast<std::uint32_t>(result_.accessors.size() - 1);
  }

  std::uint32_t append(Accessor accessor, std::vector<std::uint8_t> bytes, std::uint32_t count) {
    accessor.count = count;
    accessor.stride = element_bytes(accessor.element, accessor.component);
    accessor.sparse.reset();
    accessor.bytes = result_.storage.emplace_back(std::move(bytes));
    return append(std::move(accessor));
  }

  std::uint32_t keep(const Accessor& accessor) {
    if (accessor.count != mesh_.num_points()) {
      accessor.refuse("differs in count from the compressed vertices");
    }
    return append(accessor);
  }

  std::uint32_t take_attribute(std::string_view name, const Accessor& accessor) {
    const auto found = geometry_.attributes.find(name);
    if (found == geometry_.attributes.end()) return keep(accessor);
    const std::string label(name);
    const draco::PointAttribute* attribute = mesh_.GetAttributeByUniqueId(found->second);
    if (!attribute) refuse(geometry_, "has no attribute for " + label);
    if (attribute->num_components() != component_count(accessor.element)) {
      refuse(geometry_, label + " has another element type than its accessor");
    }
    std::vector<std::uint8_t> bytes;
    if (!convert(*attribute, mesh_.num_points(), accessor.component, bytes)) {
      refuse(geometry_, label + " does not fit the component type of its accessor");
    }
    return append(accessor, std::move(bytes), mesh_.num_points());
  }

  std::uint32_t add_indices() {
    const std::uint32_t count = mesh_.num_faces() * 3;
    std::vector<std::uint8_t> bytes(std::size_t{count} * 4);
    for (std::uint32_t i = 0; i < mesh_.num_faces(); ++i) {
      const draco::Mesh::Face& face = mesh_.face(draco::FaceIndex(i));
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const std::uint32_t index = face[corner].value();
        const auto* const first = reinterpret_cast<const std::uint8_t*>(&index);
        std::copy_n(first, 4, bytes.data() + (std::size_t{i} * 3 + corner) * 4);
      }
    }
    Accessor accessor;
    accessor.path = geometry_.path;
    accessor.component = ComponentType::u32;
    return append(std::move(accessor), std::move(bytes), count);
  }

  const DracoGeometry& geometry_;
  std::span<const Accessor> accessors_;
  std::unique_ptr<draco::Mesh> decoded_;
  const draco::Mesh& mesh_;
  UnpackedPrimitive result_;
};

}  // namespace

DracoCounts probe_draco(const DracoGeometry& geometry) {
  draco::DecoderBuffer buffer = open(geometry);
  const draco::DracoHeader header = read_header(geometry, buffer);
  const auto cut = [&] { refuse(geometry, "has a damaged Draco header"); };
  if ((header.flags & METADATA_FLAG_MASK) && !MetadataSkipper(buffer).skip_all()) cut();
  std::uint32_t first = 0;
  std::uint32_t second = 0;
  if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING) {
    std::uint8_t traversal = 0;
    if (!buffer.Decode(&traversal)) cut();
  } else if (header.encoder_method != draco::MESH_SEQUENTIAL_ENCODING) {
    refuse(geometry, "has an unknown encoding");
  }
  if (!draco::DecodeVarint(&first, &buffer) || !draco::DecodeVarint(&second, &buffer)) cut();
  if (header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING) return {first, second};
  return {second, 3 * std::uint64_t{second}};
}

UnpackedPrimitive unpack_draco(const Primitive& primitive, std::span<const Accessor> accessors) {
  return Unpacker(primitive, accessors).unpack();
}

}  // namespace heliograph::scene
