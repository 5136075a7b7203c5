#include "tracing/embree/embree_scene.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "scene/first_failure.hpp"
#include "scene/import_error.hpp"
#include "tracing/bvh/bvh.hpp"
#include "tracing/flat_instances.hpp"

namespace heliograph::tracing {
namespace {

/// The fast copy has spatial splits between these. Rays then take 2 to 10 % less time in scenes of
/// 190,000 to 345,000 triangles; in smaller ones anything from 5 % less to 8 % more. Beyond the
/// limit building takes longer than it is worth at load: 1.5 microseconds per triangle.
constexpr std::size_t least_split_triangles = 100'000;
constexpr std::size_t most_split_triangles = 1'000'000;

/// The flat instances that rays can hit, as triangles in world space.
class FlatGeometries {
 public:
  FlatGeometries(RTCDevice device, const scene::Scene& scene,
                 std::span<const std::shared_ptr<const EmbreeMesh>> meshes,
                 const std::vector<bool>& flat)
      : device_(device) {
    for (unsigned i = 0; i < scene.instances.size(); ++i) {
      const auto& [mesh, node] = scene.instances[i];
      if (!flat[i] || meshes[mesh]->empty() || !traceable_inverse(scene.nodes[node].world)) {
        continue;
      }
      geometries_.push_back({i, nullptr});
      triangles_ += scene.meshes[mesh].indices.size() / 3;
    }
    tbb::parallel_for(std::size_t(0), geometries_.size(), [&](std::size_t i) {
      const auto& [mesh, node] = scene.instances[geometries_[i].instance];
      const glm::mat4& world = scene.nodes[node].world;
      EmbreeGeometry geometry = meshes[mesh]->make_geometry(device);
      std::ranges::transform(scene.meshes[mesh].vertices, geometry.positions.begin(),
                             [&world](const shared::Vertex& vertex) {
                               return glm::vec3(world * glm::vec4(vertex.position, 1.0f));
                             });
      rtcCommitGeometry(geometry.handle.get());
      geometries_[i].handle = std::move(geometry.handle);
    });
  }

  std::size_t triangles() const { return triangles_; }

  /// Null without triangles. @throws scene::LoadCancelled
  EmbreeHandle<RTCScene> build(const EmbreeBuild& build, const std::stop_token& stop) const {
    if (geometries_.empty()) return nullptr;
    EmbreeHandle<RTCScene> scene = new_embree_scene(device_, build);
    for (const Placed& each : geometries_) {
      rtcAttachGeometryByID(scene.get(), each.handle.get(), each.instance);
    }
    commit_scene(device_, scene.get(), "build the scene of triangles", stop);
    return scene;
  }

 private:
  struct Placed {
    unsigned instance;
    EmbreeHandle<RTCGeometry> handle;
  };

  RTCDevice device_;
  std::size_t triangles_ = 0;
  std::vector<Placed> geometries_;
};

}  // namespace

EmbreeScene::EmbreeScene(RTCDevice device, const scene::Scene& scene,
                         std::span<const std::uint8_t> alpha_heap, const EmbreeLayout& layout,
                         const std::stop_token& stop)
    : device_(device),
      layout_(layout),
      meshes_(scene.meshes.size()),
      mesh_scenes_(scene.meshes.size()) {
  const std::vector<bool> flat = layout.flat ? flat_instances(scene, layout.most_bytes)
                                             : std::vector<bool>(scene.instances.size());
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    placed_.push_back({scene.instances[i].mesh, flat[i], false, nullptr});
  }
  std::vector<bool> instanced(scene.meshes.size());
  for (const Placed& each : placed_) {
    if (!each.flat) instanced[each.mesh] = true;
  }
  scene::FirstFailure failure;
  tbb::parallel_for(std::size_t(0), meshes_.size(), [&](std::size_t i) {
    failure.guard([&] { make_mesh(i, scene, alpha_heap, instanced[i], stop); });
  });
  failure.rethrow();
  const FlatGeometries geometries(device, scene, meshes_, flat);
  flat_ = geometries.build(layout.build, stop);
  if (layout.fast_copy && geometries.triangles() <= layout.most_bytes / flat_triangle_bytes) {
    const bool split = geometries.triangles() >= least_split_triangles &&
                       geometries.triangles() <= most_split_triangles;
    fast_ = geometries.build(
        {.robust = false, .quality = split ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM},
        stop);
  }
  place_instances(scene);
}

