#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>
#include <vector>

#include "scene/scene.hpp"
#include "tracing/embree/embree.hpp"
#include "tracing/embree/embree_mesh.hpp"
#include "tracing/ray_tracer.hpp"

namespace heliograph::tracing {

/// How a scene is handed to Embree.
struct EmbreeLayout {
  bool flat = true;  // false: every instance is an instance of Embree's, too
  /// What copies of triangles may take (flat_instances()), and again what a fast copy may: a
  /// quarter of the default scene cache each.
  std::uint64_t most_bytes = std::uint64_t{256} << 20;
  EmbreeBuild build = {};
  /// Builds the flat triangles a second time, not robust, for EmbreeScene::scenes(): rays find them
  /// in 75 to 90 % of the time.
  bool fast_copy = true;
};

/// A scene of Embree's, null where there is nothing.
struct EmbreeTarget {
  RTCScene scene = nullptr;
  bool robust = true;
};

/// What rays traverse, one after the other.
struct EmbreeScenes {
  EmbreeTarget flat;       // triangles; geometry ids are indices of the scene's instances
  EmbreeTarget instanced;  // instances, whose ids are these indices
};

/// A scene as Embree traces it: what stays in its place as triangles in world space, all else as
/// instances of meshes.
class EmbreeScene {
 public:
  /// In the pose of `scene`; keeps no reference to it. `alpha_heap` is the scene's and must stay
  /// alive. @throws std::runtime_error, scene::LoadCancelled
  EmbreeScene(RTCDevice device, const scene::Scene& scene, std::span<const std::uint8_t> alpha_heap,
              const EmbreeLayout& layout, const std::stop_token& stop = {});
  /// Without the instances for which `hidden` is true; shares all triangles with `rest`, of the
  /// same scene. There is no fast copy, so that it is made in half the time.
  /// @throws std::runtime_error
  EmbreeScene(RTCDevice device, const scene::Scene& scene, const EmbreeScene& rest,
              const std::vector<bool>& hidden);
  /// One that may move; shares with `rest`, of the same scene, all that stays as it is.
  /// @throws std::runtime_error
  EmbreeScene(RTCDevice device, const scene::Scene& scene, const EmbreeScene& rest);

  /// For rays of one kind: the fast copy, unless they are the camera's or a path's. In it, of rays
  /// in random directions about one in five million passes between two triangles of a fine mesh,
  /// and a few per cent of those that a regular grid of pixels sends exactly along edges.
  EmbreeScenes scenes(RayKind kind) const;

  /// Of instances below nodes that a clip animates. The changes take effect with commit().
  /// @throws std::invalid_argument for other instances
  void place(std::size_t instance, const glm::mat4& world);
  void refit(std::span<const Movement::Mesh> deformed);
  void commit();

 private:
  struct Placed {
    std::uint32_t mesh;
    bool flat;
    bool hidden;
    EmbreeHandle<RTCGeometry> instance;  // null for flat and hidden instances and empty meshes
  };

  void make_mesh(std::size_t number, const scene::Scene& scene,
                 std::span<const std::uint8_t> alpha_heap, bool instanced,
                 const std::stop_token& stop);
  bool in_flat_scene(const scene::Scene& scene, std::size_t instance) const;
  void place_instances(const scene::Scene& scene);

  RTCDevice device_;
  EmbreeLayout layout_;
  std::vector<std::shared_ptr<const EmbreeMesh>> meshes_;
  std::vector<std::shared_ptr<EmbreeMeshScene>> mesh_scenes_;  // null unless instanced
  std::vector<Placed> placed_;                                 // by instance
  std::shared_ptr<RTCSceneTy> flat_;
  std::shared_ptr<RTCSceneTy> fast_;  // null: flat_ is for all kinds
  EmbreeHandle<RTCScene> top_;
};

}  // namespace heliograph::tracing
