#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scene/gltf/export/scene_changes.hpp"
#include "session/edits/scene_edits.hpp"
#include "session/edits/section_planes.hpp"
#include "session/nodes/node_state.hpp"

namespace heliograph::session {

/// A scene and what was edited, as a new file takes it.
struct SceneExport {
  std::shared_ptr<const scene::Scene> scene;
  scene::SceneChanges changes;
  std::vector<std::string> warnings;  // what no file holds
};

/// `other_environment`: another one than the scene's own was chosen, or it was turned or scaled.
SceneExport make_export(std::shared_ptr<const scene::Scene> scene, const SceneEdits& edits,
                        const NodeState& nodes, const SectionPlanes& section,
                        bool other_environment);

}  // namespace heliograph::session
