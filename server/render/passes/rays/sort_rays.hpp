#pragma once

#include <string>

#include "render/passes/frame_inputs.hpp"

namespace heliograph::render {

/// The same rays in another order: by direction, then by where in the scene they begin, so that
/// neighbours in the stream visit the same part of it. Rays of the same key come in any order.
tracing::RayStream sort_rays(gpu::FramePlan& plan, const FrameInputs& in, const std::string& name,
                             const tracing::RayStream& rays);

}  // namespace heliograph::render
