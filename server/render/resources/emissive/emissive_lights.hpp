#pragma once

#include <optional>

#include "gpu/memory/buffer.hpp"
#include "render/resources/emissive/emissive_table.hpp"

namespace heliograph::render {

/// A table on the device, as shaders/lib/scene/scene_tables.glsl binds it.
struct EmissiveBuffers {
  gpu::Buffer table;  // shared::EmissiveHeader, then shared::EmissiveTriangle each
  gpu::Buffer first;  // EmissiveTable::first
};

/// The same where the host reaches it: on devices that are processors.
struct EmissiveView {
  const shared::EmissiveHeader* header;
  const shared::EmissiveTriangle* triangles;
  const std::uint32_t* first;
};
EmissiveView view_emissive(const EmissiveBuffers& buffers);

/// A table that never changes.
EmissiveBuffers upload_emissive(const gpu::Device& device, const EmissiveTable& table);

/// The emissive triangles of one renderer's scene: the shared table as long as nothing but rigid
/// motion happens, which needs no other, since shaders read where triangles are; one of its own for
/// other materials or scales. Nothing here may be called while a frame runs.
class EmissiveLights {
 public:
  /// `shared`: of the scene at rest; outlives this.
  EmissiveLights(const gpu::Device& device, const EmissiveBuffers& shared);

  const EmissiveBuffers& buffers() const { return own_ ? own_->buffers : shared_; }
  /// Whether buffers() has entries, or may have them without becoming others.
  bool may_shine() const;

  /// Makes a table of its own, with room for `capacity` entries.
  /// @return whether buffers() are others: plans must be rebuilt
  bool remake(const EmissiveScene& from, std::size_t capacity);
  /// Makes the table again, where there is one of its own, if `moved` instances shine that are by a
  /// quarter larger or smaller now than when it was made.
  void follow(const EmissiveScene& from, std::span<const std::uint32_t> moved);

 private:
  struct Own {
    EmissiveBuffers buffers;
    std::size_t capacity = 0;
    std::vector<float> scales;  // by instance, when the table was made
  };

  void write(const EmissiveScene& from);

  const gpu::Device& device_;
  const EmissiveBuffers& shared_;
  std::optional<Own> own_;
};

}  // namespace heliograph::render
