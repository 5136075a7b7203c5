#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "gpu/frame_plan/frame_plan.hpp"
#include "protocol/messages/kinds.hpp"
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

/// The same tables as one renderer sees them in its pose of the moment. What never moves is the
/// shared table itself; vertices of meshes that deform, instances and lights of a scene with clips
/// are the renderer's own. Bind these, never SceneBuffers, wherever a frame reads the scene: their
/// contents change between frames, the buffers stay the same as long as the plan.
struct SceneTables {
  const gpu::Buffer& vertices;
  const gpu::Buffer& indices;
  const gpu::Buffer& meshes;
  const gpu::Buffer& instances;
  const gpu::Buffer& materials;
  const gpu::Buffer& lights;
  const gpu::Buffer& alpha_heap;
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
  /// Memory of a structure at rest, for limits on what is kept; 0 of one that moves.
  virtual std::uint64_t bytes() const { return 0; }
};

/// What changed since a moving structure was last told.
struct Movement {
  struct Mesh {
    std::uint32_t mesh;
    std::span<const shared::Vertex> vertices;  // of the whole mesh, as SceneTables::vertices has it
    scene::Bounds bounds;                      // mesh space
  };
  std::span<const glm::mat4> worlds;     // mesh -> world, of every instance
  std::span<const std::uint32_t> moved;  // instances whose matrix changed
  std::span<const Mesh> deformed;        // meshes whose vertices changed
};

/// One renderer's structure over a scene that moves. It shares with the structure at rest whatever
/// stays as it is, and refits or builds anew only what moved.
class MovingStructure : public virtual AccelerationStructure {
 public:
  /// Brings the structure into the pose that `movement` describes. Called between frames, on the
  /// thread that executes plans, never while one that traces this structure runs: plans that were
  /// declared with it stay valid and see the new pose in their next frame.
  virtual void update(const Movement& movement) = 0;
};

/// Answers rays. Every other shader is the same whatever traces. Alpha-masked surfaces let rays
/// through where their base colour's alpha (level 0, nearest texel) x factor is below the cutoff;
/// blended ones let through what they do not cover, ray by ray, where the stream asks for it
/// (RayCount::blending), and stop every ray where not; colours of vertices do not count for rays;
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
  /// A structure for one renderer, in the pose of `scene` until it is updated. Its instances may be
  /// placed anew; its meshes keep their triangles, and those named by `scene.deformations` may
  /// change their vertices. Only for scenes with clips. `rest` is what build() made of it; `tables`
  /// are the renderer's own and outlive the structure. Keeps no reference to `scene`. Thread safe.
  virtual std::unique_ptr<MovingStructure> build_moving(
      std::shared_ptr<const AccelerationStructure> rest, const scene::Scene& scene,
      const SceneTables& tables) const = 0;

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
/// The driver's hierarchy, walked by a compute shader. @throws gpu::GpuError where the device lacks
/// VK_KHR_ray_query
std::unique_ptr<RayTracer> make_ray_query_tracer(const gpu::Device& device);
/// The driver's hierarchy and the driver's way to walk it. @throws gpu::GpuError where the device
/// lacks VK_KHR_ray_tracing_pipeline
std::unique_ptr<RayTracer> make_ray_pipeline_tracer(const gpu::Device& device);

}  // namespace heliograph::tracing
