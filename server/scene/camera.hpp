#pragma once

#include <glm/glm.hpp>

#include "scene/scene.hpp"

namespace heliograph::scene {

/// World -> view space: right-handed, the camera looks along -Z. Defined for every camera: where
/// `up` is parallel to the view, or eye and target coincide, another axis steps in.
glm::mat4 view_matrix(const Camera& camera);

/// View -> Vulkan clip space: y down, depth reversed (near 1, far 0). Perspective depth is
/// near / distance without a far plane; orthographic depth is linear. `aspect` is width / height.
glm::mat4 projection_matrix(const Camera& camera, float aspect);

/// Whether both show the same, whatever their names.
bool same_view(const Camera& a, const Camera& b);

/// A camera that sees all of `bounds` from in front, a little from the right and from above.
/// `vertical_fov` in degrees.
Camera fit_camera(const Bounds& bounds, float vertical_fov, float aspect);

}  // namespace heliograph::scene
