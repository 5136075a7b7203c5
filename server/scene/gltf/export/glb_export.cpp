#include "scene/gltf/export/glb_export.hpp"

#include <algorithm>
#include <limits>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>
#include <utility>

#include "scene/gltf/document/accessors.hpp"
#include "scene/gltf/document/gltf_file.hpp"
#include "scene/gltf/export/editable_document.hpp"
#include "scene/gltf/export/embedded_files.hpp"
#include "scene/gltf/export/glb_writer.hpp"
#include "scene/gltf/export/light_export.hpp"
#include "scene/gltf/export/material_export.hpp"
#include "scene/gltf/export/node_export.hpp"
#include "scene/gltf/export/texture_export.hpp"
#include "scene/gltf/nodes/nodes.hpp"
#include "scene/warnings.hpp"

namespace heliograph::scene {
namespace {

// Of the header of a .glb and of its chunks, and what aligns these.
constexpr std::uint64_t container_bytes = 64;

/// Files that were read for the scene and for its export.
void check_unchanged(std::vector<SourceFile> before, std::vector<SourceFile> now) {
  for (std::vector<SourceFile>* const files : {&before, &now}) {
    std::ranges::sort(*files, {}, &SourceFile::path);
    const auto repeated = std::ranges::unique(*files);
    files->erase(repeated.begin(), repeated.end());
  }
  if (before != now) {
    throw ImportError("the scene's files have changed since it was loaded: load it again");
  }
}

/// By node of the scene: its index in the document.
std::vector<std::optional<std::uint32_t>> find_document_nodes(GltfFile& file, const Scene& scene,
                                                              std::optional<std::uint32_t> shown,
                                                              const ImportLimits& limits,
                                                              const std::stop_token& stop) {
  Warnings known;  // since the scene was loaded
  const std::vector<Accessor> accessors = read_accessors(file, limits, stop);
  const NodeTable table = read_nodes(file.model(), accessors, shown, limits, known, stop);
  std::vector<std::optional<std::uint32_t>> nodes(scene.nodes.size());
  for (std::uint32_t i = 0; i < table.of_document.size(); ++i) {
    if (table.of_document[i]) nodes.at(*table.of_document[i]) = i;
  }
  return nodes;
}

std::vector<std::string> write_changed(const Scene& scene, const SceneChanges& changes,
                                       const ImportLimits& limits, std::ostream& out,
                                       const std::stop_token& stop) {
  if (scene.sources.empty() || scene.sources.front().path.empty()) {
    throw ImportError("the scene has no file");
  }
  if (examine_file(scene.sources.front().path) != scene.sources.front()) {
    check_unchanged(scene.sources, {});
  }
  Warnings known;
  Warnings warnings;
  GltfFile file(scene.sources.front().path, limits, known, stop, GltfFile::Document::kept);
  std::optional<std::uint32_t> shown;
  if (!scene.scenes.empty()) shown = scene.shown_scene;
  const auto nodes = find_document_nodes(file, scene, shown, limits, stop);
  EditableDocument document(file.take_document(), shown, warnings);
  export_variant(document, scene);
  const TextureExport textures = export_textures(document, scene, limits, stop);
  export_materials(document, scene, changes);
  export_lights(document, scene, nodes, changes.lights);
  export_hidden(document, scene, nodes, changes.hidden);
  const std::vector<std::uint8_t> binary = embed_files(file, document, textures.images, limits);
  std::vector<SourceFile> read = file.sources();
  read.insert(read.end(), textures.files.begin(), textures.files.end());
  check_unchanged(scene.sources, std::move(read));
  throw_if_cancelled(stop);
  const std::string text = document.take().dump();
  const std::uint64_t most =
      std::min<std::uint64_t>(limits.file_bytes, std::numeric_limits<std::uint32_t>::max());
  if (text.size() + binary.size() + container_bytes > most) {
    throw ImportError("the file would have more than the " + std::to_string(most) +
                      " bytes of the limit on files");
  }
  write_glb(out, text, binary);
  return warnings.take();
}

}  // namespace

std::vector<std::string> export_glb(const Scene& scene, const SceneChanges& changes,
                                    const ImportLimits& limits, std::ostream& out,
                                    const std::stop_token& stop) {
  try {
    return write_changed(scene, changes, limits, out, stop);
  } catch (const std::bad_alloc&) {
    throw ImportError("not enough memory for the file");
  }
}

}  // namespace heliograph::scene
