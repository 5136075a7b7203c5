#pragma once

#include <glm/glm.hpp>

namespace heliograph::session {

/// Linear sRGB colour of a black body at `kelvin`, 1667 to 25000, whose largest component is 1.
/// Chromaticity by Kang et al., "Design of Advanced Color Temperature Control System for HDTV
/// Applications", 2002; colours outside sRGB lose their negative components.
glm::vec3 black_body_color(float kelvin);

}  // namespace heliograph::session
