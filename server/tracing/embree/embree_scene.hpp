#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "scene/scene.hpp"
#include "tracing/bvh/alpha_mask.hpp"
#include "tracing/embree/embree.hpp"
#include "tracing/ray_tracer.hpp"

namespace heliograph::tracing {

/// One mesh as an Embree scene, for any number of instances.
class EmbreeMesh {
 public:
  enum class Use { rigid, deforming };

  /// `alpha_heap` is the scene's and must stay alive.
  EmbreeMesh(RTCDevice device, const scene::Mesh& mesh, const shared::Material& material,
             std::span<const std::uint8_t> alpha_heap, Use use);

  /// Null for meshes without triangles.
  RTCScene handle() const { return scene_.get(); }
  /// Refits a deforming mesh to its moved vertices.
  void refit(std::span<const shared::Vertex> vertices);

 private:
  struct Mask {
    AlphaMask mask;
    std::span<const std::uint8_t> heap;
  };

  static void let_through(const RTCFilterFunctionNArguments* arguments);

  std::unique_ptr<const Mask> mask_;  // null for opaque meshes
  EmbreeHandle<RTCGeometry> geometry_;
  EmbreeHandle<RTCScene> scene_;
  glm::vec3* positions_ = nullptr;  // owned by the geometry
};

/// All meshes of a scene. @throws std::runtime_error when Embree fails
std::vector<std::shared_ptr<EmbreeMesh>> make_embree_meshes(
    RTCDevice device, const scene::Scene& scene, std::span<const std::uint8_t> alpha_heap);

/// Instances of meshes; geometry ids are indices of the scene's instances.
class EmbreeScene {
 public:
  /// In the pose of `scene`; keeps no reference to it. @throws std::runtime_error
  EmbreeScene(RTCDevice device, const scene::Scene& scene,
              std::vector<std::shared_ptr<EmbreeMesh>> meshes);

  RTCScene handle() const { return top_.get(); }
  const std::vector<std::shared_ptr<EmbreeMesh>>& meshes() const { return meshes_; }

  /// The changes below take effect with commit().
  void place(std::size_t instance, const glm::mat4& world);
  void refit(std::span<const Movement::Mesh> deformed);
  void commit();

 private:
  struct Placed {
    std::uint32_t mesh;
    EmbreeHandle<RTCGeometry> geometry;  // null for meshes without triangles
  };

  RTCDevice device_;
  std::vector<std::shared_ptr<EmbreeMesh>> meshes_;
  std::vector<Placed> placed_;  // by instance
  EmbreeHandle<RTCScene> top_;
};

}  // namespace heliograph::tracing
