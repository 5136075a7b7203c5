#pragma once

#include <glm/glm.hpp>
#include <string>

#include "protocol/messages/measurement_messages.hpp"

namespace heliograph::session {

/// With four significant digits, without exponent: "1.25 m".
std::string length_text(double metres, protocol::LengthUnit unit);
/// The sides of a box: "1.25 × 0.5 × 2 m".
std::string size_text(const glm::vec3& metres, protocol::LengthUnit unit);
/// "45.3°"
std::string angle_text(double degrees);

}  // namespace heliograph::session
