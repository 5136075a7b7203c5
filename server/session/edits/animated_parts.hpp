#pragma once

#include <memory>
#include <vector>

#include "session/edits/animated_members.hpp"
#include "session/edits/scene_edits.hpp"

namespace heliograph::render {
class Renderer;
}

namespace heliograph::session {

/// The parts of a scene that a session has edited, and at which time of which clip they are shown.
struct PartsMoment {
  std::shared_ptr<const scene::Scene> scene;  // null: none
  SceneParts edited;
  EditedMembers members;              // of `edited`
  const scene::Clip* clip = nullptr;  // of the scene; null: as in the file
  double seconds = 0.0;
};

/// Parts of a scene with what its clips animate by pointers (KHR_animation_pointer). Edits win.
class AnimatedParts {
 public:
  /// The same lists as before as long as nothing in them differs; `edited` itself where no clip of
  /// the scene animates such a part.
  SceneParts at(const PartsMoment& moment);

 private:
  /// What a list was made from.
  struct Origin {
    std::shared_ptr<const scene::Scene> scene;
    const scene::Clip* clip = nullptr;
    std::shared_ptr<const void> edited;
    std::vector<TrackValue> values;
    std::vector<bool> shown;  // by light or node of the scene; empty: all
    bool operator==(const Origin&) const = default;
  };
  void update_lights(const PartsMoment& moment, const std::vector<bool>& shown);
  void update_materials(const PartsMoment& moment);
  void update_hidden(const PartsMoment& moment, const std::vector<bool>& shown);

  Origin of_lights_, of_materials_, of_hidden_;
  SceneParts parts_;
};

/// What a renderer shows of a scene's parts.
class ShownParts {
 public:
  /// Passes on what differs. The renderer has the scene; another one, or the same once more, shows
  /// no edits after reset() until then.
  /// @return whether other instances are hidden
  bool show(render::Renderer& renderer, const PartsMoment& moment);
  void reset();

 private:
  AnimatedParts animated_;
  SceneParts edited_;  // of which `shown_` was made
  SceneParts shown_;
};

}  // namespace heliograph::session