EmbreeScene::EmbreeScene(RTCDevice device, const scene::Scene& scene, const EmbreeScene& rest,
                         const std::vector<bool>& hidden)
    : device_(device),
      layout_(rest.layout_),
      meshes_(rest.meshes_),
      mesh_scenes_(rest.mesh_scenes_) {
  EmbreeHandle<RTCScene> flat;
  for (unsigned i = 0; i < rest.placed_.size(); ++i) {
    const Placed& each = rest.placed_[i];
    placed_.push_back({each.mesh, each.flat, hidden[i], nullptr});
    if (hidden[i] || !in_flat_scene(scene, i)) continue;
    if (!flat) flat = new_embree_scene(device, layout_.build);
    rtcAttachGeometryByID(flat.get(), rtcGetGeometry(rest.flat_.get(), i), i);
  }
  if (flat) rtcCommitScene(flat.get());
  check_embree(device, "build the scene of what is shown");
  flat_ = std::move(flat);
  place_instances(scene);
}

EmbreeScene::EmbreeScene(RTCDevice device, const scene::Scene& scene, const EmbreeScene& rest)
    : device_(device),
      layout_(rest.layout_),
      meshes_(rest.meshes_),
      mesh_scenes_(rest.mesh_scenes_),
      flat_(rest.flat_),
      fast_(rest.fast_) {
  for (const Placed& each : rest.placed_) {
    placed_.push_back({each.mesh, each.flat, each.hidden, nullptr});
  }
  for (const scene::Deformation& deformation : scene.deformations) {
    auto& deforming = mesh_scenes_[deformation.mesh];
    if (!deforming) continue;
    deforming = std::make_shared<EmbreeMeshScene>(device, meshes_[deformation.mesh],
                                                  scene.meshes[deformation.mesh],
                                                  EmbreeMeshScene::Use::deforming, layout_.build);
  }
  place_instances(scene);
}

void EmbreeScene::make_mesh(std::size_t number, const scene::Scene& scene,
                            std::span<const std::uint8_t> alpha_heap, bool instanced,
                            const std::stop_token& stop) {
  scene::throw_if_cancelled(stop);
  const scene::Mesh& mesh = scene.meshes[number];
  meshes_[number] =
      std::make_shared<const EmbreeMesh>(device_, mesh, scene.materials[mesh.material], alpha_heap);
  if (!instanced || meshes_[number]->empty()) return;
  mesh_scenes_[number] = std::make_shared<EmbreeMeshScene>(
      device_, meshes_[number], mesh, EmbreeMeshScene::Use::rigid, layout_.build, stop);
}

EmbreeScenes EmbreeScene::scenes(RayKind kind) const {
  const bool watertight = kind == RayKind::camera || kind == RayKind::path;
  const bool robust = layout_.build.robust;
  const EmbreeTarget flat =
      fast_ && !watertight ? EmbreeTarget{fast_.get(), false} : EmbreeTarget{flat_.get(), robust};
  return {flat, {top_.get(), robust}};
}

bool EmbreeScene::in_flat_scene(const scene::Scene& scene, std::size_t instance) const {
  const auto& [mesh, node] = scene.instances[instance];
  return placed_[instance].flat && !meshes_[mesh]->empty() &&
         traceable_inverse(scene.nodes[node].world);
}

void EmbreeScene::place_instances(const scene::Scene& scene) {
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    Placed& each = placed_[i];
    if (each.flat || each.hidden || !mesh_scenes_[each.mesh]) continue;
    if (!top_) top_ = new_embree_scene(device_, {layout_.build.robust, RTC_BUILD_QUALITY_MEDIUM});
    each.instance.reset(rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE));
    rtcSetGeometryInstancedScene(each.instance.get(), mesh_scenes_[each.mesh]->handle());
    rtcAttachGeometryByID(top_.get(), each.instance.get(), static_cast<unsigned>(i));
    place(i, scene.nodes[scene.instances[i].node].world);
  }
  check_embree(device_, "create instances");
  commit();
}

void EmbreeScene::place(std::size_t instance, const glm::mat4& world) {
  const Placed& placed = placed_[instance];
  if (placed.flat) {
    throw std::invalid_argument("instance " + std::to_string(instance) +
                                " is below no node that a clip animates");
  }
  const RTCGeometry geometry = placed.instance.get();
  if (!geometry) return;
  if (traceable_inverse(world)) {
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, &world);
    rtcEnableGeometry(geometry);
  } else {
    rtcDisableGeometry(geometry);
  }
  rtcCommitGeometry(geometry);
}

void EmbreeScene::refit(std::span<const Movement::Mesh> deformed) {
  tbb::parallel_for(std::size_t(0), deformed.size(), [&](std::size_t i) {
    if (const auto& scene = mesh_scenes_[deformed[i].mesh]) scene->refit(deformed[i].vertices);
  });
  std::vector<bool> changed(meshes_.size());
  for (const Movement::Mesh& mesh : deformed) changed[mesh.mesh] = true;
  for (const Placed& each : placed_) {
    if (changed[each.mesh] && each.instance) rtcCommitGeometry(each.instance.get());
  }
}

void EmbreeScene::commit() {
  if (!top_) return;
  rtcCommitScene(top_.get());
  check_embree(device_, "build the scene of instances");
}

}  // namespace heliograph::tracing
