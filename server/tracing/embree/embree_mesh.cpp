#include "tracing/embree/embree_mesh.hpp"

#include <algorithm>
#include <utility>

namespace heliograph::tracing {

EmbreeHandle<RTCScene> new_embree_scene(RTCDevice device, const EmbreeBuild& build,
                                        RTCSceneFlags flags) {
  EmbreeHandle<RTCScene> scene(rtcNewScene(device));
  check_embree(device, "create a scene");
  rtcSetSceneBuildQuality(scene.get(), build.quality);
  rtcSetSceneFlags(scene.get(), build.robust ? flags | RTC_SCENE_FLAG_ROBUST : flags);
  return scene;
}

EmbreeMesh::EmbreeMesh(RTCDevice device, const scene::Mesh& mesh, const shared::Material& material,
                       std::span<const std::uint8_t> alpha_heap)
    : vertex_count_(mesh.vertices.size()), triangle_count_(mesh.indices.size() / 3) {
  const Coverage seen = coverage(material);
  if (seen == Coverage::none || triangle_count_ == 0) return;
  const std::size_t bytes = 3 * triangle_count_ * sizeof(std::uint32_t);
  indices_.reset(rtcNewBuffer(device, bytes));
  check_embree(device, "allocate a mesh");
  std::ranges::copy(std::span(mesh.indices).first(3 * triangle_count_),
                    static_cast<std::uint32_t*>(rtcGetBufferData(indices_.get())));
  if (seen == Coverage::masked) {
    mask_ = std::make_unique<Mask>(Mask{make_alpha_mask(mesh, material), alpha_heap});
  }
}

EmbreeGeometry EmbreeMesh::make_geometry(RTCDevice device) const {
  EmbreeGeometry made;
  made.handle.reset(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  const RTCGeometry geometry = made.handle.get();
  // Owned by Embree: padded for its vector loads.
  auto* const positions = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), vertex_count_));
  rtcSetGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, indices_.get(), 0,
                       3 * sizeof(std::uint32_t), triangle_count_);
  check_embree(device, "allocate a geometry");
  made.positions = {positions, vertex_count_};
  if (mask_) {
    rtcSetGeometryUserData(geometry, const_cast<Mask*>(mask_.get()));
    rtcSetGeometryIntersectFilterFunction(geometry, let_through);
    rtcSetGeometryOccludedFilterFunction(geometry, let_through);
  }
  return made;
}

void EmbreeMesh::let_through(const RTCFilterFunctionNArguments* arguments) {
  const auto& [mask, heap] = *static_cast<const Mask*>(arguments->geometryUserPtr);
  const unsigned lanes = arguments->N;
  for (unsigned i = 0; i < lanes; ++i) {
    if (arguments->valid[i] == 0) continue;
    const unsigned placed = RTCHitN_instID(arguments->hit, lanes, i, 0);
    const unsigned instance =
        placed == RTC_INVALID_GEOMETRY_ID ? RTCHitN_geomID(arguments->hit, lanes, i) : placed;
    const bool stops =
        mask.stops_ray(heap, RTCRayN_id(arguments->ray, lanes, i), instance,
                       RTCHitN_primID(arguments->hit, lanes, i),
                       RTCHitN_u(arguments->hit, lanes, i), RTCHitN_v(arguments->hit, lanes, i));
    if (!stops) arguments->valid[i] = 0;
  }
}

EmbreeMeshScene::EmbreeMeshScene(RTCDevice device, std::shared_ptr<const EmbreeMesh> source,
                                 const scene::Mesh& mesh, Use use, const EmbreeBuild& build,
                                 const std::stop_token& stop)
    : source_(std::move(source)), geometry_(source_->make_geometry(device)) {
  std::ranges::transform(mesh.vertices, geometry_.positions.begin(), &shared::Vertex::position);
  // Refitting requires a scene of low build quality; others rebuild on every commit. The refitted
  // tree itself has medium quality.
  const bool deforms = use == Use::deforming;
  scene_ = deforms ? new_embree_scene(device, {build.robust, RTC_BUILD_QUALITY_LOW},
                                      RTC_SCENE_FLAG_DYNAMIC)
                   : new_embree_scene(device, build);
  const RTCGeometry geometry = geometry_.handle.get();
  if (deforms) rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_REFIT);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_.get(), geometry);
  commit_scene(device, scene_.get(), "build a mesh", stop);
}

void EmbreeMeshScene::refit(std::span<const shared::Vertex> vertices) {
  std::ranges::transform(vertices, geometry_.positions.begin(), &shared::Vertex::position);
  rtcUpdateGeometryBuffer(geometry_.handle.get(), RTC_BUFFER_TYPE_VERTEX, 0);
  rtcCommitGeometry(geometry_.handle.get());
  rtcCommitScene(scene_.get());
}

}  // namespace heliograph::tracing
