#include <cmath>
#include <string>

#include "scenes/generator/atrium/atrium.hpp"
#include "scenes/generator/atrium/atrium_parts.hpp"
#include "scenes/generator/atrium/atrium_plan.hpp"
#include "scenes/generator/scenes/clips.hpp"

namespace heliograph::scenes {
namespace {

// Case 1 travels down the nave and back, case 2 along the gallery, case 3 an S through the court.
Pose camera_pose(int case_number, float phase) {
  const float angle = two_pi * phase;
  const float away = there_and_back(phase);
  if (case_number == 1) {
    const glm::vec3 eye(13.6f - 8.5f * away, 1.75f + 0.5f * away, 1.5f + 1.0f * std::sin(angle));
    return look(eye, {eye.x - 17.6f, 3.3f, -0.9f});
  }
  if (case_number == 2) {
    const glm::vec3 eye(15.6f - 1.0f * away, 8.5f + 0.6f * away, 0.5f + 3.0f * std::sin(angle));
    return look(eye, {-2.0f, 4.3f, -1.3f});
  }
  const glm::vec3 eye(-7.4f + 3.0f * std::sin(angle), 2.0f, 3.9f - 0.7f * std::sin(2.0f * angle));
  return look(eye, {2.0f + 2.0f * std::sin(angle), 2.6f, -3.2f});
}

// An object that hangs from `hook`; `base` is its default pose.
Pose swung(const Pose& base, glm::vec3 hook, glm::vec3 axis, float angle) {
  const glm::quat swing = glm::angleAxis(angle, axis);
  return {hook + swing * (base.translation - hook), swing * base.rotation};
}

void animate_object(const Node& node, int index, Animation& animation) {
  const Pose base{node.translation, node.rotation};
  // Neighbours swing out of step.
  const float offset = 0.37f * node.translation.x + 0.61f * node.translation.z;
  if (node.name.starts_with("lantern_")) {
    glm::vec3 hook = node.translation;
    hook.y = plan::lower.springing + plan::lower.arch_radius;
    animate(animation, index, [=](float phase) {
      return swung(base, hook, {1.0f, 0.0f, 0.0f},
                   0.10f * std::sin(two_pi * 3.0f * phase + offset));
    });
  } else if (node.name == "curtain") {
    const glm::vec3 along_rod = node.rotation * glm::vec3(1.0f, 0.0f, 0.0f);
    animate(animation, index, [=](float phase) {
      return swung(base, base.translation, along_rod,
                   0.05f * std::sin(two_pi * 2.0f * phase + offset));
    });
  } else if (node.name.starts_with("banner_") && node.name != "banner_pole") {
    const glm::vec3 along_pole = node.rotation * glm::normalize(glm::vec3(0.0f, 0.30f, 1.45f));
    animate(animation, index, [=](float phase) {
      return swung(base, base.translation, along_pole,
                   0.16f * std::sin(two_pi * 2.0f * phase + offset));
    });
  } else if (node.name == "hero_sphere") {
    animate(animation, index, [=](float phase) {
      const float rise = 0.35f * there_and_back(phase);
      return Pose{base.translation + glm::vec3(0.0f, rise, 0.0f),
                  glm::angleAxis(two_pi * phase, glm::vec3(0.0f, 1.0f, 0.0f))};
    });
  }
}

}  // namespace

void add_clips(Document& document, int case_number) {
  Animation camera{"moving_camera", {}};
  Animation objects{"moving_objects_light", {}};
  for (int i = 0; i < int(document.nodes.size()); ++i) {
    const Node& node = document.nodes[std::size_t(i)];
    if (node.name == "main") {
      animate(camera, i, [&](float phase) { return camera_pose(case_number, phase); });
    }
    animate_object(node, i, objects);
  }
  swing_sun(document, objects, sun_elevation, sun_azimuth, 30.0f);
  document.animations = {std::move(camera), std::move(objects)};
}

}  // namespace heliograph::scenes
