#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gpu/frame_plan/frame_plan.hpp"
#include "protocol/messages/kinds.hpp"
#include "scene/scene.hpp"

namespace heliograph::tracing {

/// The scene's tables on the device (std430 arrays of shaders/shared/scene.h); outlive all
/// acceleration structures and plans.
struct SceneBuffers {
  gpu::Buffer vertices;    // shared::Vertex
  gpu::Buffer indices;     // uint, relative to the mesh's first vertex
  gpu::Buffer meshes;      // shared::Mesh
  gpu::Buffer instances;   // shared::Instance
  gpu::Buffer materials;   // shared::Material
  gpu::Buffer lights;      // shared::Light
  gpu::Buffer alpha_heap;  // bytes, four to a uint; also a uniform texel buffer
};

/// The same tables in the current pose of one renderer. Static tables are shared; vertices of
/// deforming meshes, instances and lights of a scene with clips belong to the renderer. Frames bind
/// these, never SceneBuffers: contents change between frames, the buffers stay the same for the
/// plan's lifetime.
struct SceneTables {
  const gpu::Buffer& vertices;
  const gpu::Buffer& indices;
  const gpu::Buffer& meshes;
  const gpu::Buffer& instances;
  const gpu::Buffer& materials;
  const gpu::Buffer& lights;
  const gpu::Buffer& alpha_heap;
};

/// What rays are for. A tracer may choose by it how it traces them, never what they hit.
enum class RayKind {
  camera,      // through neighbouring pixels one after the other, nearly parallel
  shadow,      // from surfaces in view to lights
  ambient,     // short ones from surfaces in view
  reflection,  // from surfaces in view
  hit_shadow,  // from what reflections hit to lights
  path,        // of the reference path tracer
};

/// A stream of rays in device buffers: `count` holds a shared::RayCount, `rays` shared::Ray.
struct RayStream {
  gpu::BufferRef count;
  gpu::BufferRef rays;
  std::uint32_t capacity = 0;
  RayKind kind = RayKind::path;
};

/// A tracer's acceleration structure of one scene. Immutable, shared by all plans that trace it,
/// and outlives them. Refers to the scene's buffers, never to the scene.
class AccelerationStructure {
 public:
  virtual ~AccelerationStructure() = default;
  /// Memory of a static structure in bytes, for cache limits; 0 for animated ones.
  virtual std::uint64_t bytes() const { return 0; }
};

/// Changes since the last update of an animated structure.
struct Movement {
  struct Mesh {
    std::uint32_t mesh;
    std::span<const shared::Vertex> vertices;  // of the whole mesh, as in SceneTables::vertices
    scene::Bounds bounds;                      // mesh space
  };
  std::span<const glm::mat4> worlds;     // mesh -> world, of every instance
  std::span<const std::uint32_t> moved;  // instances whose matrix changed
  std::span<const Mesh> deformed;        // meshes whose vertices changed
};

/// One renderer's acceleration structure of an animated scene. Shares static parts with the static
/// structure, and refits or rebuilds only what moved.
class MovingStructure : public virtual AccelerationStructure {
 public:
  /// Updates the structure to the pose of `movement`. Called between frames on the thread that
  /// executes plans, never while a plan traces this structure. Plans stay valid and trace the new
  /// pose in their next frame.
  virtual void update(const Movement& movement) = 0;
};

/// What a shader needs to walk a structure by itself (shaders/lib/rays/bvh.glsl).
struct WalkedHierarchy {
  // Uniform texel buffers in the order of their bindings; as long as the structure.
  const gpu::Buffer& records;
  const gpu::Buffer& triangles;
  const gpu::Buffer& alpha_heap;
  std::function<std::uint32_t()> root;  // of this frame
  /// Nodes of the upper level, whose children are instances or one another.
  struct UpperNodes {
    std::uint32_t first = 0;  // of `records`, shared::BvhNode each
    std::uint32_t count = 0;
  };
  std::function<UpperNodes()> upper_nodes;  // of this frame
  /// Triangles in world space, which never move: a part of `triangles`, shared::BvhTriangle each.
  struct Flat {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    bool all = false;  // there is nothing else that rays can hit
  };
  Flat flat = {};
};

/// Traces rays; other shaders are independent of the tracer, unless they ask for walked().
/// Alpha-masked surfaces are transparent where base color alpha (level 0, nearest texel) x factor
/// is below the cutoff. Blended surfaces stop a ray with probability alpha if the stream has a seed
/// (RayCount::blending), otherwise always. Vertex colors are ignored. Both faces of triangles are
/// hit, at t in (t_min, t_max), 0 <= t_min; rays with an empty interval miss. Instances with a
/// singular matrix are never hit. A tracer outlives its structures and plans.
class RayTracer {
 public:
  virtual ~RayTracer() = default;
  virtual protocol::TracerKind kind() const = 0;

