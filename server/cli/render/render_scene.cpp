#include "cli/render/render_scene.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cli/engine_options.hpp"
#include "cli/malloc_thresholds.hpp"
#include "cli/render/coverage.hpp"
#include "cli/render/output/output_file.hpp"
#include "cli/render/quality.hpp"
#include "cli/render/render_edits.hpp"
#include "cli/render/render_plan.hpp"
#include "cli/render/render_timings.hpp"
#include "cli/render/stopped_time.hpp"
#include "protocol/limits.hpp"
#include "render/api/renderer.hpp"
#include "scene/animation/explosion.hpp"
#include "scene/import.hpp"
#include "scene/studio.hpp"
#include "session/library/environment_source.hpp"
#include "session/rendering/capture_content.hpp"
#include "session/rendering/transparency.hpp"

namespace heliograph::cli {

/// What renders the images of an entry.
struct Renderers {
  explicit Renderers(render::Engine& engine) : images(engine) {}

  RenderEdits edits;
  render::Renderer images;
  session::ShownParts shown;                 // by `images`
  std::optional<CoverageRenderer> coverage;  // where the background is put in
};

namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t measured_frames = 16;

template <class Value>
Value accepted(protocol::Result<Value> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return *std::move(result);
}

void accept(const protocol::Result<void>& result) {
  if (!result) throw std::runtime_error(result.error().message);
}

/// The one that the request or its edits name, else that of the file of `imported`, else the one
/// beside it.
std::shared_ptr<const scene::Environment> environment_of(RenderContext& context,
                                                         const RenderTask& task,
                                                         const scene::Scene& imported) {
  const fs::path scene = task.request.scene;
  fs::path file = task.request.environment;
  const auto& edits = task.request.edits;
  const bool edited = file.empty() && edits && edits->environment && edits->environment->name;
  if (edited) {
    file = edited_environment(*edits->environment->name, scene);
  } else if (file.empty()) {
    if (imported.environment) return imported.environment;
    const auto beside = session::environment_beside(scene, scene.parent_path());
    if (beside) file = *beside;
  }
  auto& environment = context.environments[file.string()];
  if (!environment) {
    environment = std::make_shared<const scene::Environment>(
        file.empty() ? scene::studio_environment() : scene::load_environment(file));
  }
  return environment;
}

void set_up_device(RenderContext& context) {
  if (context.engine) return;
  context.engine = make_engine(context.options.device);
  set_malloc_thresholds(*context.engine);
  if (const std::string error = context.engine->shader_error(); !error.empty()) {
    throw std::runtime_error(error);
  }
}

/// The environment that the request names itself, or its edits.
std::string named_environment(const protocol::RenderRequest& request) {
  if (!request.environment.empty() || !request.edits || !request.edits->environment) {
    return request.environment;
  }
  const auto& name = request.edits->environment->name;
  return name ? "environment of the edits: " + *name : "";
}

std::vector<scene::TextureOverride> textures_of(const RenderContext& context,
                                                const protocol::RenderRequest& request) {
  if (!request.edits) return {};
  const RenderOptions& options = context.options;
  return edited_textures(*request.edits,
                         image_folders(options.images, options.edits, request.scene));
}

bool shows(const SceneInUse& scene, const protocol::RenderRequest& request,
           const std::vector<scene::TextureOverride>& textures) {
  return scene.resources && scene.file == request.scene &&
         scene.environment == named_environment(request) && scene.variant == request.variant &&
         scene.textures == textures;
}

/// A file and its images: one, or all of a camera.
struct PlannedFile {
  fs::path path;  // empty: standard output
  std::vector<Shot> shots;
};

/// Whether the next image begins another file.
bool begins_file(const RenderTask& task, const std::vector<PlannedFile>& files, const Shot& shot) {
  return files.empty() || !holds_frames(task.format) ||
         files.back().shots.front().camera_number != shot.camera_number;
}

std::vector<PlannedFile> plan_files(RenderContext& context, const RenderTask& task,
                                    const std::vector<Shot>& shots) {
  std::vector<PlannedFile> files;
  for (const Shot& shot : shots) {
    if (!begins_file(task, files, shot)) {
      files.back().shots.push_back(shot);
      continue;
    }
    fs::path file;
    if (!task.output.is_standard_output()) {
      file = task.output.file({.scene = fs::path(task.request.scene).stem().string(),
                               .camera = shot.camera.name,
                               .frame = shot.frame});
      if (!context.written.insert(file).second) {
        throw std::runtime_error("--output: " + file.string() + " would be written twice");
      }
      if (!can_write(file)) throw std::runtime_error("--output: cannot write " + file.string());
    }
    files.push_back({.path = std::move(file), .shots = {shot}});
  }
  return files;
}

/// The files that --resume keeps. Frames of a clip continue each other's histories: they are kept
/// only if all of them are there, so that the bytes do not depend on where a run was interrupted.
std::set<fs::path> existing_files(const RenderOptions& options,
                                  const std::vector<PlannedFile>& files) {
  std::set<fs::path> kept;
  if (!options.resume) return kept;
  std::set<fs::path> run;
  bool whole = true;
  const auto end_run = [&] {
    if (whole) kept.merge(run);
    run.clear();
    whole = true;
  };
  for (const PlannedFile& file : files) {
    if (file.shots.front().cut) end_run();
    std::error_code ignored;
    whole = whole && fs::is_regular_file(file.path, ignored);
    run.insert(file.path);
  }
  end_run();
  return kept;
}

/// Settings and scene decide which buffers there are.
void check_buffer(const render::Renderer& renderer, const std::string& name) {
  const auto& buffers = renderer.buffers();
  if (std::ranges::find(buffers, name, &render::BufferInfo::name) != buffers.end()) return;
  throw std::runtime_error("--buffer: frames of this scene with these settings have no " + name);
}

/// Whether its files show more of a frame than the output.
bool reads_buffers(const RenderTask& task) {
  return task.request.buffer != "output" || task.format == protocol::FileFormat::exr;
}

/// When an image is complete: converged, or good enough, or late.
class ImageEnd {
 public:
  /// `forecast`: of the video's frames, null for another image.
  ImageEnd(const protocol::RenderRequest& request, SampleForecast* forecast)
      : request_(request), forecast_(forecast) {
    if (forecast) enough_ = forecast->next();
  }

