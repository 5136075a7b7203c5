#include "session/edits/section_planes.hpp"

#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>
#include <utility>

#include "session/library/scene_description.hpp"

namespace heliograph::session {
namespace {

constexpr float unit_tolerance = 1e-6f;

std::shared_ptr<const render::Section> enabled_planes(const protocol::Section& section) {
  render::Section made;
  made.cap_color = from_protocol(section.cap_color);
  for (const protocol::SectionPlane& plane : section.planes) {
    if (plane.enabled) made.planes.emplace_back(from_protocol(plane.normal), plane.offset);
  }
  if (made.planes.empty()) return nullptr;
  return std::make_shared<const render::Section>(std::move(made));
}

}  // namespace

protocol::Result<void> SectionPlanes::set(protocol::Section section, const std::string& path) {
  for (std::size_t i = 0; i < section.planes.size(); ++i) {
    const glm::vec3 normal = from_protocol(section.planes[i].normal);
    const float length = glm::length(normal);
    // Planes that are read and set again stay as they are.
    if (std::abs(length - 1.0f) < unit_tolerance) continue;
    if (length == 0.0f) {
      return protocol::error::invalid(path + "planes[" + std::to_string(i) + "].normal",
                                      "must not be zero");
    }
    section.planes[i].normal = to_protocol(normal / length);
  }
  if (section == section_) return {};
  section_ = std::move(section);
  enabled_ = enabled_planes(section_);
  return {};
}

}  // namespace heliograph::session
