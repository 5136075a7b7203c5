#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "scene/scene.hpp"
#include "tracing/bvh/alpha_mask.hpp"
#include "tracing/embree/embree.hpp"

namespace heliograph::tracing {

/// Trade between speed and exactness of an Embree scene.
struct EmbreeBuild {
  bool robust = true;  // watertight between adjacent triangles
  RTCBuildQuality quality = RTC_BUILD_QUALITY_MEDIUM;
};

/// An empty scene to attach geometries to. @throws std::runtime_error
EmbreeHandle<RTCScene> new_embree_scene(RTCDevice device, const EmbreeBuild& build,
                                        RTCSceneFlags flags = RTC_SCENE_FLAG_NONE);

/// Triangles with vertices to be written before the geometry is committed.
struct EmbreeGeometry {
  EmbreeHandle<RTCGeometry> handle;
  std::span<glm::vec3> positions;  // owned by the geometry
};

/// Triangles and alpha mask of a mesh, shared by all geometries of it, which it outlives.
class EmbreeMesh {
 public:
  /// `alpha_heap` is the scene's and must stay alive. @throws std::runtime_error
  EmbreeMesh(RTCDevice device, const scene::Mesh& mesh, const shared::Material& material,
             std::span<const std::uint8_t> alpha_heap);

  /// Whether rays cannot hit it: no triangles, or none that a ray would see.
  bool empty() const { return !indices_; }
  /// Not of an empty mesh. @throws std::runtime_error
  EmbreeGeometry make_geometry(RTCDevice device) const;

 private:
  struct Mask {
    AlphaMask mask;
    std::span<const std::uint8_t> heap;
  };

  static void let_through(const RTCFilterFunctionNArguments* arguments);

  std::size_t vertex_count_;
  std::size_t triangle_count_;
  std::unique_ptr<const Mask> mask_;  // null for opaque meshes
  EmbreeHandle<RTCBuffer> indices_;
};

/// One mesh as an Embree scene, for any number of instances.
class EmbreeMeshScene {
 public:
  enum class Use { rigid, deforming };

  /// @throws std::runtime_error, scene::LoadCancelled
  EmbreeMeshScene(RTCDevice device, std::shared_ptr<const EmbreeMesh> source,
                  const scene::Mesh& mesh, Use use, const EmbreeBuild& build,
                  const std::stop_token& stop = {});

  RTCScene handle() const { return scene_.get(); }
  /// Refits a deforming mesh to its moved vertices.
  void refit(std::span<const shared::Vertex> vertices);

 private:
  std::shared_ptr<const EmbreeMesh> source_;
  EmbreeGeometry geometry_;
  EmbreeHandle<RTCScene> scene_;
};

}  // namespace heliograph::tracing