  bool reached(const render::Frame& frame) {
    if (frame.converged || frame.samples >= request_.samples.value_or(most_samples)) return true;
    if (!request_.samples && session::is_complete_at_once(request_.buffer)) return true;
    if (request_.time_limit && seconds() >= *request_.time_limit) return true;
    if (!request_.quality) return false;
    if (enough_) return frame.samples >= *enough_;
    return estimate_.wants(frame.samples) && suffices(frame);
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::uint32_t most_samples = protocol::max_samples_per_pixel;

  bool suffices(const render::Frame& frame) {
    const auto similarity = estimate_.add(frame.rgba, frame.width, frame.samples);
    if (!similarity || *similarity < *request_.quality) return false;
    if (forecast_) forecast_->add(frame.samples, estimate_.half() >= *request_.quality);
    return true;
  }

  /// Since the beginning, without those that the process was stopped for.
  double seconds() const {
    const std::chrono::duration<double> passed =
        Clock::now() - begin_ - (stopped_time() - stopped_before_);
    return passed.count();
  }

  const protocol::RenderRequest& request_;
  SampleForecast* const forecast_;
  std::optional<std::uint32_t> enough_;  // samples
  const Clock::time_point begin_ = Clock::now();
  const std::chrono::nanoseconds stopped_before_ = stopped_time();
  QualityEstimate estimate_;
};

session::CaptureContent render_image(RenderContext& context, Renderers& renderers,
                                     const RenderTask& task, const Shot& shot,
                                     SampleForecast* forecast) {
  render::Renderer& renderer = renderers.images;
  const auto canceled = [&] { return context.canceled.load(); };
  std::uint32_t samples = 0;
  bool complete = false;
  ImageEnd end(task.request, forecast);
  while (!complete) {
    const std::optional<render::Frame> frame = renderer.render(canceled);
    if (!frame || canceled()) throw RenderCanceled();
    samples = frame->samples;
    complete = end.reached(*frame);
  }
  context.report.image(samples);
  auto content =
      accepted(session::read_content(renderer, task.request.buffer, read_format(task.format)));
  if (renderers.coverage) {
    session::put_background(std::get<render::Frame>(content.values).rgba,
                            renderers.coverage->measure(shot, canceled), task.background.color());
  }
  return content;
}

void render_file(RenderContext& context, Renderers& renderers, const RenderTask& task,
                 const PlannedFile& file) {
  render::Renderer& renderer = renderers.images;
  const auto alpha =
      task.background.is_transparent() ? stream::Alpha::kept : stream::Alpha::ignored;
  const auto output =
      open_output(file.path, {.format = task.format, .fps = task.request.fps, .alpha = alpha});
  SampleForecast forecast;
  for (const Shot& shot : file.shots) {
    // As in a new renderer, with the images and passes of this one.
    if (shot.cut) renderer.invalidate_history();
    renderers.edits.show(renderer, renderers.shown, task.request.clip, shot.seconds);
    accept(renderer.set_pose(task.request.clip, shot.seconds));
    renderer.set_camera(shot.camera);
    output->add(render_image(context, renderers, task, shot,
                             holds_frames(task.format) ? &forecast : nullptr));
  }
  output->finish();
  context.report.file(file.path);
}

void print_timings(RenderContext& context, const RenderTask& task, render::Renderer& renderer) {
  const FrameSize size = frame_size(task.request);
  nlohmann::json line = measure_passes(renderer, task.settings,
                                       context.options.request.frames.value_or(measured_frames));
  line["scene"] = fs::path(task.request.scene).filename().string();
  line["device"] = context.engine->device().name;
  line["tracer"] = protocol::enum_name(context.engine->tracer());
  line["width"] = size.width;
  line["height"] = size.height;
  std::printf("%s\n", line.dump().c_str());
}

/// The scene on the device, and the scene itself if it had to be read.
void load(RenderContext& context, const RenderTask& task, std::unique_ptr<scene::Scene> scene,
          std::vector<scene::TextureOverride> textures) {
  auto environment = environment_of(context, task, *scene);
  set_up_device(context);
  context.scene = {.file = task.request.scene,
                   .environment = named_environment(task.request),
                   .variant = task.request.variant,
                   .textures = std::move(textures),
                   .resources = context.engine->upload_and_free_pixels(std::move(scene),
                                                                       std::move(environment))};
}

std::unique_ptr<scene::Scene> read_scene(const RenderContext& context, const RenderTask& task,
                                         const std::vector<scene::TextureOverride>& textures) {
  return std::make_unique<scene::Scene>(scene::import_gltf(
      task.request.scene, context.options.limits,
      {.choice = {.scene = {}, .variant = task.request.variant}, .textures = textures}));
}

void prepare(RenderContext& context, const RenderTask& task, Renderers& renderers,
             const Shot& first) {
  render::Renderer& renderer = renderers.images;
  renderers.edits = RenderEdits(render::scene_of(*context.scene.resources),
                                task.request.edits.value_or(protocol::EditDocument()));
  const auto show_scene = [&] {
    renderer.set_scene(context.scene.resources);
    renderers.shown.reset();
    renderers.edits.apply(renderer);
    renderers.edits.show(renderer, renderers.shown, task.request.clip, first.seconds);
  };
  const FrameSize size = frame_size(task.request);
  renderer.keep_buffers(reads_buffers(task));
  show_scene();
  renderer.set_size(size.width, size.height);
  renderer.set_camera(first.camera);
  accept(renderer.set_settings(task.settings));
  check_buffer(renderer, task.request.buffer);
  if (context.options.timings) {
    print_timings(context, task, renderer);
    // Start again without history, so that the file does not depend on --timings.
    show_scene();
    accept(renderer.set_settings(task.settings));
  }
  renderer.set_frame_seconds(static_cast<float>(1.0 / task.request.fps));
}

/// The request without what each of its views has of its own.
protocol::RenderRequest without_views(protocol::RenderRequest request) {
  request.output.clear();
  request.camera.clear();
  request.view.reset();
  request.orbit.reset();
  request.fit = false;
  request.margin.reset();
  request.turntable.reset();
  request.path.reset();
  return request;
}

/// Those of the entry before, whose images and passes are made, where they fit.
std::shared_ptr<Renderers> take_renderers(RenderContext& context, const RenderTask& task,
                                          const Shot& first) {
  SceneInUse& scene = context.scene;
  protocol::RenderRequest request = without_views(task.request);
  std::shared_ptr<Renderers> renderers = std::exchange(scene.renderers, nullptr);
  const bool fit = renderers && scene.format == task.format && scene.rendered == request;
  if (fit && !context.options.timings) return renderers;
  renderers.reset();  // before the next one takes memory
  renderers = std::make_shared<Renderers>(*context.engine);
  prepare(context, task, *renderers, first);
  if (!task.background.is_rendered()) {
    renderers->coverage.emplace(*context.engine, scene.resources, task, renderers->edits);
  }
  scene.rendered = std::move(request);
  scene.format = task.format;
  return renderers;
}

}  // namespace

std::size_t expected_images(const RenderTask& task) {
  return protocol::frame_count(task.request);
}

void render_task(RenderContext& context, const RenderTask& task) {
  const protocol::RenderRequest& request = task.request;
  std::unique_ptr<scene::Scene> read;
  std::vector<scene::TextureOverride> textures = textures_of(context, request);
  if (!shows(context.scene, request, textures)) {
    context.scene = {};
    read = read_scene(context, task, textures);
  }
  const scene::Scene& scene = read ? *read : *render::scene_of(*context.scene.resources);
  const scene::Bounds shown = scene::exploded_bounds(scene, task.settings.view.explode);
  const std::vector<Shot> shots = plan_shots(scene, shown, request);
  const std::vector<PlannedFile> files = plan_files(context, task, shots);
  if (const std::string note = note_on_clip(scene, request); !note.empty()) {
    std::fprintf(stderr, "heliograph: %s: %s\n", request.scene.c_str(), note.c_str());
  }
  const std::set<fs::path> kept = existing_files(context.options, files);
  context.report.begin(task.number, request.scene, shots.size(), expected_images(task));
  std::shared_ptr<Renderers> renderers;  // dropped where rendering fails
  for (const PlannedFile& file : files) {
    if (kept.contains(file.path)) {
      context.report.keep(file.path, file.shots.size());
      continue;
    }
    if (read) load(context, task, std::move(read), std::move(textures));
    if (!renderers) renderers = take_renderers(context, task, file.shots.front());
    render_file(context, *renderers, task, file);
  }
  if (renderers) context.scene.renderers = std::move(renderers);
  context.report.done();
}

}  // namespace heliograph::cli
