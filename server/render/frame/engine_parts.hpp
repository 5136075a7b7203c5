#pragma once

#include <memory>
#include <mutex>

#include "gpu/device/device.hpp"
#include "gpu/pipelines/shader_reload.hpp"
#include "render/api/engine.hpp"
#include "render/resources/environment/lit_environment.hpp"
#include "render/resources/programs.hpp"
#include "render/resources/tables/ltc_table.hpp"
#include "tracing/ray_tracer.hpp"

namespace heliograph::render {

/// What an engine is made of, in order of construction.
struct Engine::Parts {
  explicit Parts(const EngineOptions& options);

  gpu::Instance instance;
  gpu::Device device;
  std::unique_ptr<gpu::ShaderReload> shader_reload;  // null without a folder of shaders
  Programs programs;
  EnvironmentCache environments;
  std::unique_ptr<tracing::RayTracer> tracer;
  gpu::Image split_sum_table;
  gpu::Image sheen_table;
  gpu::Image ltc_table;
  gpu::Buffer jpeg_tables;  // none where frames are not encoded
  gpu::Sampler around;      // wraps in u: equirectangular maps
  gpu::Sampler clamped;
  DeviceInfo info;
  bool host_kernels;
  bool compressed_textures;
  std::mutex empty_mutex;
  std::shared_ptr<const SceneResources> empty;  // made when the first renderer asks for it
};

}  // namespace heliograph::render
