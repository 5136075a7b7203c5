#include "tracing/embree/embree_scene.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "tracing/bvh/bvh.hpp"

namespace heliograph::tracing {
namespace {

/// Robust: watertight between adjacent triangles.
EmbreeHandle<RTCScene> new_scene(RTCDevice device, RTCBuildQuality quality,
                                 RTCSceneFlags flags = RTC_SCENE_FLAG_NONE) {
  EmbreeHandle<RTCScene> scene(rtcNewScene(device));
  check_embree(device, "create a scene");
  rtcSetSceneBuildQuality(scene.get(), quality);
  rtcSetSceneFlags(scene.get(), flags | RTC_SCENE_FLAG_ROBUST);
  return scene;
}

}  // namespace

EmbreeMesh::EmbreeMesh(RTCDevice device, const scene::Mesh& mesh, const shared::Material& material,
                       std::span<const std::uint8_t> alpha_heap, Use use) {
  const Coverage seen = coverage(material);
  if (seen == Coverage::none || mesh.indices.size() < 3) return;
  geometry_.reset(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  // Buffers owned by Embree: padded for its vector loads, with the lifetime of the geometry.
  positions_ = static_cast<glm::vec3*>(
      rtcSetNewGeometryBuffer(geometry_.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                              sizeof(glm::vec3), mesh.vertices.size()));
  auto* indices = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry_.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(std::uint32_t), mesh.indices.size() / 3));
  check_embree(device, "allocate a mesh");
  std::ranges::transform(mesh.vertices, positions_, &shared::Vertex::position);
  std::ranges::copy(mesh.indices, indices);
  if (seen == Coverage::masked) {
    mask_ = std::make_unique<Mask>(Mask{make_alpha_mask(mesh, material), alpha_heap});
    rtcSetGeometryUserData(geometry_.get(), const_cast<Mask*>(mask_.get()));
    rtcSetGeometryIntersectFilterFunction(geometry_.get(), let_through);
    rtcSetGeometryOccludedFilterFunction(geometry_.get(), let_through);
  }
  // Refitting requires a scene of low build quality; others rebuild on every commit. The refitted
  // tree itself has medium quality.
  const bool deforms = use == Use::deforming;
  scene_ = new_scene(device, deforms ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM,
                     deforms ? RTC_SCENE_FLAG_DYNAMIC : RTC_SCENE_FLAG_NONE);
  if (deforms) rtcSetGeometryBuildQuality(geometry_.get(), RTC_BUILD_QUALITY_REFIT);
  rtcCommitGeometry(geometry_.get());
  rtcAttachGeometry(scene_.get(), geometry_.get());
  rtcCommitScene(scene_.get());
  check_embree(device, "build a mesh");
}

void EmbreeMesh::refit(std::span<const shared::Vertex> vertices) {
  if (!scene_) return;
  std::ranges::transform(vertices, positions_, &shared::Vertex::position);
  rtcUpdateGeometryBuffer(geometry_.get(), RTC_BUFFER_TYPE_VERTEX, 0);
  rtcCommitGeometry(geometry_.get());
  rtcCommitScene(scene_.get());
}

std::vector<std::shared_ptr<EmbreeMesh>> make_embree_meshes(
    RTCDevice device, const scene::Scene& scene, std::span<const std::uint8_t> alpha_heap) {
  std::vector<std::shared_ptr<EmbreeMesh>> meshes(scene.meshes.size());
  tbb::parallel_for(std::size_t(0), meshes.size(), [&](std::size_t i) {
    const scene::Mesh& mesh = scene.meshes[i];
    meshes[i] = std::make_shared<EmbreeMesh>(device, mesh, scene.materials[mesh.material],
                                             alpha_heap, EmbreeMesh::Use::rigid);
  });
  return meshes;
}

EmbreeScene::EmbreeScene(RTCDevice device, const scene::Scene& scene,
                         std::vector<std::shared_ptr<EmbreeMesh>> meshes)
    : device_(device),
      meshes_(std::move(meshes)),
      top_(new_scene(device, RTC_BUILD_QUALITY_MEDIUM)) {
  for (const auto& [mesh, node] : scene.instances) {
    placed_.push_back({mesh, nullptr});
    if (!meshes_[mesh]->handle()) continue;
    const std::size_t index = placed_.size() - 1;
    auto& geometry = placed_.back().geometry;
    geometry.reset(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE));
    rtcSetGeometryInstancedScene(geometry.get(), meshes_[mesh]->handle());
    rtcAttachGeometryByID(top_.get(), geometry.get(), static_cast<unsigned>(index));
    place(index, scene.nodes[node].world);
  }
  check_embree(device, "create instances");
  commit();
}

void EmbreeScene::place(std::size_t instance, const glm::mat4& world) {
  const RTCGeometry geometry = placed_[instance].geometry.get();
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
  tbb::parallel_for(std::size_t(0), deformed.size(),
                    [&](std::size_t i) { meshes_[deformed[i].mesh]->refit(deformed[i].vertices); });
  std::vector<bool> changed(meshes_.size());
  for (const Movement::Mesh& mesh : deformed) changed[mesh.mesh] = true;
  for (const auto& [mesh, geometry] : placed_) {
    if (changed[mesh] && geometry) rtcCommitGeometry(geometry.get());
  }
}

void EmbreeScene::commit() {
  rtcCommitScene(top_.get());
  check_embree(device_, "build the scene of instances");
}

void EmbreeMesh::let_through(const RTCFilterFunctionNArguments* arguments) {
  const auto& [mask, heap] = *static_cast<const Mask*>(arguments->geometryUserPtr);
  const unsigned lanes = arguments->N;
  for (unsigned i = 0; i < lanes; ++i) {
    if (arguments->valid[i] == 0) continue;
    const bool stops = mask.stops_ray(
        heap, RTCRayN_id(arguments->ray, lanes, i), RTCHitN_instID(arguments->hit, lanes, i, 0),
        RTCHitN_primID(arguments->hit, lanes, i), RTCHitN_u(arguments->hit, lanes, i),
        RTCHitN_v(arguments->hit, lanes, i));
    if (!stops) arguments->valid[i] = 0;
  }
}

}  // namespace heliograph::tracing
