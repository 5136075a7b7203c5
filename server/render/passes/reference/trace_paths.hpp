#pragma once

#include "render/passes/frame_inputs.hpp"

namespace heliograph::render {

/// Declares the passes of one sample of full global illumination by host kernels: paths of at most
/// reference.bounces + 1 vertices, all of them one vertex further in each round. Streams hold the
/// rays that there are, where those of the shaders have one for every pixel.
/// @param ground float of every texel of the plane that catches shadows
/// @return radiance of the sample, rgba32f, linear
gpu::ImageRef trace_paths(gpu::FramePlan& plan, const FrameInputs& in, gpu::BufferRef ground);

}  // namespace heliograph::render
