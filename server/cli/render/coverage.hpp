#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "cli/render/render_edits.hpp"
#include "cli/render/render_plan.hpp"
#include "cli/render/render_task.hpp"
#include "render/api/engine.hpp"
#include "render/api/renderer.hpp"

namespace heliograph::cli {

/// Measures how much of each pixel surfaces cover. It renders beside the images, whose histories go
/// on.
class CoverageRenderer {
 public:
  /// `edits`: changes of the scene; outlives this.
  CoverageRenderer(render::Engine& engine, std::shared_ptr<const render::SceneResources> scene,
                   const RenderTask& task, const RenderEdits& edits);

  /// 0 to 1 for each pixel of the shot. @throws std::runtime_error, RenderCanceled
  std::vector<float> measure(const Shot& shot, const std::function<bool()>& canceled);

 private:
  std::vector<float> radiance(const protocol::Settings& settings,
                              const std::function<bool()>& canceled);

  const RenderEdits& edits_;
  render::Renderer renderer_;
  session::ShownParts shown_;
  const std::string clip_;
  protocol::Settings over_white_, over_black_;
};

}  // namespace heliograph::cli
