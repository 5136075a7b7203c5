#pragma once

#include <filesystem>
#include <memory>
#include <set>

#include "cli/options.hpp"
#include "cli/output_name.hpp"
#include "protocol/messages/kinds.hpp"
#include "protocol/settings/settings.hpp"
#include "render/api/engine.hpp"
#include "scene/environment.hpp"

namespace heliograph::cli {

/// What the scenes of one command share. The device is set up for the first scene that can be
/// rendered.
struct RenderJob {
  const RenderOptions& options;
  const OutputName output;
  const protocol::ImageFormat format;
  const protocol::Settings settings;
  const std::shared_ptr<const scene::Environment> environment;  // null: each scene's own
  std::unique_ptr<render::Engine> engine = nullptr;
  std::set<std::filesystem::path> written = {};
};

/// Renders a scene's images into their files. What the scene does not have, and files that cannot
/// be written, are told before anything is rendered.
/// @throws std::exception
void render_scene(RenderJob& job, const std::filesystem::path& file);

}  // namespace heliograph::cli
