#include "scene/gltf/geometry/meshopt.hpp"

#include <meshoptimizer.h>

#include <string>

namespace heliograph::scene {
namespace {

enum class Mode { attributes, triangles, indices };
enum class MeshoptFilter { none, octahedral, quaternion, exponential };

struct Layout {
  Mode mode = Mode::attributes;
  MeshoptFilter filter = MeshoptFilter::none;
  std::size_t count = 0;
  std::size_t stride = 0;  // bytes
};

Mode read_mode(const ExtensionValue& packed) {
  const std::string name = packed.text("mode");
  if (name == "TRIANGLES") return Mode::triangles;
  return name == "INDICES" ? Mode::indices : Mode::attributes;
}

MeshoptFilter read_filter(const ExtensionValue& packed) {
  const std::string name = packed.text("filter");
  if (name == "OCTAHEDRAL") return MeshoptFilter::octahedral;
  if (name == "QUATERNION") return MeshoptFilter::quaternion;
  return name == "EXPONENTIAL" ? MeshoptFilter::exponential : MeshoptFilter::none;
}

// Preconditions of the decoders.
void check_stride(const ExtensionValue& packed, const Layout& layout) {
  const std::size_t stride = layout.stride;
  if (layout.mode != Mode::attributes) {
    if (stride != 2 && stride != 4) packed.refuse("byteStride", "must be 2 or 4 for indices");
    if (layout.filter != MeshoptFilter::none) packed.refuse("filter", "is for attributes only");
    return;
  }
  if (stride < 4 || stride > 256 || stride % 4 != 0) {
    packed.refuse("byteStride", "must be a multiple of 4 from 4 to 256");
  }
  if (layout.filter == MeshoptFilter::octahedral && stride != 4 && stride != 8) {
    packed.refuse("byteStride", "must be 4 or 8 for the octahedral filter");
  }
  if (layout.filter == MeshoptFilter::quaternion && stride != 8) {
    packed.refuse("byteStride", "must be 8 for the quaternion filter");
  }
}

Layout read_layout(const ExtensionValue& packed, std::uint64_t length, std::uint64_t budget) {
  Layout layout;
  layout.mode = read_mode(packed);
  layout.filter = read_filter(packed);
  const std::uint64_t stride = *packed.integer("byteStride");
  const std::uint64_t count = *packed.integer("count");
  layout.stride = stride;
  check_stride(packed, layout);
  if (count > budget / stride) {
    packed.refuse("count", "unpacks to more bytes than the limit for the whole file");
  }
  if (count * stride != length) {
    packed.refuse("count", "times byteStride is not the byteLength of the buffer view");
  }
  if (layout.mode == Mode::triangles && count % 3 != 0) {
    packed.refuse("count", "is not a whole number of triangles");
  }
  layout.count = count;
  return layout;
}

bool decode(const Layout& layout, std::span<const std::uint8_t> source, std::uint8_t* target) {
  const auto [mode, filter, count, stride] = layout;
  switch (mode) {
    case Mode::attributes:
      return meshopt_decodeVertexBuffer(target, count, stride, source.data(), source.size()) == 0;
    case Mode::triangles:
      return meshopt_decodeIndexBuffer(target, count, stride, source.data(), source.size()) == 0;
    case Mode::indices:
      return meshopt_decodeIndexSequence(target, count, stride, source.data(), source.size()) == 0;
  }
  return false;
}

void apply_filter(const Layout& layout, std::uint8_t* bytes) {
  switch (layout.filter) {
    case MeshoptFilter::none:
      return;
    case MeshoptFilter::octahedral:
      return meshopt_decodeFilterOct(bytes, layout.count, layout.stride);
    case MeshoptFilter::quaternion:
      return meshopt_decodeFilterQuat(bytes, layout.count, layout.stride);
    case MeshoptFilter::exponential:
      return meshopt_decodeFilterExp(bytes, layout.count, layout.stride);
  }
}

}  // namespace

std::vector<std::uint8_t> unpack_meshopt(const ExtensionValue& packed,
                                         std::span<const std::uint8_t> source, std::uint64_t length,
                                         std::uint64_t& budget) {
  const Layout layout = read_layout(packed, length, budget);
  budget -= length;
  std::vector<std::uint8_t> bytes(length);
  if (!decode(layout, source, bytes.data())) packed.refuse("has damaged data");
  apply_filter(layout, bytes.data());
  return bytes;
}

}  // namespace heliograph::scene
