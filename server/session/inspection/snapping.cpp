#include "session/inspection/snapping.hpp"

#include "scene/surface/surface_snap.hpp"
#include "session/inspection/anchors.hpp"
#include "session/library/scene_description.hpp"

namespace heliograph::session {

protocol::SnapResult snap(const RenderState& state, const render::SurfacePoint& picked,
                          const protocol::SceneSnap& request) {
  const scene::Scene& scene = *state.scene;
  const FrameView view(state);
  const glm::vec3 direction = view.direction_to(picked.position);
  const auto positions = scene::world_positions(scene, view.pose(), picked.instance);
  const auto snapped =
      scene::snap_to_mesh(positions, scene.meshes[scene.instances[picked.instance].mesh].indices,
                          {.origin = picked.position - picked.distance * direction,
                           .direction = direction,
                           .distance = picked.distance,
                           .radius = request.radius * view.height_at(picked.position),
                           .vertices = request.vertices,
                           .edges = request.edges});
  if (!snapped) return {};
  const scene::SurfaceAnchor anchor{.instance = picked.instance,
                                    .triangle = snapped->triangle,
                                    .barycentrics = snapped->barycentrics};
  glm::vec3 normal = scene::locate(scene, view.pose(), anchor).normal;
  if (glm::dot(normal, direction) > 0.0f) normal = -normal;
  return {.hit = true,
          .position = to_protocol(snapped->position),
          .normal = to_protocol(normal),
          .feature = snapped->feature,
          .surface = to_protocol(scene, anchor)};
}

protocol::Result<protocol::HiddenAnnotations> hidden_annotations(
    const render::Renderer& renderer, const FrameView& view,
    const protocol::AnnotationList& annotations) {
  constexpr float tolerance = 0.005f;  // of the distance
  protocol::HiddenAnnotations result;
  for (const protocol::Annotation& annotation : annotations.annotations) {
    const glm::vec3 position = from_protocol(annotation.position);
    const auto place = view.image_point(position);
    if (!place) continue;
    const auto surface = renderer.pick(*place);
    if (!surface) return surface.error();
    if (*surface && (*surface)->distance < (1.0f - tolerance) * view.distance_to(position)) {
      result.hidden.push_back(annotation.id);
    }
  }
  return result;
}

}  // namespace heliograph::session
