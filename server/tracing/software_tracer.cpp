#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "shaders/embedded.hpp"
#include "shaders/shared/ray.h"
#include "tracing/bvh.hpp"
#include "tracing/embree.hpp"
#include "tracing/ray_tracer.hpp"

namespace heliograph::tracing {
namespace {

void check_texels(const gpu::Device& device, const std::string& name, std::size_t texels) {
  const std::size_t most = device.limits().maxTexelBufferElements;
  if (texels <= most) return;
  throw gpu::GpuError("the scene's " + name + " takes " + std::to_string(texels) +
                      " texels, but the device reads at most " + std::to_string(most));
}

/// Uploads texels of four floats. The view is made here, where one thread builds, because plans on
/// several threads share it later.
template <typename Element>
gpu::Buffer upload_texels(const gpu::Device& device, const std::string& name,
                          const std::vector<Element>& elements) {
  const auto bytes = std::as_bytes(std::span(elements));
  check_texels(device, name, bytes.size() / sizeof(glm::vec4));
  gpu::Buffer buffer =
      gpu::upload_buffer(device, name, bytes, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
  buffer.texel_view(VK_FORMAT_R32G32B32A32_SFLOAT);
  return buffer;
}

class SoftwareStructure : public AccelerationStructure {
 public:
  SoftwareStructure(const gpu::Device& device, const Bvh& bvh, const gpu::Buffer& masks)
      : records(upload_texels(device, "bvh.records", bvh.records)),
        triangles(upload_texels(device, "bvh.triangles", bvh.triangles)),
        alpha_heap(masks),
        root(bvh.root) {
    check_texels(device, masks.name(), masks.size() / sizeof(std::uint32_t));
    masks.texel_view(VK_FORMAT_R32_UINT);
  }

  gpu::Buffer records;
  gpu::Buffer triangles;
  const gpu::Buffer& alpha_heap;
  std::uint32_t root;
};

class SoftwareTracer : public RayTracer {
 public:
  explicit SoftwareTracer(const gpu::Device& device)
      : device_(device),
        embree_(make_embree_device()),
        closest_(device, shaders::trace_closest),
        any_(device, shaders::trace_any) {}

  protocol::TracerKind kind() const override { return protocol::TracerKind::software; }

  std::shared_ptr<const AccelerationStructure> build(const scene::Scene& scene,
                                                     const SceneBuffers& buffers) const override {
    return std::make_shared<SoftwareStructure>(device_, build_bvh(embree_.get(), scene),
                                               buffers.alpha_heap);
  }

  void trace_closest(gpu::FramePlan& plan, const std::string& name,
                     const AccelerationStructure& structure, const RayStream& rays,
                     gpu::BufferRef hits) const override {
    add_pass(plan, name, closest_, structure, rays, hits);
  }

  void trace_any(gpu::FramePlan& plan, const std::string& name,
                 const AccelerationStructure& structure, const RayStream& rays,
                 gpu::BufferRef occluded) const override {
    add_pass(plan, name, any_, structure, rays, occluded);
  }

 private:
  static void add_pass(gpu::FramePlan& plan, const std::string& name,
                       const gpu::ComputeProgram& program, const AccelerationStructure& structure,
                       const RayStream& rays, gpu::BufferRef answers) {
    const auto& bvh = dynamic_cast<const SoftwareStructure&>(structure);
    plan.pass(name, program)
        .read(rays.count)
        .read(rays.rays)
        .read(plan.import(bvh.records))
        .read(plan.import(bvh.triangles))
        .read(plan.import(bvh.alpha_heap))
        .write(answers)
        .constants(bvh.root)
        .dispatch_indirect(rays.count, offsetof(shared::RayCount, groups_x));
  }

  const gpu::Device& device_;
  EmbreeHandle<RTCDevice> embree_;
  gpu::ComputeProgram closest_;
  gpu::ComputeProgram any_;
};

}  // namespace

std::unique_ptr<RayTracer> make_software_tracer(const gpu::Device& device) {
  return std::make_unique<SoftwareTracer>(device);
}

}  // namespace heliograph::tracing
