#include "render/resources/emissive/emissive_lights.hpp"

#include <algorithm>
#include <cstring>
#include <span>

namespace heliograph::render {
namespace {

constexpr VkBufferUsageFlags table_usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
constexpr float tolerated_scale = 1.25f;

std::size_t table_bytes(std::size_t entries) {
  return sizeof(shared::EmissiveHeader) + entries * sizeof(shared::EmissiveTriangle);
}

void copy_table(const EmissiveTable& table, std::byte* to) {
  std::memcpy(to, &table.header, sizeof table.header);
  std::ranges::copy(std::as_bytes(std::span(table.triangles)), to + sizeof table.header);
}

}  // namespace

EmissiveBuffers upload_emissive(const gpu::Device& device, const EmissiveTable& table) {
  std::vector<std::byte> bytes(table_bytes(table.triangles.size()));
  copy_table(table, bytes.data());
  return {gpu::upload_buffer(device, "emissive triangles", bytes, table_usage),
          gpu::upload_buffer(device, "emissive instances", std::as_bytes(std::span(table.first)),
                             table_usage)};
}

EmissiveView view_emissive(const EmissiveBuffers& buffers) {
  const std::byte* const table = buffers.table.mapped();
  return {reinterpret_cast<const shared::EmissiveHeader*>(table),
          reinterpret_cast<const shared::EmissiveTriangle*>(table + sizeof(shared::EmissiveHeader)),
          reinterpret_cast<const std::uint32_t*>(buffers.first.mapped())};
}

EmissiveLights::EmissiveLights(const gpu::Device& device, const EmissiveBuffers& shared)
    : device_(device), shared_(shared) {}

bool EmissiveLights::may_shine() const {
  return own_ ? own_->capacity > 0 : shared_.table.size() > table_bytes(0);
}

bool EmissiveLights::remake(const EmissiveScene& from, std::size_t capacity) {
  const bool fits = own_ && own_->capacity >= capacity;
  if (!fits) {
    const std::size_t instances = std::max<std::size_t>(from.scene.instances.size(), 1);
    own_.emplace(Own{{{device_, "emissive triangles now", table_bytes(capacity), table_usage,
                       gpu::Memory::upload},
                      {device_, "emissive instances now", instances * sizeof(std::uint32_t),
                       table_usage, gpu::Memory::upload}},
                     capacity,
                     {}});
  }
  write(from);
  return !fits;
}

void EmissiveLights::write(const EmissiveScene& from) {
  const EmissiveTable table = make_emissive_table(from, own_->capacity);
  copy_table(table, own_->buffers.table.mapped());
  std::ranges::copy(table.first, reinterpret_cast<std::uint32_t*>(own_->buffers.first.mapped()));
  own_->scales.clear();
  for (const glm::mat4& world : from.worlds) own_->scales.push_back(area_scale(world));
}

void EmissiveLights::follow(const EmissiveScene& from, std::span<const std::uint32_t> moved) {
  if (!own_ || own_->capacity == 0) return;
  const bool rescaled = std::ranges::any_of(moved, [&](std::uint32_t i) {
    const scene::Mesh& mesh = from.scene.meshes[from.scene.instances[i].mesh];
    if (from.materials[mesh.material].emissive == glm::vec3(0.0f)) return false;
    const float now = area_scale(from.worlds[i]), then = own_->scales[i];
    return std::max(now, then) > tolerated_scale * std::min(now, then);
  });
  if (rescaled) write(from);
}

}  // namespace heliograph::render
