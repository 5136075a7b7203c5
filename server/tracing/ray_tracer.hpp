#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "gpu/frame_plan.hpp"
#include "protocol/kinds.hpp"
#include "scene/scene.hpp"

namespace heliograph::tracing {

/// The scene's tables on the device (std430 arrays of shaders/shared/scene.h); they outlive every
/// acceleration structure and plan.
struct SceneBuffers {
  gpu::Buffer vertices;    // shared::Vertex
  gpu::Buffer indices;     // uint, relative to the mesh's first vertex
  gpu::Buffer meshes;      // shared::Mesh
  gpu::Buffer instances;   // shared::Instance
  gpu::Buffer materials;   // shared::Material
  gpu::Buffer lights;      // shared::Light
  gpu::Buffer alpha_heap;  // bytes, four to a uint; also a uniform texel buffer
};

/// A stream of rays in device buffers: `count` holds a shared::RayCount, `rays` shared::Ray.
struct RayStream {
  gpu::BufferRef count;
  gpu::BufferRef rays;
  std::uint32_t capacity = 0;
};

/// What a tracer has built for one scene. Immutable, shared by all plans that trace it, and
/// outlives them. Refers to the scene's buffers, never to the scene.
class AccelerationStructure {
 public:
  virtual ~AccelerationStructure() = default;
};

/// Answers rays. Every other shader is the same whatever traces. Alpha-masked surfaces let rays
/// through where their base colour's alpha (level 0, nearest texel) x factor is below the cutoff;
/// rays see both faces of every triangle; hits at t in (t_min, t_max), 0 <= t_min; rays
/// with an empty interval miss. Instances squeezed flat, so that their matrix has no inverse, are
/// not met. A tracer outlives its structures and plans.
class RayTracer {
 public:
  virtual ~RayTracer() = default;
  virtual protocol::TracerKind kind() const = 0;

  /// Thread safe.
  virtual std::shared_ptr<const AccelerationStructure> build(const scene::Scene& scene,
                                                             const SceneBuffers& buffers) const = 0;

  /// Adds the pass `name` that writes one shared::Hit per ray.
  virtual void trace_closest(gpu::FramePlan& plan, const std::string& name,
                             const AccelerationStructure& structure, const RayStream& rays,
                             gpu::BufferRef hits) const = 0;
  /// Adds the pass `name` that writes one uint per ray: 1 where anything was hit, 0 where nothing.
  virtual void trace_any(gpu::FramePlan& plan, const std::string& name,
                         const AccelerationStructure& structure, const RayStream& rays,
                         gpu::BufferRef occluded) const = 0;
};

/// Our BVH in a compute shader.
std::unique_ptr<RayTracer> make_software_tracer(const gpu::Device& device);
/// Embree on the mapped ray buffers; CPU devices only. @throws gpu::GpuError on others
std::unique_ptr<RayTracer> make_embree_tracer(const gpu::Device& device);

}  // namespace heliograph::tracing
