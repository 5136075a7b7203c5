#pragma once

#include "protocol/messages/annotation_messages.hpp"
#include "protocol/messages/measurement_messages.hpp"
#include "render/api/renderer.hpp"
#include "session/inspection/frame_view.hpp"
#include "stream/drawing/mark_drawing.hpp"

namespace heliograph::session {

/// What is measured, as lines, points and labels where a frame shows it. The page draws the same.
void add_measurements(stream::ImageMarks& marks, const FrameView& view,
                      const protocol::MeasurementList& measurements);

/// Measurements and annotations where the newest frame, which `view` is of, shows them. For the
/// render thread: it asks which annotations are hidden.
protocol::Result<stream::ImageMarks> frame_marks(const render::Renderer& renderer,
                                                 const FrameView& view,
                                                 const protocol::MeasurementList& measurements,
                                                 const protocol::AnnotationList& annotations);

}  // namespace heliograph::session
