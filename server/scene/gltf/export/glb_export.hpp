#pragma once

#include <iosfwd>
#include <stop_token>
#include <string>
#include <vector>

#include "scene/gltf/export/scene_changes.hpp"
#include "scene/import_error.hpp"
#include "scene/import_limits.hpp"

namespace heliograph::scene {

/// Writes the file of a scene, with changes, as one .glb that refers to no other file. The source
/// is read again, within the same limits and the same folder; images are not decoded, and
/// everything that the changes do not concern stays as it is. The scene and variant that `scene`
/// shows become those that the file begins with.
/// Whether all was written is for the caller to ask `out`.
/// @return what glTF cannot say, one line each
/// @throws ImportError where the source cannot be read, has changed since it was loaded or exceeds
/// a limit; LoadCancelled
std::vector<std::string> export_glb(const Scene& scene, const SceneChanges& changes,
                                    const ImportLimits& limits, std::ostream& out,
                                    const std::stop_token& stop = {});

}  // namespace heliograph::scene
