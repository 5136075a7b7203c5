#pragma once

#include "protocol/messages/annotation_messages.hpp"
#include "protocol/result.hpp"
#include "render/api/renderer.hpp"
#include "session/inspection/frame_view.hpp"
#include "session/state/render_state.hpp"

// What of the scene's data the newest frame shows where. For the render thread.

namespace heliograph::session {

/// The point of the mesh, where the picked one is only as exact as the frame's buffers, or a vertex
/// or edge near it. `picked` lies on an instance of the state's scene. Takes time in proportion to
/// the triangles of its mesh.
protocol::SnapResult snap(const RenderState& state, const render::SurfacePoint& picked,
                          const protocol::SceneSnap& request);

/// Those of the scene's annotations that the frame, which `view` is of, shows behind a surface.
protocol::Result<protocol::HiddenAnnotations> hidden_annotations(
    const render::Renderer& renderer, const FrameView& view,
    const protocol::AnnotationList& annotations);

}  // namespace heliograph::session
