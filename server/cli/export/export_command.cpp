#include <filesystem>
#include <memory>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "cli/log.hpp"
#include "cli/render/output/output_file.hpp"
#include "cli/render/render_edits.hpp"
#include "scene/gltf/export/glb_export.hpp"
#include "scene/import.hpp"
#include "session/edits/scene_export.hpp"
#include "session/event_log.hpp"

namespace heliograph::cli {
namespace {

namespace fs = std::filesystem;

bool chooses_environment(const protocol::EditDocument& document) {
  const auto& environment = document.environment;
  return environment && *environment != protocol::EnvironmentEdit();
}

/// @throws std::runtime_error where the document does not fit the scene
session::SceneExport edited(const std::shared_ptr<const scene::Scene>& scene,
                            const protocol::EditDocument& document) {
  session::SceneEdits edits(scene);
  session::NodeState nodes(scene);
  session::SectionPlanes section;
  const auto cut = section.set(document.section.value_or(protocol::Section()), "edits.section.");
  for (const auto& fits :
       {edits.apply(document), session::apply_visibility(document, nodes), cut}) {
    if (!fits) throw std::runtime_error(fits.error().message);
  }
  return session::make_export(scene, edits, nodes, section, chooses_environment(document));
}

/// @return what the file lacks
std::vector<std::string> write_export(const ExportOptions& options,
                                      const protocol::EditDocument& document) {
  scene::ImportOptions choice;
  choice.choice.variant = options.variant;
  choice.textures =
      edited_textures(document, image_folders(options.images, options.edits, options.scene));
  const auto scene = std::make_shared<const scene::Scene>(
      scene::import_gltf(options.scene, options.limits, choice));
  const session::SceneExport exported = edited(scene, document);
  std::vector<std::string> warnings = exported.warnings;
  write_whole(options.output, [&](std::ostream& file) {
    const auto more = scene::export_glb(*scene, exported.changes, options.limits, file);
    warnings.insert(warnings.end(), more.begin(), more.end());
  });
  return warnings;
}

void check_output(const ExportOptions& options) {
  const fs::path output(options.output);
  if (output.extension() != ".glb") {
    throw std::invalid_argument("--output: " + options.output + " must end in .glb");
  }
  std::error_code missing;
  if (fs::equivalent(output, options.scene, missing)) {
    throw std::invalid_argument("--output: " + options.output + " is the scene itself");
  }
  if (!can_write(output)) throw std::runtime_error("--output: cannot write " + options.output);
}

}  // namespace

int run(const ExportOptions& options) {
  set_up_log({.level = "warning"});
  protocol::EditDocument document;
  if (!options.edits.empty()) document = read_edits(options.edits);
  check_output(options);
  try {
    for (const std::string& warning : write_export(options, document)) {
      session::log_warning({}, warning);
    }
  } catch (const scene::ImportError& failure) {
    throw std::runtime_error(options.scene + ": " + failure.what());
  }
  return 0;
}

}  // namespace heliograph::cli
