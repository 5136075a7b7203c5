#include "tests/unit/scene/support/encoders.hpp"

#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>
#include <meshoptimizer.h>
#include <webp/encode.h>

#include <array>
#include <cmath>

namespace heliograph::scene::test {
namespace {

template <typename T>
std::uint32_t add_attribute(::draco::Mesh& mesh, ::draco::GeometryAttribute::Type type,
                            std::int8_t components, ::draco::DataType data_type,
                            const std::vector<T>& values) {
  ::draco::GeometryAttribute attribute;
  attribute.Init(type, nullptr, components, data_type, false, sizeof(T), 0);
  const int id = mesh.AddAttribute(attribute, true, static_cast<std::uint32_t>(values.size()));
  for (std::uint32_t i = 0; i < values.size(); ++i) {
    mesh.attribute(id)->SetAttributeValue(::draco::AttributeValueIndex(i), &values[i]);
  }
  return mesh.attribute(id)->unique_id();
}

Bytes head(Bytes bytes, std::size_t size) {
  bytes.resize(size);
  return bytes;
}

}  // namespace

DracoOutput draco(const DracoInput& input) {
  ::draco::Mesh mesh;
  mesh.set_num_points(static_cast<std::uint32_t>(input.positions.size()));
  for (std::size_t i = 0; i < input.indices.size(); i += 3) {
    mesh.AddFace({::draco::PointIndex(input.indices[i]), ::draco::PointIndex(input.indices[i + 1]),
                  ::draco::PointIndex(input.indices[i + 2])});
  }
  DracoOutput output;
  using Attribute = ::draco::GeometryAttribute;
  output.ids["POSITION"] =
      add_attribute(mesh, Attribute::POSITION, 3, ::draco::DT_FLOAT32, input.positions);
  if (!input.normals.empty()) {
    output.ids["NORMAL"] =
        add_attribute(mesh, Attribute::NORMAL, 3, ::draco::DT_FLOAT32, input.normals);
  }
  if (!input.uv.empty()) {
    output.ids["TEXCOORD_0"] =
        add_attribute(mesh, Attribute::TEX_COORD, 2, ::draco::DT_FLOAT32, input.uv);
  }
  if (!input.joints.empty()) {
    output.ids["JOINTS_0"] =
        add_attribute(mesh, Attribute::GENERIC, 4, ::draco::DT_UINT8, input.joints);
  }
  if (input.metadata) {
    auto metadata = std::make_unique<::draco::GeometryMetadata>();
    metadata->AddEntryString("author", "a test");
    mesh.AddMetadata(std::move(metadata));
  }
  ::draco::ExpertEncoder encoder(mesh);
  encoder.SetEncodingMethod(input.sequential ? ::draco::MESH_SEQUENTIAL_ENCODING
                                             : ::draco::MESH_EDGEBREAKER_ENCODING);
  encoder.SetAttributeQuantization(0, 14);
  encoder.SetTrackEncodedProperties(true);
  ::draco::EncoderBuffer buffer;
  if (!encoder.EncodeToBuffer(&buffer).ok()) throw std::runtime_error("Draco does not encode");
  output.bytes.assign(buffer.data(), buffer.data() + buffer.size());
  output.vertices = static_cast<std::uint32_t>(encoder.num_encoded_points());
  output.triangles = static_cast<std::uint32_t>(encoder.num_encoded_faces());
  return output;
}

Bytes pack_vertices(const Bytes& vertices, std::size_t stride) {
  const std::size_t count = vertices.size() / stride;
  Bytes packed(meshopt_encodeVertexBufferBound(count, stride));
  const std::size_t size =
      meshopt_encodeVertexBuffer(packed.data(), packed.size(), vertices.data(), count, stride);
  return head(std::move(packed), size);
}

Bytes pack_triangles(const std::vector<std::uint32_t>& indices, std::size_t vertex_count) {
  Bytes packed(meshopt_encodeIndexBufferBound(indices.size(), vertex_count));
  const std::size_t size =
      meshopt_encodeIndexBuffer(packed.data(), packed.size(), indices.data(), indices.size());
  return head(std::move(packed), size);
}

Bytes pack_sequence(const std::vector<std::uint32_t>& indices, std::size_t vertex_count) {
  Bytes packed(meshopt_encodeIndexSequenceBound(indices.size(), vertex_count));
  const std::size_t size =
      meshopt_encodeIndexSequence(packed.data(), packed.size(), indices.data(), indices.size());
  return head(std::move(packed), size);
}

Bytes octahedral(const std::vector<glm::vec4>& vectors) {
  Bytes bytes(vectors.size() * 4);
  meshopt_encodeFilterOct(bytes.data(), vectors.size(), 4, 8, &vectors[0].x);
  return bytes;
}

Bytes quaternions(const std::vector<glm::vec4>& rotations) {
  Bytes bytes(rotations.size() * 8);
  meshopt_encodeFilterQuat(bytes.data(), rotations.size(), 8, 12, &rotations[0].x);
  return bytes;
}

Bytes exponential(const std::vector<glm::vec3>& vectors) {
  // 2^E * M with a separate exponent per component: 8 bits of E, 24 of M.
  Bytes bytes(vectors.size() * 12);
  for (std::size_t i = 0; i < vectors.size() * 3; ++i) {
    int exponent = 0;
    const float mantissa = std::frexp((&vectors[0].x)[i], &exponent);
    const auto whole = static_cast<std::int32_t>(std::lround(mantissa * float(1 << 22)));
    const std::uint32_t word = static_cast<std::uint32_t>(exponent - 22) << 24 |
                               (static_cast<std::uint32_t>(whole) & 0xffffffu);
    std::memcpy(bytes.data() + i * 4, &word, 4);
  }
  return bytes;
}

Bytes webp(std::uint32_t width, std::uint32_t height, const Bytes& rgba, bool lossless) {
  std::uint8_t* data = nullptr;
  const int w = static_cast<int>(width);
  const int h = static_cast<int>(height);
  const std::size_t size = lossless ? WebPEncodeLosslessRGBA(rgba.data(), w, h, w * 4, &data)
                                    : WebPEncodeRGBA(rgba.data(), w, h, w * 4, 95.0f, &data);
  const Bytes file(data, data + size);
  WebPFree(data);
  return file;
}

}  // namespace heliograph::scene::test
