#pragma once

#include "gpu/memory/descriptors.hpp"
#include "render/resources/texture_heap.hpp"
#include "tracing/ray_tracer.hpp"

namespace heliograph::render {

/// Bindings of set 3 (shaders/lib/scene/scene_tables.glsl).
std::vector<gpu::DescriptorLayout::Binding> scene_bindings();

/// Points set 3 at the tables of a scene, its textures and the layers of its materials.
void write_scene_set(const gpu::Device& device, VkDescriptorSet set,
                     const tracing::SceneTables& tables, const TextureHeap& heap,
                     const gpu::Buffer& layers);

}  // namespace heliograph::render
