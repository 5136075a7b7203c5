#pragma once

#include <glm/glm.hpp>

#include "scene/scene.hpp"

namespace heliograph::scene {

/// World -> view space: right-handed, the camera looks along -Z. Degenerate cameras (`up` parallel
/// to the view direction, or eye equal to target) use another axis.
glm::mat4 view_matrix(const Camera& camera);

/// View -> Vulkan clip space: y down, depth reversed (near 1, far 0). Perspective depth is
/// near / distance without a far plane; orthographic depth is linear. `aspect` is width / height.
glm::mat4 projection_matrix(const Camera& camera, float aspect);

/// Whether both cameras show the same view; names are ignored.
bool same_view(const Camera& a, const Camera& b);

/// A camera that sees all of `bounds` from the front, slightly from the right and from above.
/// `vertical_fov` in degrees.
Camera fit_camera(const Bounds& bounds, float vertical_fov, float aspect);

}  // namespace heliograph::scene
