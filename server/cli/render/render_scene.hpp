#pragma once

#include <atomic>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "cli/render/render_report.hpp"
#include "cli/render/render_task.hpp"
#include "render/api/engine.hpp"
#include "scene/environment.hpp"
#include "scene/scene.hpp"

namespace heliograph::cli {

struct Renderers;

/// A scene on the device, kept for the next entry of the same one.
struct SceneInUse {
  std::filesystem::path file;
  std::string environment;
  std::string variant;
  std::vector<scene::TextureOverride> textures;
  std::shared_ptr<const render::SceneResources> resources;
  /// For the next entry that differs from `rendered` in its views alone, in the same `format`.
  std::shared_ptr<Renderers> renderers;
  protocol::RenderRequest rendered;
  protocol::FileFormat format{};
};

/// What the entries of one command share. The device is set up for the first scene that can be
/// rendered.
struct RenderContext {
  const RenderOptions& options;
  RenderReport& report;
  const std::atomic<bool>& canceled;
  std::map<std::string, std::shared_ptr<const scene::Environment>> environments = {};  // by file
  std::unique_ptr<render::Engine> engine = nullptr;
  SceneInUse scene = {};
  std::set<std::filesystem::path> written = {};
};

/// The command was told to end.
struct RenderCanceled {};

/// Images of an entry, if that is known without its scene; otherwise of one camera.
std::size_t expected_images(const RenderTask& task);

/// Renders an entry's images into their files. What the scene does not have, and files that cannot
/// be written, are told before anything is rendered.
/// @throws std::exception, RenderCanceled
void render_task(RenderContext& context, const RenderTask& task);

}  // namespace heliograph::cli
