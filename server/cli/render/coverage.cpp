#include "cli/render/coverage.hpp"

#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <utility>

#include "cli/render/render_scene.hpp"
#include "protocol/settings/settings_json.hpp"
#include "session/rendering/transparency.hpp"

namespace heliograph::cli {
namespace {

template <class Value>
void accept_coverage(const protocol::Result<Value>& result) {
  if (!result) throw std::runtime_error("--background: " + result.error().message);
}

protocol::Settings with_coverage(protocol::Settings settings,
                                 session::CoverageBackground background) {
  accept_coverage(protocol::apply_patch(settings, session::coverage_settings(background)));
  return settings;
}

}  // namespace

CoverageRenderer::CoverageRenderer(render::Engine& engine,
                                   std::shared_ptr<const render::SceneResources> scene,
                                   const RenderTask& task, const RenderEdits& edits)
    : edits_(edits),
      renderer_(engine),
      clip_(task.request.clip),
      over_white_(with_coverage(task.settings, session::CoverageBackground::white)),
      over_black_(with_coverage(task.settings, session::CoverageBackground::black)) {
  const FrameSize size = frame_size(task.request);
  renderer_.set_scene(std::move(scene));
  renderer_.set_size(size.width, size.height);
  renderer_.keep_buffers(false);
  edits_.apply(renderer_);
}

std::vector<float> CoverageRenderer::measure(const Shot& shot,
                                             const std::function<bool()>& canceled) {
  edits_.show(renderer_, shown_, clip_, shot.seconds);
  accept_coverage(renderer_.set_pose(clip_, shot.seconds));
  renderer_.set_camera(shot.camera);
  const std::vector<float> white = radiance(over_white_, canceled);
  return session::coverage_of(white, radiance(over_black_, canceled));
}

std::vector<float> CoverageRenderer::radiance(const protocol::Settings& settings,
                                              const std::function<bool()>& canceled) {
  accept_coverage(renderer_.set_settings(settings));
  renderer_.reset();
  while (true) {
    const std::optional<render::Frame> frame = renderer_.render(canceled);
    if (!frame || canceled()) throw RenderCanceled();
    if (frame->converged || frame->samples >= session::coverage_samples) break;
  }
  auto radiance = renderer_.capture("output.radiance");
  if (!radiance) throw std::runtime_error("--background: " + radiance.error().message);
  return std::move(radiance->rgba);
}

}  // namespace heliograph::cli
