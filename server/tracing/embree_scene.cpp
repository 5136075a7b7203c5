#include "tracing/embree_scene.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "tracing/bvh.hpp"

namespace heliograph::tracing {
namespace {

EmbreeHandle<RTCScene> new_scene(RTCDevice device) {
  EmbreeHandle<RTCScene> scene(rtcNewScene(device));
  check_embree(device, "start a scene");
  rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_MEDIUM);
  return scene;
}

// Embree's own buffers: they are padded as its vector loads need and live as long as the geometry.
EmbreeHandle<RTCGeometry> new_triangles(RTCDevice device, const scene::Mesh& mesh) {
  EmbreeHandle<RTCGeometry> geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  auto* positions = static_cast<glm::vec3*>(
      rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                              sizeof(glm::vec3), mesh.vertices.size()));
  auto* indices = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(std::uint32_t), mesh.indices.size() / 3));
  check_embree(device, "make room for a mesh");
  std::transform(mesh.vertices.begin(), mesh.vertices.end(), positions,
                 [](const shared::Vertex& vertex) { return vertex.position; });
  std::copy(mesh.indices.begin(), mesh.indices.end(), indices);
  return geometry;
}

}  // namespace

EmbreeScene::EmbreeScene(RTCDevice device, const scene::Scene& scene,
                         std::span<const std::uint8_t> alpha_heap)
    : masks_(scene.meshes.size()), meshes_(scene.meshes.size()), top_(new_scene(device)) {
  tbb::parallel_for(std::size_t(0), scene.meshes.size(),
                    [&](std::size_t i) { add_mesh(device, scene, i, alpha_heap); });
  for (std::size_t i = 0; i < scene.instances.size(); ++i) place(device, scene, i);
  rtcCommitScene(top_.get());
  check_embree(device, "build the scene of instances");
}

void EmbreeScene::add_mesh(RTCDevice device, const scene::Scene& scene, std::size_t index,
                           std::span<const std::uint8_t> alpha_heap) {
  const scene::Mesh& mesh = scene.meshes[index];
  const shared::Material& material = scene.materials[mesh.material];
  const Coverage seen = coverage(material);
  if (seen == Coverage::none || mesh.indices.size() < 3) return;
  const EmbreeHandle<RTCGeometry> geometry = new_triangles(device, mesh);
  if (seen == Coverage::masked) {
    masks_[index] = std::make_unique<Mask>(Mask{make_alpha_mask(mesh, material), alpha_heap});
    rtcSetGeometryUserData(geometry.get(), const_cast<Mask*>(masks_[index].get()));
    rtcSetGeometryIntersectFilterFunction(geometry.get(), let_through);
    rtcSetGeometryOccludedFilterFunction(geometry.get(), let_through);
  }
  rtcCommitGeometry(geometry.get());
  meshes_[index] = new_scene(device);
  rtcAttachGeometry(meshes_[index].get(), geometry.get());
  rtcCommitScene(meshes_[index].get());
  check_embree(device, "build a mesh");
}

void EmbreeScene::place(RTCDevice device, const scene::Scene& scene, std::size_t instance) {
  const auto& [mesh, node] = scene.instances[instance];
  const glm::mat4& world = scene.nodes[node].world;
  if (!meshes_[mesh] || !traceable_inverse(world)) return;
  const EmbreeHandle<RTCGeometry> geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE));
  rtcSetGeometryInstancedScene(geometry.get(), meshes_[mesh].get());
  rtcSetGeometryTransform(geometry.get(), 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, &world);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometryByID(top_.get(), geometry.get(), static_cast<unsigned>(instance));
  check_embree(device, "place a mesh");
}

void EmbreeScene::let_through(const RTCFilterFunctionNArguments* arguments) {
  const auto& [mask, heap] = *static_cast<const Mask*>(arguments->geometryUserPtr);
  const unsigned lanes = arguments->N;
  for (unsigned i = 0; i < lanes; ++i) {
    if (arguments->valid[i] == 0) continue;
    const bool stops =
        mask.stops_ray(heap, RTCHitN_primID(arguments->hit, lanes, i),
                       RTCHitN_u(arguments->hit, lanes, i), RTCHitN_v(arguments->hit, lanes, i));
    if (!stops) arguments->valid[i] = 0;
  }
}

}  // namespace heliograph::tracing