  /// Thread safe.
  virtual std::shared_ptr<const AccelerationStructure> build(const scene::Scene& scene,
                                                             const SceneBuffers& buffers) const = 0;
  /// The same with every instance on its own, so that build_moving() can move them all. Rays find
  /// static triangles two to four times as slowly. Thread safe.
  virtual std::shared_ptr<const AccelerationStructure> build_apart(
      const scene::Scene& scene, const SceneBuffers& buffers) const = 0;
  /// The same without the instances for which `hidden` is true, as `rest` has them: the result of
  /// build() or build_apart() for the same scene. Thread safe.
  virtual std::shared_ptr<const AccelerationStructure> build_without(
      const std::vector<bool>& hidden, std::shared_ptr<const AccelerationStructure> rest,
      const scene::Scene& scene, const SceneBuffers& buffers) const = 0;
  /// A structure for one renderer, in the pose of `scene` until updated. Instances at
  /// scene::movable_nodes() may move, or all of build_apart(); meshes keep their triangles, and
  /// those in `scene.deformations` may change their vertices. Only for scenes with clips, or built
  /// apart. `rest`: the result of a function above, whose hidden instances stay hidden;
  /// `tables`: the renderer's, outlive the structure. Keeps no reference to `scene`. Thread safe.
  virtual std::unique_ptr<MovingStructure> build_moving(
      std::shared_ptr<const AccelerationStructure> rest, const scene::Scene& scene,
      const SceneTables& tables) const = 0;

  /// Adds the pass `name` that writes one shared::Hit per ray.
  virtual void trace_closest(gpu::FramePlan& plan, const std::string& name,
                             const AccelerationStructure& structure, const RayStream& rays,
                             gpu::BufferRef hits) const = 0;
  /// Adds the pass `name` that writes one uint per ray: 1 for a hit, 0 for a miss.
  virtual void trace_any(gpu::FramePlan& plan, const std::string& name,
                         const AccelerationStructure& structure, const RayStream& rays,
                         gpu::BufferRef occluded) const = 0;

  /// What a shader needs that makes and traces rays in one; absent where only the tracer's own
  /// passes can trace the structure.
  virtual std::optional<WalkedHierarchy> walked(const AccelerationStructure&) const { return {}; }
};

/// The software BVH in a compute shader.
std::unique_ptr<RayTracer> make_software_tracer(const gpu::Device& device);
/// Embree on the mapped ray buffers; CPU devices only. @throws gpu::GpuError on others
std::unique_ptr<RayTracer> make_embree_tracer(const gpu::Device& device);
/// The driver's acceleration structures, traced by ray queries in a compute shader. @throws
/// gpu::GpuError where the device lacks VK_KHR_ray_query
std::unique_ptr<RayTracer> make_ray_query_tracer(const gpu::Device& device);
/// The driver's acceleration structures, traced by a ray tracing pipeline. @throws gpu::GpuError
/// where the device lacks VK_KHR_ray_tracing_pipeline
std::unique_ptr<RayTracer> make_ray_pipeline_tracer(const gpu::Device& device);

}  // namespace heliograph::tracing
