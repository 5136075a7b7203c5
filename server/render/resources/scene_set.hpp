#pragma once

#include "gpu/memory/descriptors.hpp"
#include "render/resources/emissive/emissive_lights.hpp"
#include "render/resources/texture_heap.hpp"
#include "tracing/ray_tracer.hpp"

namespace heliograph::render {

/// Bindings of set 3 (shaders/lib/scene/scene_tables.glsl).
std::vector<gpu::DescriptorLayout::Binding> scene_bindings();

/// Points set 3 at the tables of a scene, its textures, the layers of its materials
/// and its emissive triangles.
void write_scene_set(const gpu::Device& device, VkDescriptorSet set,
                     const tracing::SceneTables& tables, const TextureHeap& heap,
                     const gpu::Buffer& layers, const EmissiveBuffers& emissive);

}  // namespace heliograph::render
