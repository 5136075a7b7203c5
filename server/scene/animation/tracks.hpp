#pragma once

#include <array>
#include <vector>

#include "scene/scene.hpp"

// What clips animate by pointers (KHR_animation_pointer), beside transforms and weights of nodes.

namespace heliograph::scene {

/// Whether a clip of the scene has tracks.
bool has_tracks(const Scene& scene);

/// `track.width` numbers, within the range of its property; `moment`: of the clip, moment_of().
std::array<float, 4> value_of(const Track& track, float moment);

/// By node, whether it is visible in `clip`, or as in the file, at `seconds`, with all above it.
/// Empty where all are.
std::vector<bool> shown_nodes(const Scene& scene, const Clip* clip, double seconds);

/// Whether the clip shows and hides nodes.
bool switches_nodes(const Clip& clip);

/// Whether the clip changes the lens of a camera of the scene.
bool changes_lens(const Clip& clip, const Camera& camera);
/// Such a camera with the lens that it has in the clip at `seconds`.
Camera with_lens(Camera camera, const Clip& clip, double seconds);

}  // namespace heliograph::scene
